// A component that keeps its thread shares an activity.
// refused: loom: activity "hall" runs others beside component "reader", which keeps the thread (it has loop()); run it in an activity of its own
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
                    activity("hall", on_work(), not_real_time, runs("climate", "reader"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
