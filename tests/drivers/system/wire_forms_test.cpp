// The same rows on other wires: CAN FD, which takes wide values, and identifiers that stay when rows change.
#include "tests/drivers/system/pair_run.hpp"

#include <gtest/gtest.h>

namespace tappet::pair {
namespace {

using Pose = std::array<double, 6>;

/// Sends values and commands that no classical frame holds.
struct Arm {
    Output<Pose> pose{};
    Event<Pose> reached{};
    CommandCall<Pose, Pose&> mirror{};
    Pose tells{};
    bool emits = false, asks = false;

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        pose.write(tells);
        if (std::exchange(emits, false)) reached.emit(tells);
        if (asks && mirror.send(tells)) asks = false;
    }
    static constexpr auto interface() {
        return facets(output<&Arm::pose>("pose", "mm", "as the test has it"),
                      event<&Arm::reached>("reached", "a pose"), sends<&Arm::mirror>("mirror", "of a pose"));
    }
};
struct Desk {
    Input<Pose> pose{};
    Pose reached{};

    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    void arrive(Pose at) noexcept TAPPET_REALTIME { reached = at; }
    bool mirror(Pose, Pose&) noexcept TAPPET_REALTIME { return true; }
    CommandProgress mirrored(Pose of, Pose& result) noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < of.size(); ++i) result[i] = -of[i];
        return CommandProgress::done;
    }
    static constexpr auto interface() {
        return facets(input<&Desk::pose>("pose", "mm", "as the arm tells it"),
                      operation<&Desk::arrive>("arrive", "a pose"),
                      command<&Desk::mirror, &Desk::mirrored>("mirror", "of a pose"));
    }
};

// clang-format off
constexpr auto arm_table = test::alone<Arm>("arm", "arm", every(5ms), budget(50us));
constexpr auto desk_table = test::alone<Desk>("desk", "desk", every(5ms), budget(50us));

