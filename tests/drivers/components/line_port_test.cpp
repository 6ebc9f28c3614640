// Digital lines as a component: edges and their times, levels, losses, and the values left at the stop.
#include "drivers/gpio/line_port.hpp"
#include "drivers/gpio/twin.hpp"
#include "tests/drivers/components/forced_port.hpp"
#include "tests/drivers/components/machine_rig.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tappet::test {
namespace {

inline constexpr auto lines =
    gpio::line_map(gpio::sensor("stop_button"), gpio::sensor("weft"), gpio::output("lamp", gpio::safe(false)),
                   gpio::actuator("valve", gpio::safe(false)), gpio::actuator("brake", gpio::safe(true)));
static_assert(gpio::line_map(gpio::sensor("a"), gpio::output("b")).fault.view() ==
              "output \"b\" does not say its safe value: write gpio::safe(false) or gpio::safe(true)");
static_assert(gpio::line_map(gpio::sensor("a", gpio::safe(true)), gpio::sensor("b")).fault.view() ==
              "sensor \"a\" has a safe value: only outputs have one");
constexpr std::size_t stop_button = 0, weft = 1, lamp = 2, valve = 3, brake = 4;
constexpr gpio::Mask at(std::size_t line) { return gpio::Mask{1} << line; }

/// Records its events, in order.
struct Listener {
    enum class What : std::uint8_t { stop_rose, stop_fell, weft_rose, weft_fell, edges_lost };
    struct Heard {
        What what{};
        Time when{};
        bool operator==(const Heard&) const = default;
    };
    Input<bool> stop_level{};
    Input<bool> weft_level{};
    Input<std::int64_t> lost{};
    Input<bool> faulted{};
    Output<bool> lamp_wanted{};
    Event<> open{};
    Event<> close{};
    Event<> hold{};
    Event<> let_go{};
    Bounded<Heard, 512> heard{};
    int lamp_next = -1;    // 0, 1: written in the next cycle
    Duration lamp_ahead{}; // added to its time stamp
    bool opens = false;
    bool closes = false;
    int faults = 0;

    void on_fault() noexcept TAPPET_REALTIME { ++faults; }
    void note(What what, Time when) noexcept TAPPET_REALTIME { static_cast<void>(heard.push({what, when})); }
    void stop_rose(Time when) noexcept TAPPET_REALTIME { note(What::stop_rose, when); }
    void stop_fell(Time when) noexcept TAPPET_REALTIME { note(What::stop_fell, when); }
    void weft_rose(Time when) noexcept TAPPET_REALTIME { note(What::weft_rose, when); }
    void weft_fell(Time when) noexcept TAPPET_REALTIME { note(What::weft_fell, when); }
    void edges_lost() noexcept TAPPET_REALTIME { note(What::edges_lost, {}); }

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (lamp_next >= 0) lamp_wanted.write(lamp_next != 0, cycle.now + lamp_ahead);
        lamp_next = -1;
        if (opens) {
            open.emit();
            let_go.emit();
        }
        opens = false;
        if (closes) close.emit();
        closes = false;
    }
    static constexpr auto interface() {
        return facets(input<&Listener::stop_level>("stop_level", "", "of the stop button"),
                      input<&Listener::weft_level>("weft_level", "", "of the weft detector"),
                      input<&Listener::lost>("lost", "", "edges that were lost"),
                      output<&Listener::lamp_wanted>("lamp", "", "shall shine"),
                      event<&Listener::open>("open", "the valve shall open"),
                      event<&Listener::close>("close", "the valve shall close"),
                      event<&Listener::hold>("hold", "the brake shall hold"),
                      event<&Listener::let_go>("let_go", "the brake shall let go"),
                      operation<&Listener::stop_rose>("stop_rose", "the button is pressed"),
                      operation<&Listener::stop_fell>("stop_fell", "the button is let go"),
                      operation<&Listener::weft_rose>("weft_rose", "the weft arrives"),
                      operation<&Listener::weft_fell>("weft_fell", "the weft has passed"),
                      operation<&Listener::edges_lost>("edges_lost", "some edges are not known"),
                      input<&Listener::faulted>("faulted", "", "the chip is"),
                      operation<&Listener::on_fault>("on_fault", "the chip does not answer"));
    }
};
using What = Listener::What;
using Heard = Listener::Heard;
using Port = gpio::LinePort<lines>;

