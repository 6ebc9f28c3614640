// A forced input releases its force when its writer stops; nothing else would wake its sleeping reader.
#include "tests/kernel/machine/virtual_rig.hpp"

namespace tappet {
namespace {

/// Writes its input to the wire.
struct Valve {
    Input<std::int64_t> wanted;
    std::int64_t at_wire = -1;

    void step(const Cycle&) noexcept TAPPET_REALTIME { static_cast<void>(wanted.read(at_wire)); }
    static constexpr auto interface() { return facets(input<&Valve::wanted>("wanted", "", "1: open")); }
};
/// Its last value is already its safe one.
struct Logic {
    Output<std::int64_t> open;

    void start(const Cycle&) noexcept TAPPET_REALTIME { open.write(0); }
    static constexpr auto interface() { return facets(output<&Logic::open>("open", "", "1: open")); }
};

// clang-format off
constexpr auto waking = machine("waking",
    components(component<Valve>("valve"), component<Logic>("logic")),
    activities(
        activity("io", on_work(), at_most(8, 1ms), runs("valve"), deadline(300us), budget(10us)),
        activity("logic", every(5ms), runs("logic"), budget(50us))),
    connections(data("logic.open", "valve.wanted", wakes)), reactions(), behaviours());
constexpr auto growing_stale = machine("growing-stale",
    components(component<Valve>("valve"), component<Logic>("logic"), component<Valve>("other"), component<Logic>("beat")),
    activities(
        activity("io", on_work(), at_most(8, 1ms), runs("valve", "other"), deadline(300us), budget(10us)),
        activity("logic", every(5ms), runs("logic", "beat"), budget(50us))),
    connections(
        data("logic.open", "valve.wanted", stale_after(20ms), stop_machine),
        data("beat.open",  "other.wanted", wakes)), // once, at the start
    reactions(), behaviours());
// clang-format on

template <const auto& table>
struct Rig : RunningRig<table> {
    void force_open() {
        const std::int64_t open = 1;
        PortAccess::data<std::int64_t>.force(&valve().wanted, true,
                                             reinterpret_cast<const std::byte*>(&open));
        this->instance.observation().forced_ports().fetch_add(1);
        this->instance.engines()[0].waiter().wake();
    }
    void stop_logic() { static_cast<void>(this->instance.life().ask_component(1, LifeChange::stop)); }
    Valve& valve() { return this->template the<Valve>("valve"); }
};

TEST(ForcedInput, ends_its_force_when_its_writer_stops_without_writing) {
    Rig<waking> rig;
    EXPECT_TRUE(rig.run(50ms));
    for (int n = 0; n < 2; ++n) { // also of an already stopped one
        rig.force_open();
        EXPECT_TRUE(rig.run(20ms));
        ASSERT_EQ(rig.valve().at_wire, 1);
        rig.stop_logic();
        EXPECT_TRUE(rig.run(20ms));
        EXPECT_EQ(rig.valve().at_wire, 0);
        EXPECT_EQ(rig.instance.observation().forced_ports(), 0u);
    }
}

TEST(ForcedInput, becomes_stale_after_its_writer_stopped_without_waking_its_reader) {
    Rig<growing_stale> rig;
    EXPECT_TRUE(rig.run(10ms));
    rig.force_open();
    EXPECT_TRUE(rig.run(1s));
    rig.stop_logic();
    EXPECT_FALSE(rig.run(200ms)) << "its row stops the machine";
}

} // namespace
} // namespace tappet