constexpr auto wide = system("wide",
    nodes(node<arm_table>("a"), node<desk_table>("b")),
    wire("wire", bit_rate(500'000, 2'000'000), beats(20ms), silent_after(70ms), served_within(1ms, budget(40us))),
    crossings(
        across(data("a.arm.pose", "b.desk.pose", stale_after(60ms), hold), every(10ms)),
        across(when("a.arm.reached", tell("b.desk.arrive")), at_most(1, 40ms), within(30ms)),
        across(uses("a.arm.mirror", "b.desk.mirror"), at_most(1, 100ms), within(20ms))));
// clang-format on
using ArmFirmware = AtRunTime<station<wide, "a", arm_table>, board::host>;
using DeskFirmware = AtRunTime<station<wide, "b", desk_table>, board::host>;

TEST(CanFd, carries_values_arguments_and_results_too_long_for_classical_frames) {
    OnOneWire<ArmFirmware, DeskFirmware> both{wide.view()};
    both.start();
    SystemRun& run = both.run;
    Arm& arm = *run.instance(0).find<Arm>("arm");
    Desk& desk = *run.instance(1).find<Desk>("desk");
    const Pose pose{1.5, -2, 1e300, -0.0, 4, 5};
    arm.tells = pose;
    arm.emits = arm.asks = true;
    run.run_for(60ms);
    EXPECT_EQ(desk.pose.get(), pose);
    EXPECT_EQ(desk.reached, pose);
    EXPECT_EQ(arm.mirror.state(), CommandState::done);
    EXPECT_EQ(arm.mirror.result<0>(), (Pose{-1.5, 2, -1e300, 0, -4, -5}));
}

TEST(CanFd, protects_long_frames_and_proves_them_at_both_bit_rates) {
    const auto& plan = systems::plan_of<wide>;
    const WireFrame& data = plan.frames[plan.place[0].frame];
    EXPECT_EQ(data.bytes, 64); // 24 bits of protection, one of validity, 48 bytes
    // Arbitration in 32 bits of 2 us; behind it 33 + 640 + 5 of 0.5 us.
    EXPECT_EQ(data.on_wire, 403us);
    EXPECT_EQ(plan.frames[plan.place[1].answer].bytes, 7);
    OnOneWire<ArmFirmware, DeskFirmware> both{wide.view()};
    SystemRun& run = both.run;
    can::Twin ear;
    const std::array all{can::Identifier{data.id, false}};
    ASSERT_TRUE(ear.open({.interface = "ear", .receive = all, .takes_fd = true}));
    ASSERT_TRUE(run.wire().attach(ear));
    both.start();
    can::Frame frame;
    ASSERT_EQ(ear.receive(frame).what, can::Received::frame);
    EXPECT_EQ(can::format_of(frame), can::Format::flexible_faster);
    ProtectionCheck check{{.form = Protection::Form::wide, .id = data.data_id}};
    EXPECT_EQ(check.check(std::span{frame.data}.first(frame.length)).kind, ProtectionVerdict::Kind::initial);
    frame.data[40] ^= 1;
    EXPECT_EQ(check.check(std::span{frame.data}.first(frame.length)).kind,
              ProtectionVerdict::Kind::wrong_crc);
    for (const WireFrame& each : plan.frames)
        EXPECT_LE(run.end(each.node).longest_response({each.id, false}), each.worst);
}

// clang-format off
constexpr auto fixed_wire = usual_wire("wire", fixed_identifiers);
constexpr auto older = system("fixed", both_nodes, fixed_wire,
    crossings(level_row, a_row, b_row));
/// More rows, of which two are more urgent on the wire.
constexpr auto newer = system("fixed", both_nodes, fixed_wire,
    crossings(sent_row, level_row, doubled_row, a_row, b_row));
// clang-format on
using OlderTaker = AtRunTime<station<older, "b", taker_table>, board::host>;
using NewerGiver = AtRunTime<station<newer, "a", giver_table>, board::host>;

TEST(FixedIdentifiers, let_two_versions_exchange_their_common_rows) {
    for (const WireFrame& frame : systems::plan_of<older>.frames) {
        std::size_t found = 0;
        for (const WireFrame& each : systems::plan_of<newer>.frames)
            found +=
                each.id == frame.id && each.data_id == frame.data_id && each.kind == frame.kind ? 1u : 0u;
        EXPECT_EQ(found, 1u) << std::hex << frame.id;
        EXPECT_LT(frame.id, 1u << 29);
    }
    PairRun<NewerGiver, OlderTaker> both{1, older.view()};
    both.start(0ms);
    SystemRun& run = both.run;
    Giver& giver = both.giver();
    Taker& taker = both.taker();
    giver.tells = 12;
    giver.to_send = {1};
    run.run_for(400ms);
    EXPECT_DOUBLE_EQ(taker.level.get(), 12);
    EXPECT_TRUE(taker.level.good());
    EXPECT_TRUE(taker.other_is_there.get() && giver.other_is_there.get());
    EXPECT_EQ((run.instance(0).find<systems::Link<newer, 0>>("wire")->refused.last().view().substr(0, 17)),
              "node \"b\" has no r");
    EXPECT_TRUE(taker.got.empty()) << "of that row the older one knows nothing";
    EXPECT_EQ((run.instance(1).find<systems::Link<older, 1>>("wire")->frames_refused.last()), 0);
}

TEST(FixedIdentifiers, rank_frames_by_their_shortest_interval) {
    const auto& frames = systems::plan_of<newer>.frames;
    EXPECT_EQ(frames[0].kind, WireFrameKind::beat);
    EXPECT_EQ(frames[1].kind, WireFrameKind::beat);
    for (std::size_t f = 3; f < frames.size(); ++f) {
        EXPECT_LT(frames[f - 1].id, frames[f].id);
        // In 32 steps for each octave.
        EXPECT_LE(to_seconds(frames[f - 1].apart), to_seconds(frames[f].apart) * 33 / 32);
    }
}

/// Sends a value of that type.
template <class T>
struct Teller {
    Output<T> value{};
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(output<&Teller::value>("value", "", "any")); }
};
template <class T>
struct Hearer {
    Input<T> value{};
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(input<&Hearer::value>("value", "", "any")); }
};
template <class T>
constexpr auto teller_table =
    machine("t", components(component<Teller<T>>("x")), activities(activity("x", every(5ms), runs("x"))),
            connections(), reactions(), behaviours());
template <class T>
constexpr auto hearer_table =
    machine("h", components(component<Hearer<T>>("x")), activities(activity("x", every(5ms), runs("x"))),
            connections(), reactions(), behaviours());
struct Metres {
    float value = 0;
};
struct Turns {
    float value = 0;
};

} // namespace
} // namespace tappet::pair
template <>
inline constexpr auto tappet::fields_of<tappet::pair::Metres> =
    tappet::fields(tappet::field<&tappet::pair::Metres::value>("metres", "m"));
template <>
inline constexpr auto tappet::fields_of<tappet::pair::Turns> =
    tappet::fields(tappet::field<&tappet::pair::Turns::value>("turns", "rev"));