// clang-format off
inline constexpr auto line_machine = machine("line-machine",
    components(
        component<Port>("io", device("lines")),
        component<Listener>("listener")),
    activities(
        activity("io", on_device("io"), at_most(8, 1ms), runs("io"), deadline(500us), budget(10us)),
        activity("listener", every(1ms), runs("listener"), budget(20us))),
    connections(
        data("io.stop_button", "listener.stop_level"),
        data("io.weft",        "listener.weft_level"),
        data("io.edges_lost",  "listener.lost"),
        data("io.faulted",     "listener.faulted"),
        data("listener.lamp",  "io.lamp", wakes, stale_after(50ms), substitute(0))),
    reactions(
        when("io.stop_button.rises", tell("listener.stop_rose", queue(256))),
        when("io.stop_button.falls", tell("listener.stop_fell", queue(256))),
        when("io.weft.rises",        tell("listener.weft_rose", queue(256))),
        when("io.weft.falls",        tell("listener.weft_fell", queue(256))),
        when("io.edges_were_lost",   tell("listener.edges_lost", queue(256))),
        when("io.line_fault",        tell("listener.on_fault")),
        when("listener.open",        tell("io.valve.set")),
        when("listener.close",       tell("io.valve.clear")),
        when("listener.hold",        tell("io.brake.set")),
        when("listener.let_go",      tell("io.brake.clear"))),
    behaviours());
// clang-format on

constexpr std::array<gpio::Line, lines.rows.size()> placed_lines = [] {
    std::array<gpio::Line, lines.rows.size()> all{};
    gpio::place(lines.rows, [next = 0u](std::string_view) mutable { return next++; }, all);
    return all;
}();

struct Lines : MachineRig<line_machine> {
    static constexpr Duration tick = 100us;

    Lines() { EXPECT_TRUE(twin.open({.chip = "twin", .lines = placed_lines})); }
    void SetUp() override { run_until(1ms); }
    void run_until(Duration end) {
        if (listener == nullptr) {
            configure<gpio::Device>("lines", twin);
            listener = instance.find<Listener>("listener");
        }
        MachineRig::run_until(end);
    }
    Time carry(Time now) override {
        twin.deliver_until(now);
        return now + tick;
    }
    [[nodiscard]] std::vector<Heard> heard() const {
        return {listener->heard.begin(), listener->heard.end()};
    }
    [[nodiscard]] std::uint64_t io_cycles() const { return instance.engines()[0].statistics().cycles; }
    [[nodiscard]] bool driven(std::size_t line) const { return (twin.outputs() & at(line)) != 0; }

    gpio::Twin twin{7};
    Listener* listener = nullptr;
};

struct LinesBeforeTheStart : Lines {
    void SetUp() override {}
};

TEST_F(Lines, report_edges_in_order_with_their_times) {
    EXPECT_TRUE(twin.drive(weft, true, Time{2010us}));
    EXPECT_TRUE(twin.drive(stop_button, true, Time{2030us}));
    EXPECT_TRUE(twin.drive(weft, false, Time{2050us}));
    run_until(5ms);
    EXPECT_EQ(heard(), (std::vector<Heard>{{What::weft_rose, Time{2010us}},
                                           {What::stop_rose, Time{2030us}},
                                           {What::weft_fell, Time{2050us}}}));
    EXPECT_TRUE(listener->stop_level.get());
    EXPECT_EQ(listener->stop_level.stamp(), Time{2030us});
    EXPECT_FALSE(listener->weft_level.get());
    EXPECT_EQ(listener->weft_level.stamp(), Time{2050us});
}

