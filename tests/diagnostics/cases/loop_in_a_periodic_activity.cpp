// A periodic activity runs a component that decides itself when it runs.
// refused: loom: activity "reading" is periodic but component "reader" decides itself when it runs (it has loop()); run it on_work()
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
                    good_activities.rows[3], activity("reading", every(10ms), not_real_time, runs("reader"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
