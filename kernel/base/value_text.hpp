// Values as text and back, whatever their type: what a browser shows, a property file holds, an engineer
// types.
//
//     true   -12   0.1   nan   4ms   weft   "a text"   [1, 2, 3]   [[1, 2], [3, 4]]   {x: 1, turn: 0.5}   (1,
//     4ms)
//
// Nothing here uses the heap, and nothing throws. Not real-time: for activities that are not_real_time.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/type_tag.hpp"

#include <cstddef>
#include <span>
#include <string_view>

namespace tappet {

/// Writes the value at `value` and returns the number of characters; 0 when they do not all fit. parse_value
/// makes the same value of them: numbers are as short as that allows, times have the largest unit that
/// leaves a whole number. A matrix is written row by row. An opaque value becomes "<its size in bytes>".
std::size_t format_value(const TypeTag& tag, const std::byte* value, std::span<char> into) noexcept;

/// As format_value, as one JSON value: times, enumerations and what JSON has no number for ("nan", "inf") are
/// strings; characters that are no UTF-8 become U+FFFD. parse_value reads this spelling too.
std::size_t format_json(const TypeTag& tag, const std::byte* value, std::span<char> into) noexcept;

/// Reads a value of the type. Empty: it stands in `into`. Else what is wrong and the cure, and `into` is
/// untouched. A text needs no quotes unless it begins with one or stands among others; the parentheses and
/// commas of an argument list may be left out; every field of a record must be there, in any order.
Sentence parse_value(const TypeTag& tag, std::string_view text, std::byte* into) noexcept;

} // namespace tappet