TEST_F(LinesBeforeTheStart, report_a_button_held_before_the_start_by_its_level) {
    EXPECT_TRUE(twin.drive(stop_button, true, Time{}));
    twin.deliver_until(Time{});
    run_until(5ms);
    EXPECT_TRUE(listener->stop_level.get());
    EXPECT_TRUE(heard().empty()) << "the edge was before the machine's time";
    EXPECT_EQ(listener->lost.get(), 0);
    EXPECT_TRUE(twin.drive(stop_button, false, Time{6ms}));
    EXPECT_TRUE(twin.drive(stop_button, true, Time{7ms}));
    run_until(10ms);
    EXPECT_EQ(heard(), (std::vector<Heard>{{What::stop_fell, Time{6ms}}, {What::stop_rose, Time{7ms}}}));
}

TEST_F(LinesBeforeTheStart, discard_all_edges_before_the_start) {
    for (int i = 0; i < 1500; ++i) { // more than the kernel's buffer holds
        EXPECT_TRUE(twin.drive(weft, i % 2 == 0, at_ns(i)));
        twin.deliver_until(at_ns(i));
    }
    run_until(5ms);
    EXPECT_TRUE(heard().empty());
    EXPECT_EQ(listener->lost.get(), 0) << "nobody missed them";
    EXPECT_FALSE(listener->weft_level.get());
}

TEST_F(Lines, report_lost_edges_first_and_then_read_the_levels_again) {
    twin.faults(stop_button).lose_next = 1;
    EXPECT_TRUE(twin.drive(stop_button, true, Time{2010us})); // lost: seen when the next edge arrives
    run_until(3ms);
    EXPECT_FALSE(listener->stop_level.get());
    EXPECT_TRUE(twin.drive(weft, true, Time{3010us}));
    run_until(5ms);
    EXPECT_EQ(listener->lost.get(), 1);
    EXPECT_TRUE(listener->stop_level.get());
    EXPECT_EQ(heard(),
              (std::vector<Heard>{
                  {What::edges_lost, {}}, {What::weft_rose, Time{3010us}}, {What::stop_rose, Time{3100us}}}));
}

TEST_F(Lines, report_every_edge_that_arrived_though_others_were_lost) {
    twin.faults(stop_button).lose_next = 1;
    EXPECT_TRUE(twin.drive(stop_button, true, Time{2001us}));
    for (int i = 0; i < 200; ++i) { // more than one batch: the levels are newer than the waiting edges
        EXPECT_TRUE(twin.drive(weft, i % 2 == 0, Time{2002us} + i * 100ns));
        if (i % 50 == 49) twin.deliver_until(Time{2002us} + i * 100ns);
    }
    run_until(5ms);
    const auto all = heard();
    ASSERT_EQ(all.size(), 202u);
    EXPECT_EQ(all[0].what, What::edges_lost);
    for (std::size_t i = 0; i < 200; ++i)
        ASSERT_EQ(all[i + 1], (Heard{i % 2 == 0 ? What::weft_rose : What::weft_fell,
                                     Time{2002us} + static_cast<std::int64_t>(i) * 100ns}));
    EXPECT_EQ(all.back().what, What::stop_rose);
    EXPECT_EQ(listener->lost.get(), 1);
    EXPECT_FALSE(listener->weft_level.get());
}

TEST_F(Lines, report_an_edge_once_though_the_levels_were_read_before) {
    twin.faults(weft).lose_next = 1;
    EXPECT_TRUE(twin.drive(weft, true, Time{2010us}));
    EXPECT_TRUE(twin.drive(weft, false, Time{2020us})); // reveals the gap
    twin.faults(stop_button).delay = 1ms;               // its level shows at once, its edge comes late
    EXPECT_TRUE(twin.drive(stop_button, true, Time{2030us}));
    run_until(10ms);
    EXPECT_EQ(heard(),
              (std::vector<Heard>{
                  {What::edges_lost, {}}, {What::weft_fell, Time{2020us}}, {What::stop_rose, Time{2100us}}}));
    EXPECT_TRUE(twin.drive(stop_button, false, Time{11ms}));
    EXPECT_TRUE(twin.drive(stop_button, true, Time{12ms}));
    run_until(15ms);
    ASSERT_EQ(heard().size(), 5u) << "later edges count as ever";
    EXPECT_EQ(heard().back(), (Heard{What::stop_rose, Time{12ms}}));
}

