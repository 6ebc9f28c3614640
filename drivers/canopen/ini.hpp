// The lines of an INI file (CiA 306): sections, keys and values, as views of a constant text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet::canopen {

struct IniLine {
    enum class Kind : std::uint8_t { end, section, entry, nonsense };
    Kind kind = Kind::end;
    std::uint32_t line = 0;
    std::string_view name{}; ///< of the section or of the entry; of an invalid line, the line itself
    std::string_view value{};
};

constexpr char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
/// Compares without regard to upper and lower case.
constexpr bool same(std::string_view a, std::string_view b) noexcept {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (lower(a[i]) != lower(b[i])) return false;
    return true;
}
constexpr std::string_view trimmed(std::string_view text) noexcept {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

/// Returns the lines with contents, one by one; comments begin with a semicolon. Lines end in LF or CR LF.
class IniLines {
public:
    explicit constexpr IniLines(std::string_view text) noexcept : rest_{text} {
        if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3); // a byte-order mark
    }

    constexpr IniLine next() noexcept {
        while (!rest_.empty()) {
            const std::size_t end = rest_.find('\n');
            const std::string_view line = trimmed(rest_.substr(0, end));
            rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
            ++line_;
            if (line.empty() || line.front() == ';') continue;
            if (line.front() == '[')
                return line.back() == ']' ? IniLine{IniLine::Kind::section,
                                                    line_,
                                                    trimmed(line.substr(1, line.size() - 2)),
                                                    {}}
                                          : IniLine{IniLine::Kind::nonsense, line_, line, {}};
            const std::size_t sign = line.find('=');
            if (sign == std::string_view::npos || sign == 0)
                return {IniLine::Kind::nonsense, line_, line, {}};
            return {IniLine::Kind::entry, line_, trimmed(line.substr(0, sign)),
                    trimmed(line.substr(sign + 1))};
        }
        return {IniLine::Kind::end, line_, {}, {}};
    }

private:
    std::string_view rest_;
    std::uint32_t line_ = 0;
};

} // namespace tappet::canopen
