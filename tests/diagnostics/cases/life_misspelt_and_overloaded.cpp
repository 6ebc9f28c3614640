// Two functions of a name that is misspelt, one of them private.
// refused: loom: component "horn": Horn::finalize looks like a function of its life but would never run; that is public and spelled "void finalise()": spell it so, or rename it
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

class Horn {
    void finalize(int) {}

public:
    void finalize() {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr auto table =
    loom(components(good_components.rows[0], good_components.rows[1], good_components.rows[2],
                    good_components.rows[3], good_components.rows[4], good_components.rows[5],
                    component<Horn>("horn")),
         activities(good_activities.rows[0], good_activities.rows[1], good_activities.rows[2],
                    good_activities.rows[3], activity("noise", every(10ms), budget(10us), runs("horn"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board, good_binding>;
