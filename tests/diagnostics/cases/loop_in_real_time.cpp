// A real-time activity runs a component that blocks in its loop.
// refused: loom: activity "reading" is real-time but component "reader" may block (it has loop()); run it in an activity that is not_real_time
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Reader {
    void loop(LoopControl&) {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr auto table =
    loom(components(good_components.rows[0], good_components.rows[1], good_components.rows[2],
                    good_components.rows[3], good_components.rows[4], good_components.rows[5],
                    component<Reader>("reader")),
         activities(good_activities.rows[0], good_activities.rows[1], good_activities.rows[2],
                    good_activities.rows[3],
                    activity("reading", on_work(), at_most(1, 10ms), budget(10us), runs("reader"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
