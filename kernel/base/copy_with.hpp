// A copy of a row of a table with some members changed: copy_with(row, &Row::period, 10ms, &Row::name,
// "speed").
#pragma once

#include <type_traits>

namespace tappet {

namespace detail {
template <class Row>
constexpr void set_members(Row&) noexcept {}
template <class Row, class Owner, class Value, class... More>
constexpr void set_members(Row& row, Value Owner::* member, const std::type_identity_t<Value>& value,
                           const More&... more) noexcept {
    row.*member = value;
    set_members(row, more...);
}
} // namespace detail

/// Returns a copy of the row in which these members have these values.
template <class Row, class... MembersAndValues>
constexpr Row copy_with(Row row, const MembersAndValues&... these) noexcept {
    detail::set_members(row, these...);
    return row;
}

} // namespace tappet
