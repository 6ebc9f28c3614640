// Looks up addresses in the running program's own symbols.
#include "toolchain/tools/chart/names.hpp"

#include <algorithm>
#include <charconv>
#include <dlfcn.h>

namespace tappet::chart {

namespace {

/// Returns the last name of a mangled symbol (Itanium C++ ABI 5.1): for "...callIXadL_ZNS_5Press4liftEv..."
/// the member function that is the template's argument, "lift". Not every demangler reads clang's symbols.
std::string last_name(std::string_view symbol) {
    if (const std::size_t argument = symbol.find("XadL_Z"); argument != symbol.npos)
        symbol.remove_prefix(argument + 6);
    else if (symbol.starts_with("_Z"))
        symbol.remove_prefix(2);
    else
        return std::string{symbol};
    while (symbol.starts_with('N') || symbol.starts_with('K')) symbol.remove_prefix(1);
    std::string name;
    while (!symbol.empty()) {
        if (symbol.front() == 'S') { // a substituted scope: "S_", "S1_", "St"
            const bool is_standard = symbol.starts_with("St");
            symbol.remove_prefix(is_standard ? 2 : std::min(symbol.find('_'), symbol.size() - 1) + 1);
            continue;
        }
        std::size_t length = 0;
        const auto read = std::from_chars(symbol.data(), symbol.data() + symbol.size(), length);
        if (read.ec != std::errc{}) break;
        symbol.remove_prefix(static_cast<std::size_t>(read.ptr - symbol.data()));
        name = symbol.substr(0, length);
        symbol.remove_prefix(std::min(length, symbol.size()));
    }
    return name.empty() ? "c++" : name;
}

} // namespace

std::string function_name(const void* function) {
    Dl_info found{};
    if (dladdr(function, &found) == 0 || found.dli_sname == nullptr || found.dli_saddr != function)
        return "c++";
    return last_name(found.dli_sname);
}

std::string identifier(std::string_view name) {
    std::string plain;
    for (const char character : name) {
        const bool keeps = (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
                           (character >= '0' && character <= '9');
        plain += keeps ? character : '_';
    }
    return plain;
}

std::string time_text(Duration time) {
    struct Unit {
        std::int64_t nanoseconds;
        const char* name;
    };
    for (const Unit& unit : {Unit{1'000'000'000, " s"}, Unit{1'000'000, " ms"}, Unit{1'000, " us"}})
        if (time.count() % unit.nanoseconds == 0)
            return std::to_string(time.count() / unit.nanoseconds) + unit.name;
    return std::to_string(time.count()) + " ns";
}

std::string xml_text(std::string_view text) {
    std::string plain;
    for (const char character : text) switch (character) {
        case '&': plain += "&amp;"; break;
        case '<': plain += "&lt;"; break;
        case '>': plain += "&gt;"; break;
        case '"': plain += "&quot;"; break;
        default: plain += character;
        }
    return plain;
}

} // namespace tappet::chart
