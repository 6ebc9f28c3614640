// Converts a machine's value to text: its bytes, read by the type in the map.
#pragma once

#include "toolchain/tools/browser/map_reader.hpp"

namespace tappet::browser {

enum class Style {
    exact, ///< reading it back gives the same value; spelled as for `set`
    brief, ///< for people: six significant digits
    json,  ///< a JSON value; times, enumerations and not-a-number are strings, as in the machine's replies
    plain  ///< a JSON value for calculations: times are seconds, and not-a-number is null
};

/// `bytes` must hold at least the type's size.
[[nodiscard]] std::string to_text(const MapReader& map, std::uint32_t type, std::span<const std::byte> bytes,
                                  Style style);
/// Returns "(double, Duration)": the form of an operation's arguments.
[[nodiscard]] std::string signature(const MapReader& map, std::uint32_t type);
/// Returns a time of the machine's clock, to the microsecond: "78537.605353s".
[[nodiscard]] std::string clock_text(std::int64_t nanoseconds);
/// Returns a type as people write it: "int64", "Time", "double[3]", "can::Bus<can_signals>".
[[nodiscard]] std::string type_name(const MapReader& map, std::uint32_t type);
/// Returns the name of a C++ type as its table spells it: without `tappet::` and the user's own namespaces.
[[nodiscard]] std::string user_name(std::string_view type);
/// Returns the text in double quotes, with JSON escapes.
[[nodiscard]] std::string in_quotes(std::string_view text);
/// Returns one word of a request: unchanged, or in quotes when it would be read as several.
[[nodiscard]] std::string as_word(std::string_view text);
[[nodiscard]] std::string padded(std::string text, std::size_t width, bool right = false);
/// Returns any text as one quoted word of a request, which the machine unquotes.
[[nodiscard]] std::string quoted_word(std::string_view text);
/// "4ms", "1.5s", "250us".
[[nodiscard]] std::string duration_text(std::int64_t nanoseconds);
/// Returns a measured time with three digits, "12.3ms", "87us"; more only before the point.
[[nodiscard]] std::string moment_text(std::int64_t nanoseconds);

} // namespace tappet::browser
