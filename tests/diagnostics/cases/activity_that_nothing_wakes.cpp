// A component is stepped when there is work, and no row brings any.
// refused: loom: activity "noise" runs on_work() but no row wakes it, so the step() of component "horn" would never run; add wakes to a connection into it, or when("...", tell("horn.operation")), or run it every(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Horn {
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr auto table =
    loom(components(good_components.rows[0], good_components.rows[1], good_components.rows[2],
                    good_components.rows[3], good_components.rows[4], good_components.rows[5],
                    component<Horn>("horn")),
         activities(good_activities.rows[0], good_activities.rows[1], good_activities.rows[2],
                    good_activities.rows[3],
                    activity("noise", on_work(), at_most(1, 100ms), budget(10us), runs("horn"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;
