// Names of a signal's values that can be believed: names of impossible values, and names that contradict each
// other, are removed. Whatever uses one of them is then refused.
#pragma once

#include "drivers/can/dbc/rows.hpp"

namespace tappet::can::dbc {

/// Returns why the name of index `i` cannot be believed; empty: it can.
constexpr std::string_view name_trouble(const Signal& s, Slice<ValueName> all, std::size_t i) {
    const bool is_float = s.kind == Kind::float32 || s.kind == Kind::float64;
    const std::int64_t value = all[i].value;
    if (!is_float && to_integer(s, static_cast<std::uint64_t>(value) & detail::mask_of(s)) != value)
        return "which its bits cannot hold";
    for (std::size_t other = 0; other < all.size(); ++other) {
        if (all[other].value != value || other == i) continue;
        if (all[other].name != all[i].name) return "which has another name too";
        if (other < i) return "which has it twice";
    }
    return {};
}

/// Keeps the names that can be believed, and of equal ones the first; tell(name, why) for each other one.
template <class Tell> constexpr void keep_good_names(const Rows& rows, SignalRow& row, const Tell& tell) {
    const auto all = rows.names_of(row);
    for (std::size_t i = 0; i < row.values;) {
        const std::string_view why = name_trouble(row.shape, all, i);
        if (why.empty()) {
            ++i;
            continue;
        }
        tell(all[i], why);
        std::rotate(&all[i], &all[i] + 1, all.end()); // the others are compared with it
        --row.values;
    }
}

} // namespace tappet::can::dbc
