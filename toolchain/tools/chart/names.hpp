// Names for pictures and models: of C++ programs, which a table stores as addresses only, and names that are
// valid in the target language.
#pragma once

#include "kernel/statechart/table.hpp"

#include <string>
#include <string_view>

namespace tappet::chart {

/// Returns the name, such as "enter_run_up", of the member function behind a program or guard of a C++ table.
/// Searches the symbols of the running program, which must export them (CMake: ENABLE_EXPORTS); otherwise
/// returns "c++".
std::string function_name(const void* function);
inline std::string function_name(StateProgram program) {
    return function_name(reinterpret_cast<const void*>(program)); // NOLINT: an address to look up
}
inline std::string function_name(StateGuard guard) {
    return function_name(reinterpret_cast<const void*>(guard)); // NOLINT: an address to look up
}

/// Returns characters, digits and underscores only; every other character becomes an underscore.
std::string identifier(std::string_view name);

/// Returns "3 s", "20 ms", "1500 us": in the largest unit that gives a whole number.
std::string time_text(Duration time);

/// Escapes text for XML attributes.
std::string xml_text(std::string_view text);

} // namespace tappet::chart
