// A component has both a loop and a function for each cycle.
// refused: loom: component "reader" has loop() and also work(); keep one of them
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Reader {
    void loop(LoopControl&) {}
    void work(const Cycle&) {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr auto table =
    loom(components(good_components.rows[0], good_components.rows[1], good_components.rows[2],
                    good_components.rows[3], good_components.rows[4], good_components.rows[5],
                    component<Reader>("reader")),
         activities(good_activities.rows[0], good_activities.rows[1], good_activities.rows[2],
                    good_activities.rows[3], activity("reading", on_work(), not_real_time, runs("reader"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