TEST_F(Lines, drive_a_lamp_at_once_when_it_is_written) {
    run_until(2500us);
    EXPECT_EQ(twin.counters().writes, 2u) << "the safe values, at opening and at start";
    listener->lamp_next = 1;
    run_until(2900us);
    EXPECT_FALSE(driven(lamp));
    run_until(3ms);
    EXPECT_TRUE(driven(lamp)) << "the row wakes the lines";
    EXPECT_TRUE(driven(brake)) << "others stay as they are";
    listener->lamp_next = 1;
    run_until(5ms);
    EXPECT_EQ(twin.counters().writes, 3u) << "it is on already";
}

TEST_F(Lines, drive_the_substitute_of_their_row_when_a_value_is_stale) {
    listener->lamp_next = 1;
    run_until(60ms);                                 // good for 50 ms
    EXPECT_TRUE(twin.drive(weft, true, Time{61ms})); // any edge that wakes the component
    run_until(62ms);
    EXPECT_FALSE(driven(lamp));
}

TEST_F(Lines, drive_actuators_by_events) {
    EXPECT_TRUE(driven(brake)) << "its safe value";
    listener->opens = true;
    run_until(3ms);
    EXPECT_TRUE(driven(valve));
    EXPECT_FALSE(driven(brake));
}

TEST_F(Lines, leave_safe_values_at_the_stop_and_keep_them) {
    listener->opens = true;
    listener->lamp_next = 1;
    run_until(3ms);
    world.stop();
    const auto safe = at(brake);
    EXPECT_EQ(twin.outputs(), safe);
    auto* port = instance.find<Port>("io");
    port->set<valve>();
    port->clear<brake>();
    EXPECT_EQ(twin.outputs(), safe);
}

TEST_F(Lines, work_again_after_a_stop_and_a_start) {
    listener->opens = true;
    listener->lamp_next = 1;
    twin.faults(weft).lose_next = 1;
    EXPECT_TRUE(twin.drive(weft, true, Time{2010us}));
    EXPECT_TRUE(twin.drive(weft, false, Time{2020us}));
    run_until(4ms);
    ASSERT_TRUE(driven(valve));
    ASSERT_TRUE(driven(lamp));
    ASSERT_EQ(listener->lost.get(), 1);
    change(0, LifeChange::stop);
    EXPECT_EQ(twin.outputs(), at(brake));
    listener->heard.clear();
    listener->opens = true; // reported to nobody
    EXPECT_TRUE(twin.drive(weft, true, Time{5010us}));
    run_until(10ms);
    EXPECT_EQ(listener->faults, 1) << "lines that nobody drives cannot be relied on";
    EXPECT_TRUE(listener->faulted.get());
    EXPECT_EQ(twin.outputs(), at(brake));
    change(0, LifeChange::start);
    run_until(12ms);
    EXPECT_TRUE(driven(lamp)) << "what is wanted is written again";
    EXPECT_FALSE(driven(valve)) << "what was told before the start is not";
    EXPECT_TRUE(driven(brake));
    EXPECT_TRUE(listener->weft_level.get());
    EXPECT_TRUE(heard().empty()) << "what happened before the start is told by its level";
    EXPECT_EQ(listener->lost.get(), 0);
    listener->opens = true;
    EXPECT_TRUE(twin.drive(weft, false, Time{13010us}));
    run_until(15ms);
    EXPECT_TRUE(driven(valve));
    EXPECT_FALSE(driven(brake));
    EXPECT_EQ(heard(), (std::vector<Heard>{{What::weft_fell, Time{13010us}}}));
    EXPECT_EQ(listener->faults, 1) << "driven again, they can";
    EXPECT_FALSE(listener->faulted.get());
    twin.faults(weft).lose_next = 1;
    EXPECT_TRUE(twin.drive(weft, true, Time{15010us}));
    EXPECT_TRUE(twin.drive(weft, false, Time{15020us}));
    run_until(17ms);
    EXPECT_EQ(listener->lost.get(), 1) << "since the start";
    world.stop();
    EXPECT_EQ(twin.outputs(), at(brake));
}

