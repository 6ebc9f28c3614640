// Options of the rows that an author writes; each option sets one member of its row.
#pragma once

#include <string_view>

namespace tappet {

template <class Row, class T>
struct RowOption {
    T Row::* member;
    T value;
};

/// An option that a row accepts once: a second one is stored in Row::twice, for the check to refuse.
template <class Row, class T>
struct RowOptionOnce {
    T Row::* member;
    T value;
    std::string_view name; ///< its name in a refusal
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
