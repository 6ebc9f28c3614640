// Options of the rows that an author writes, of which each sets one member of its row.
#pragma once

#include <string_view>

namespace tappet {

template <class Row, class T>
struct RowOption {
    T Row::* member;
    T value;
};

/// A row takes it once: a second one is kept in Row::twice, for the check to refuse.
template <class Row, class T>
struct RowOptionOnce {
    T Row::* member;
    T value;
    std::string_view name; ///< as a refusal calls it
};

namespace detail {

template <class Row>
constexpr void give(Row& row, std::string_view part, bool is_given) noexcept {
    if (is_given && row.twice.empty()) row.twice = part;
}
template <class Row, class T>
constexpr void apply(Row& row, const RowOption<Row, T>& option) noexcept {
    row.*option.member = option.value;
}
template <class Row, class T>
constexpr void apply(Row& row, const RowOptionOnce<Row, T>& option) noexcept {
    give(row, option.name, row.*option.member != T{});
    row.*option.member = option.value;
}

} // namespace detail

} // namespace tappet
