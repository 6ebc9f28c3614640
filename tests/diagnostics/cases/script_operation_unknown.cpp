// A script calls what its component does not have.
// refused: axis.osd:3:13: "axis" has no "hoem"; did you mean "home"?
#include "tests/diagnostics/script_case.hpp"

inline constexpr tappet::ScriptSource source{"axis.osd", R"(
program p {
    do axis.hoem(1);
}
)"};
constexpr const tappet::ScriptUnit& unit = tappet::compiled_script<source, axis_reach>;
