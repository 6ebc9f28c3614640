// The rows that the maps of all drivers have: named rows that hold named values, with their scales, their
// safe values, and the checks of these. A driver derives its own rows from them.
#pragma once

#include "kernel/base/array_of.hpp"
#include "kernel/base/copy_with.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"
#include "kernel/component/facet_name.hpp"

#include <array>
#include <cstddef>
#include <string_view>

namespace tappet {

inline constexpr std::size_t no_such = ~std::size_t{0};

/// A row: a frame, or a request to a server.
struct MapRow {
    std::string_view name{};
    std::size_t first = 0;        ///< index of its first value in the map's array
    std::size_t values = 0;       ///< their number; they are consecutive
    bool silence_is_safe = false; ///< of a row that is sent: no safe values are sent

    /// Returns the index behind its last value.
    [[nodiscard]] constexpr std::size_t end() const noexcept TAPPET_REALTIME { return first + values; }
};

/// A value in a row: physical = raw * factor + offset.
struct MapValue {
    std::string_view name{};
    double factor = 1;
    double offset = 0;
    std::string_view unit{};
    double safe_value = 0; ///< of a value that is sent: for the time when the machine's process has ended
    bool says_safe = false;
};

/// The setters of a value. `Value` is the driver's own type, derived from this.
// NOLINTNEXTLINE: a private constructor would make the rows no aggregates
template <class Value> struct ScaledValue : MapValue {
    constexpr Value times(double by) const noexcept { return copy_with(own(), &MapValue::factor, by); }
    constexpr Value plus(double this_much) const noexcept {
        return copy_with(own(), &MapValue::offset, this_much);
    }
    constexpr Value in(std::string_view a_unit) const noexcept {
        return copy_with(own(), &MapValue::unit, a_unit);
    }
    /// Sets the value that is sent when the driver stops or the machine's process has ended.
    constexpr Value safe(double value) const noexcept {
        return copy_with(own(), &MapValue::safe_value, value, &MapValue::says_safe, true);
    }

private:
    constexpr const Value& own() const noexcept { return static_cast<const Value&>(*this); }
};

/// A row together with its values, before the map flattens them.
template <class Row, class Value, std::size_t N> struct RowWithValues {
    Row row{};
    std::array<Value, N> values{};

    /// Sends no safe values: the receiver's own time-out makes it safe when this row stays away.
    constexpr RowWithValues safe_by_silence() const noexcept {
        return {copy_with(row, &MapRow::silence_is_safe, true), values};
    }
    /// For a row from a file: lets its facets begin with this name instead of its name in the file.
    constexpr RowWithValues called(std::string_view name) const noexcept {
        return {copy_with(row, &Row::in_file, row.name, &MapRow::name, name), values};
    }
};

/// Copies rows and their values into the arrays of a map.
template <class Rows, class Values, class... Each>
constexpr void flatten(Rows& rows, Values& values, const Each&... each) noexcept {
    std::size_t r = 0, v = 0;
    [[maybe_unused]] const auto add = [&](const auto& one) {
        rows[r] = one.row;
        rows[r].first = v;
        rows[r++].values = one.values.size();
        for (const auto& value : one.values) values[v++] = value;
    };
    (add(each), ...);
}

/// The name of a value, "of.name", or of a row, "name".
struct MapName {
    std::string_view of{}, name{};

    [[nodiscard]] constexpr bool is(std::string_view written) const noexcept {
        if (of.empty()) return written == name;
        return written.size() == of.size() + 1 + name.size() && written.starts_with(of) &&
               written[of.size()] == '.' && written.ends_with(name);
    }
};
/// Returns the first index for which `name_of(index)` is that name; no_such: none.
template <class NameOf>
constexpr std::size_t index_of(std::string_view written, std::size_t count, const NameOf& name_of) noexcept {
    for (std::size_t i = 0; i < count; ++i)
        if (name_of(i).is(written)) return i;
    return no_such;
}

/// The facets' names of all values of a map.
template <const auto& map> struct ValueNames {
    static constexpr auto all = array_of<map.row_of.size()>(
        [](std::size_t v) { return FacetName{map.name_of(v).of, ".", map.name_of(v).name}; });
};

// ---- checks of a map at compile time; each returns the first fault, or nothing

/// A driver's words for its rows and values in refusals.
struct MapWords {
    std::string_view row{}, value{};  ///< "frame", "signal"
    std::string_view comes{}, goes{}; ///< "received", "sent"

    [[nodiscard]] constexpr Sentence who(const MapRow& in) const noexcept {
        return Sentence{row, " \"", in.name, "\""};
    }
    [[nodiscard]] constexpr Sentence who(const MapRow& in, const MapValue& of) const noexcept {
        return Sentence{value, " \"", in.name, ".", of.name, "\""};
    }
};

/// Checks a row's name against the rows before it.
template <class Rows>
constexpr Sentence name_fault(const MapWords& words, const Rows& rows, std::size_t r) noexcept {
    for (std::size_t other = 0; other < r; ++other)
        if (rows[other].name == rows[r].name)
            return Sentence{words.who(rows[r]), " is there twice: rename one of them"};
    return {};
}
/// Checks name and scale of a value of the row; `v` is its index in `values`.
template <class Values>
constexpr Sentence value_fault(const MapWords& words, const MapRow& row, const Values& values,
                               std::size_t v) noexcept {
    const MapValue& value = values[v];
    if (value.name.empty())
        return Sentence{words.who(row), " has a ", words.value, " without a name: name it"};
    for (std::size_t other = row.first; other < v; ++other)
        if (values[other].name == value.name)
            return Sentence(words.who(row), " has two ", words.value, "s \"", value.name,
                            "\": rename one of them");
    if (value.factor == 0 || value.factor != value.factor)
        return Sentence{words.who(row, value),
                        " has the factor 0: every value would be the offset; give it another"};
    return {};
}
/// Checks the safe value. `goes`: the row is sent; `fits`: the value can be encoded.
constexpr Sentence safe_fault(const MapWords& words, const MapRow& row, const MapValue& value, bool goes,
                              bool fits) noexcept {
    const bool says = value.says_safe;
    if (!goes)
        return says ? Sentence(words.who(row, value), " is ", words.comes,
                               " and has a safe value: only what is ", words.goes, " has one")
                    : Sentence{};
    if (says && row.silence_is_safe)
        return Sentence{words.who(row, value), " has a safe value, but its ", words.row,
                        " is safe by silence: keep one of the two"};
    if (!says && !row.silence_is_safe)
        return Sentence{words.who(row, value),
                        " does not say its safe value: write .safe(..) behind it, or .safe_by_silence() "
                        "behind the ",
                        words.row};
    if (says && !fits)
        return Sentence{words.who(row, value), " cannot hold its safe value: it is outside of the ",
                        words.value, "'s range"};
    return {};
}

} // namespace tappet
