// A script hands a method a value of another type.
// refused: axis.osd:3:13: found a value of type text, expected int as an argument
#include "tests/diagnostics/script_case.hpp"

inline constexpr tappet::ScriptSource source{"axis.osd", R"(
program p {
    do home("fast");
}
)"};
constexpr const tappet::ScriptUnit& unit = tappet::compiled_script<source, axis_reach>;
