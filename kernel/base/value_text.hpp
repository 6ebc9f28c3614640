// Values of any type as text and back: for browsers, property files and the input of engineers.
//
//     true   -12   0.1   nan   4ms   weft   "a text"   [1, 2, 3]   [[1, 2], [3, 4]]   {x: 1, turn: 0.5}
//     (1, 4ms)
//
// Nothing here uses the heap, and nothing throws. Not real-time: for activities that are not_real_time.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/type_tag.hpp"

#include <cstddef>
#include <span>
#include <string_view>

namespace tappet {

/// Writes the value at `value`. Returns the number of characters; 0 when they do not all fit. parse_value
/// reads them back as the same value: numbers are as short as that allows, times have the largest unit that
/// leaves a whole number. A matrix is written row by row. An opaque value becomes "<its size in bytes>".
std::size_t format_value(const TypeTag& tag, const std::byte* value, std::span<char> into) noexcept;

/// As format_value, as one JSON value: times, enumerations and numbers that JSON does not have ("nan", "inf")
/// are strings; bytes that are not UTF-8 become U+FFFD. parse_value reads this spelling too.
std::size_t format_json(const TypeTag& tag, const std::byte* value, std::span<char> into) noexcept;

/// Reads a value of the type. Empty: it is in `into`. Otherwise the fault and its cure, and `into` is
/// unchanged. A text needs no quotes unless it begins with one or is among other values; the parentheses and
/// commas of an argument list may be omitted; every field of a record must be given, in any order.
Sentence parse_value(const TypeTag& tag, std::string_view text, std::byte* into) noexcept;

} // namespace tappet
