// Checks the XML text for what the parser ignores: unknown entities.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet::cpf {

constexpr bool is_blank(char character) noexcept {
    return character == ' ' || character == '\t' || character == '\n' || character == '\r';
}

struct XmlFault {
    const char* what = nullptr; ///< with its cure; null: none
    std::size_t at = 0;
};

/// Whether the name is the number of a character that XML knows, "#10" or "#x41".
constexpr bool is_character_number(std::string_view name) noexcept {
    const bool hexadecimal = name.size() > 1 && name[1] == 'x';
    name.remove_prefix(hexadecimal ? 2 : 1);
    std::uint32_t number = 0;
    for (const char character : name) {
        std::uint32_t digit = 0;
        if (character >= '0' && character <= '9')
            digit = static_cast<std::uint32_t>(character - '0');
        else if (hexadecimal && character >= 'a' && character <= 'f')
            digit = static_cast<std::uint32_t>(character - 'a' + 10);
        else if (hexadecimal && character >= 'A' && character <= 'F')
            digit = static_cast<std::uint32_t>(character - 'A' + 10);
        else
            return false;
        number = number * (hexadecimal ? 16 : 10) + digit;
        if (number > 0x10FFFF) return false;
    }
    return number != 0;
}

/// Returns the fault of an unknown entity. The parser leaves such an entity as text, and a value would
/// contain it.
constexpr XmlFault find_foreign_entity(std::string_view text) noexcept {
    for (std::size_t at = 0; at < text.size(); ++at) {
        const std::string_view rest = text.substr(at);
        const std::string_view close = rest.starts_with("<!--")        ? "-->"
                                       : rest.starts_with("<![CDATA[") ? "]]>"
                                                                       : "";
        if (!close.empty()) {
            const std::size_t end = text.find(close, at);
            if (end == text.npos) return {}; // the parser says so
            at = end + close.size() - 1;
            continue;
        }
        if (text[at] != '&') continue;
        const std::string_view name = rest.substr(1, rest.substr(0, 16).find(';') - 1);
        const bool known = name == "amp" || name == "lt" || name == "gt" || name == "quot" ||
                           name == "apos" || (name.size() > 1 && name[0] == '#' && is_character_number(name));
        if (!known || rest.substr(0, 16).find(';') == rest.npos)
            return {"has an \"&\" that begins none of XML's own entities; write &amp;", at};
    }
    return {};
}

} // namespace tappet::cpf
