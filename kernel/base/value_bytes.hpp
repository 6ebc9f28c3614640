// Shared by the writing and the reading of values: the units of time, and numbers in a value's bytes, with
// the width and at the offset that its tag states.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/type_tag.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace tappet {

struct TimeUnit {
    std::string_view name;
    std::int64_t ns;
};
/// From the smallest to the largest unit.
inline constexpr TimeUnit time_units[] = {{"ns", 1},
                                          {"us", 1'000},
                                          {"ms", 1'000'000},
                                          {"s", 1'000'000'000},
                                          {"min", 60'000'000'000},
                                          {"h", 3'600'000'000'000}};
/// Minutes and hours are read, never written.
inline constexpr std::int64_t largest_written_unit = 1'000'000'000;

/// Reads "4ms", "-1.5s"; minutes and hours too. Empty: `into` holds nanoseconds; otherwise the fault and its
/// cure.
Sentence parse_duration(std::string_view spelled, std::int64_t& into) noexcept;

/// Returns the part of a user's text that a sentence quotes, because the text may be long.
constexpr std::string_view quotable(std::string_view text) noexcept { return text.substr(0, 60); }

template <class T>
T load(const std::byte* from) noexcept {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

/// Reads an integer of 1, 2, 4 or 8 bytes.
inline std::int64_t load_integer(const std::byte* from, std::size_t size) noexcept {
    switch (size) {
    case 1: return load<std::int8_t>(from);
    case 2: return load<std::int16_t>(from);
    case 4: return load<std::int32_t>(from);
    default: return load<std::int64_t>(from);
    }
}
inline std::uint64_t load_natural(const std::byte* from, std::size_t size) noexcept {
    std::uint64_t value = 0; // the low bytes come first
    std::memcpy(&value, from, std::min(size, sizeof value));
    return value;
}

/// Returns the number of characters or elements, at most the capacity, because the bytes may be anything.
inline std::size_t length_of(const TypeTag& tag, const std::byte* value) noexcept {
    return static_cast<std::size_t>(
        std::min<std::uint64_t>(load_natural(value + tag.length_at, tag.length_bytes), tag.columns));
}

constexpr bool is_vector(const TypeTag& tag) noexcept { return tag.rows == 1 || tag.columns == 1; }

} // namespace tappet
