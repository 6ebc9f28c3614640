// A value of the machine as text: its bytes read with the type that the map gives them.
#pragma once

#include "toolchain/tools/browser/map_reader.hpp"

namespace tappet::browser {

enum class Style {
    exact, ///< read back it gives the same value; spelled as `set` takes it
    brief, ///< for people: six significant digits
    json,  ///< a JSON value; times, enumerations and what is no number are strings, as in the machine's
           ///< replies
    plain  ///< a JSON value for who computes: times are seconds, and what is no number is null
};

/// `bytes` are at least as many as the type is large.
[[nodiscard]] std::string to_text(const MapReader& map, std::uint32_t type, std::span<const std::byte> bytes,
                                  Style style);
/// "(double, Duration)": how an operation's arguments are to be given.
[[nodiscard]] std::string signature(const MapReader& map, std::uint32_t type);
/// A time of the machine's clock, to the microsecond: "78537.605353s".
[[nodiscard]] std::string clock_text(std::int64_t nanoseconds);
/// A type as people write it: "int64", "Time", "double[3]", "can::Bus<can_signals>".
[[nodiscard]] std::string type_name(const MapReader& map, std::uint32_t type);
/// The name of a C++ type as its table spells it: without `tappet::`, without the user's own namespaces.
[[nodiscard]] std::string user_name(std::string_view type);
/// In double quotes, with what JSON forbids escaped.
[[nodiscard]] std::string in_quotes(std::string_view text);
/// One word of a request: as it is, or in quotes when it would be taken for several.
[[nodiscard]] std::string as_word(std::string_view text);
[[nodiscard]] std::string padded(std::string text, std::size_t width, bool right = false);
/// Any text as one word of a request, which the machine unquotes.
[[nodiscard]] std::string quoted_word(std::string_view text);
/// "4ms", "1.5s", "250us".
[[nodiscard]] std::string duration_text(std::int64_t nanoseconds);
/// Of what was measured: three digits, "12.3ms", "87us"; more only before the point.
[[nodiscard]] std::string moment_text(std::int64_t nanoseconds);

} // namespace tappet::browser
