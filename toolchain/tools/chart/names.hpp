// The names that pictures and models need: of C++ programs, which a table holds as addresses only, and names
// that the target language takes.
#pragma once

#include "kernel/statechart/table.hpp"

#include <string>
#include <string_view>

namespace tappet::chart {

/// "enter_run_up" of the member function behind a program or guard of a C++ table, found in the symbols of
/// the program that asks: it must be linked with its symbols exported (CMake: ENABLE_EXPORTS). Otherwise
/// "c++".
std::string function_name(const void* function);
inline std::string function_name(StateProgram program) {
    return function_name(reinterpret_cast<const void*>(program)); // NOLINT: an address to look up
}
inline std::string function_name(StateGuard guard) {
    return function_name(reinterpret_cast<const void*>(guard)); // NOLINT: an address to look up
}

/// Characters, digits and underscores only; every other character becomes an underscore.
std::string identifier(std::string_view name);

/// "3 s", "20 ms", "1500 us": the largest unit in which the time is whole.
std::string time_text(Duration time);

/// For XML's attributes.
std::string xml_text(std::string_view text);

} // namespace tappet::chart
