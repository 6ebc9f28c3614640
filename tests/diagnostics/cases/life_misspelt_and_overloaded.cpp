// Two functions of a name that is misspelt, one of them private.
// refused: loom: component "horn": Horn::finalize looks like a life-cycle function but would never run; declare it public as "void finalise()", or rename it
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

class Horn {
    void finalize(int) {}

public:
    void finalize() {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr auto table =
    loom_with(component<Horn>("horn"), activity("noise", every(10ms), budget(10us), runs("horn")));
template struct tappet::Firmware<table, good_board, good_binding>;