TEST_F(Lines, report_a_removed_chip_once_even_without_writes) {
    EXPECT_FALSE(listener->faulted.get());
    twin.set_removed(true);
    run_until(5ms);
    EXPECT_TRUE(listener->faulted.get());
    run_until(2s);
    EXPECT_EQ(listener->faults, 1);
    stop_unheard("io");
    run_until(2s + 5ms);
    EXPECT_EQ(listener->faults, 1) << "it is known already";
    EXPECT_TRUE(listener->faulted.get());
}

TEST_F(Lines, report_a_refused_write_and_retry_the_latest_value) {
    twin.set_removed(true);
    run_until(5ms);
    listener->opens = true;
    listener->lamp_next = 1;
    run_until(8ms);
    EXPECT_EQ(twin.outputs(), at(brake)) << "refused";
    listener->closes = true;
    run_until(10ms);
    twin.set_removed(false);
    run_until(40ms);
    EXPECT_FALSE(listener->faulted.get());
    EXPECT_FALSE(driven(valve)) << "it was cleared again meanwhile";
    EXPECT_FALSE(driven(brake));
    EXPECT_TRUE(driven(lamp));
    twin.set_removed(true);
    run_until(45ms);
    EXPECT_TRUE(listener->faulted.get());
    EXPECT_EQ(listener->faults, 2) << "a new fault is told anew";
}

TEST_F(Lines, report_an_input_that_changed_while_the_chip_was_removed) {
    twin.faults(stop_button).lose_next = 1;
    twin.set_removed(true);
    EXPECT_TRUE(twin.drive(stop_button, true, Time{2010us}));
    run_until(5ms);
    EXPECT_TRUE(heard().empty());
    twin.set_removed(false);
    run_until(40ms);
    ASSERT_EQ(heard().size(), 1u);
    EXPECT_EQ(heard()[0].what, What::stop_rose);
}

TEST_F(Lines, use_hardly_any_time_while_their_chip_is_removed) {
    twin.set_removed(true);
    run_until(5ms);
    const auto before = io_cycles();
    run_until(1005ms);
    EXPECT_LE(io_cycles() - before, 50u) << "one look in 20 ms";
}

TEST_F(Lines, become_safe_at_the_next_start_after_a_refused_stop) {
    listener->opens = true;
    run_until(3ms);
    twin.set_removed(true);
    stop_unheard("io");
    run_until(5ms);
    EXPECT_TRUE(listener->faulted.get());
    EXPECT_EQ(listener->faults, 1);
    EXPECT_TRUE(driven(valve));
    twin.set_removed(false);
    change(0, LifeChange::start);
    run_until(8ms);
    EXPECT_EQ(twin.outputs(), at(brake));
    EXPECT_FALSE(listener->faulted.get());
    change(0, LifeChange::stop);
    run_until(9ms);
    EXPECT_EQ(instance.life().left_unsafe(), "");
}

TEST_F(Lines, leave_safe_values_though_the_chip_refuses_them_once) {
    listener->opens = true;
    run_until(3ms);
    ASSERT_TRUE(driven(valve));
    twin.refuse(1);
    change(0, LifeChange::stop);
    run_until(5ms);
    EXPECT_EQ(twin.outputs(), at(brake));
    EXPECT_EQ(instance.life().left_unsafe(), "");
}

TEST_F(LinesBeforeTheStart, refuse_to_start_without_their_chip) {
    const auto refused = instance.configure({});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().view().find("\"lines\""), std::string_view::npos);
}

TEST_F(Lines, become_safe_when_a_force_ends_after_its_writer_stopped) {
    listener->lamp_ahead = 40ms;
    listener->lamp_next = 1;
    run_until(5ms);
    ForcedPort wanted{instance, "io.lamp", FacetKind::input};
    wanted.to(false);
    run_until(10ms);
    change(1, LifeChange::stop);
    run_until(20ms);
    EXPECT_FALSE(driven(lamp));
    run_until(100ms);
    EXPECT_FALSE(driven(lamp));
    wanted.to(false);
    wanted.release();
    instance.engines()[0].waiter().wake();
    run_until(120ms);
    EXPECT_FALSE(driven(lamp)) << "its writer still stands";
}

} // namespace
} // namespace tappet::test
