// A loop may run for ever within one step.
// refused: axis.osd:4:5: this loop can run without waiting; put yield or wait(...) into it, or count with "for" between constants, or let its row say at_most(n)
#include "tests/diagnostics/script_case.hpp"

inline constexpr tappet::ScriptSource source{"axis.osd", R"(
program p {
    var int i = 0;
    while (true) {
        set i = 1 - i;
    }
}
)"};
constexpr const tappet::ScriptUnit& unit = tappet::compiled_script<source, axis_reach>;