namespace tappet::pair {
namespace {

template <class T>
std::uint16_t layout_of(const WireRow& on) {
    static constexpr auto& from = teller_table<T>;
    static constexpr auto& to = hearer_table<T>;
    const auto table = system(
        "typed", nodes(node<from>("a"), node<to>("b")), on,
        crossings(across(data("a.x.value", "b.x.value", stale_after(60ms), hold), every(10ms), with_time)));
    const auto plan = plan_system(table, &systems::analyse_can);
    EXPECT_EQ(plan.fault.view(), "");
    return plan.index[0].layout;
}

TEST(Layouts, differ_when_the_same_bits_have_another_meaning) {
    const auto on = [](const CommonClock& clock) { return usual_wire("wire", fixed_identifiers, clock); };
    const WireRow usual = on(common_clock("a", every(100ms), within(200us)));
    std::vector<std::uint16_t> all{
        layout_of<std::int32_t>(usual),
        layout_of<std::uint32_t>(usual),
        layout_of<float>(usual),
        layout_of<Metres>(usual),
        layout_of<Turns>(usual),
        layout_of<std::int32_t>(on(common_clock("b", every(100ms), within(200us)))),
        layout_of<std::int32_t>(on(common_clock("a", every(200ms), within(200us)))),
        layout_of<std::int32_t>(on(common_clock("a", every(100ms), within(200us), stamps_late(50us))))};
    std::ranges::sort(all);
    EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
}

/// A node on two wires: it receives the giver on one, and sends to the arm's desk on the other.
struct Bridge {
    Input<double> level{};
    Output<double> doubled{};
    void step(const Cycle&) noexcept TAPPET_REALTIME { doubled.write(2 * level.get()); }
    static constexpr auto interface() {
        return facets(input<&Bridge::level>("level", "mm", "of one wire"),
                      output<&Bridge::doubled>("doubled", "mm", "to the other"));
    }
};
// clang-format off
constexpr auto bridge_table = test::alone<Bridge>("bridge", "bridge", every(5ms), budget(50us));
constexpr auto first_wire = system("first", nodes(node<giver_table>("a"), node<bridge_table>("m")), usual_wire("left"),
    crossings(across(data("a.giver.level", "m.bridge.level", stale_after(60ms), hold), every(10ms), in_bits(24, 0.1)),
              presence("m", "a.giver.other_is_there")));
constexpr auto& on_first_wire = station<first_wire, "m", bridge_table>;
constexpr auto second_wire = system("second", nodes(node<on_first_wire>("m"), node<taker_table>("b")), usual_wire("right"),
    crossings(across(data("m.bridge.doubled", "b.taker.level", stale_after(60ms), hold), every(10ms), in_bits(24, 0.1)),
              presence("m", "b.taker.other_is_there")));
// clang-format on
using BridgeFirmware = AtRunTime<station<second_wire, "m", on_first_wire>, board::host>;

TEST(TwoWires, connect_a_node_of_two_systems) {
    const AcceptedMachine machine = BridgeFirmware::machine();
    for (const std::string_view component : {"left", "left_can", "right", "right_can", "bridge"})
        EXPECT_NE(find_component(machine.table, component), nowhere) << component;
    EXPECT_EQ(machine.table.activities.size(), 5u) << "its own, and two of each wire";
}

TEST(Priorities, follow_deadlines_and_if_necessary_audsley) {
    // An answer of 6.6 ms must come before values of 6.2 ms, which would otherwise wait for it in their own
    // node's queue.
    const auto tight = system(
        "tight", both_nodes,
        wire("wire", bit_rate(372'000), beats(14'300us), silent_after(43ms),
             served_within(200us, budget(40us))),
        crossings(across(data("a.giver.level", "b.taker.level", stale_after(60ms), hold), every(6'200us),
                         in_bits(34, 0.1)),
                  across(when("a.giver.sent", tell("b.taker.take")), at_most(1, 16'800us), within(16'800us)),
                  across(uses("a.giver.doubled", "b.taker.twice"), at_most(1, 16'200us), within(16'200us),
                         in_bits(24))));
    static int tries = 0;
    tries = 0;
    const auto plan = plan_system(tight, [](const SystemView& s, std::span<WireFrame> frames) {
        ++tries;
        return systems::analyse_can(s, frames);
    });
    EXPECT_EQ(plan.fault.view(), "");
    EXPECT_GT(tries, 2) << "by deadlines alone it is proven, too: the case shows nothing";
    bool follows_deadlines = true;
    for (std::size_t f = 3; f < plan.frames.size(); ++f)
        follows_deadlines &= plan.frames[f - 1].deadline <= plan.frames[f].deadline;
    EXPECT_FALSE(follows_deadlines);
    for (const WireFrame& frame : plan.frames) EXPECT_LE(frame.worst, frame.deadline);
}

TEST(Pace, delays_and_counts_events_above_the_rate_of_their_row) {
    PairRun both;
    both.start();
    SystemRun& run = both.run;
    Giver& giver = both.giver();
    Taker& taker = both.taker();
    auto& link = *run.instance(0).find<systems::Link<pair, 0>>("wire");
    giver.to_send = {1, 2, 3}; // 5 ms after each other; at_most(1, 40ms)
    run.run_for(20ms);
    EXPECT_EQ(taker.got.size(), 1u);
    run.run_for(40ms);
    EXPECT_EQ(taker.got.size(), 2u);
    run.run_for(40ms);
    EXPECT_EQ(taker.got, (std::vector<std::int32_t>{1, 2, 3}));
    EXPECT_EQ(link.held_back.last(), 2);
    run.run_for(200ms);
    giver.to_send = {4};
    run.run_for(200ms);
    EXPECT_EQ(link.held_back.last(), 2);
}

} // namespace
} // namespace tappet::pair
