// Looks addresses up in the running program's own symbols.
#include "apps/chart/names.hpp"

#include <cstdlib>
#include <cxxabi.h>
#include <dlfcn.h>
#include <memory>

namespace tappet::chart {

std::string function_name(const void* function) {
    Dl_info found{};
    if (dladdr(function, &found) == 0 || found.dli_sname == nullptr || found.dli_saddr != function)
        return "c++";
    int status = 0;
    const std::unique_ptr<char, void (*)(void*)> plain{
        abi::__cxa_demangle(found.dli_sname, nullptr, nullptr, &status), &std::free};
    if (status != 0) return found.dli_sname;
    // "void tappet::statechart::call<&tappet::carpet::Loom::enter_run_up, void>(void*)": the member inside
    std::string name = plain.get();
    if (const std::size_t address = name.find("<&"); address != std::string::npos) {
        name.erase(0, address + 2);
        name.erase(std::min(name.find_first_of(",>("), name.size()));
    } else {
        name.erase(std::min(name.find('('), name.size()));
    }
    if (const std::size_t scope = name.rfind("::"); scope != std::string::npos) name.erase(0, scope + 2);
    while (!name.empty() && name.back() == ' ') name.pop_back();
    return name;
}

std::string identifier(std::string_view name) {
    std::string plain;
    for (const char letter : name) {
        const bool keeps = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                           (letter >= '0' && letter <= '9');
        plain += keeps ? letter : '_';
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
    for (const char letter : text) switch (letter) {
        case '&': plain += "&amp;"; break;
        case '<': plain += "&lt;"; break;
        case '>': plain += "&gt;"; break;
        case '"': plain += "&quot;"; break;
        default: plain += letter;
        }
    return plain;
}

} // namespace tappet::chart
