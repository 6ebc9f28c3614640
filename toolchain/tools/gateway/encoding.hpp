// Texts of the network: base64, percent signs, HTML, UTF-8.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tappet::network {

/// Base64 with padding (RFC 4648, 4); `for_addresses`: - and _ instead of + and /, and no padding (5).
[[nodiscard]] std::string to_base64(std::string_view bytes, bool for_addresses = false);
/// Reads base64 with padding. Nothing: it is none.
[[nodiscard]] std::optional<std::string> from_base64(std::string_view text);
[[nodiscard]] std::string to_hex(std::string_view bytes);

/// Splits "a=1&b=x+y" (application/x-www-form-urlencoded). Nothing: an escape is wrong, or there are more
/// than 16 fields.
[[nodiscard]] std::optional<std::vector<std::pair<std::string, std::string>>>
from_form(std::string_view text);
/// Returns the value of a cookie of the header "a=1; b=2"; nothing: it is missing, or there twice.
[[nodiscard]] std::optional<std::string> cookie_of(std::string_view header, std::string_view name);

/// Returns the text with < > & " ' as entities.
[[nodiscard]] std::string in_html(std::string_view text);
/// Returns the text with each byte that is not UTF-8 replaced by '?'.
[[nodiscard]] std::string as_utf8(std::string_view text);
/// Returns at most `most` bytes, cut between two characters.
[[nodiscard]] std::string_view cut(std::string_view text, std::size_t most);

} // namespace tappet::network
