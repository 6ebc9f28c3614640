// A cam table as a component of a machine, in virtual time: which cams fire where, and which do not.
#include "kernel/pieces/cam_shaft.hpp"

#include "tests/kernel/base/hostile.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <cmath>
#include <vector>

namespace tappet {
namespace {

constexpr auto cams =
    cam_table(300_rpm, cam("mark", at(40_deg)), cam("eject", window(80_deg, 120_deg), dead_time(5ms)));

/// Turns at its speed; its code is a position in the turn, or a free-running 16-bit counter. Every 1 ms.
struct Encoder {
    Output<std::int64_t> code, counter;
    Output<bool> runs;
    bool enabled = true, silent = false, fights = false;
    double deg_s = 360.0, deg = 0.0;
    std::int64_t offset = 0;
    Duration ahead{};               ///< offset of its stamps
    test::Hostile* noise = nullptr; ///< source of random codes and stamps
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        deg += deg_s * 1e-3;
        runs.write(enabled);
        if (silent) return;
        if (noise != nullptr) {
            const auto any = static_cast<std::int64_t>(noise->random.next());
            const Time at = noise->random.one_in(2) ? cycle.now : noise->stamp(cycle.now);
            code.write(noise->random.one_in(2) ? any : any & 4095, at);
            return counter.write(any, at);
        }
        const auto codes = static_cast<std::int64_t>(std::floor(deg / 360.0 * 4000.0)) + offset;
        // A second encoder at another position sends with the same identifier.
        is_other_ = fights && !is_other_;
        code.write(is_other_ ? 3000 : (codes % 4000 + 4000) % 4000, cycle.now + ahead);
        counter.write(codes & 0xFFFF, cycle.now + ahead);
    }
    static constexpr auto interface() {
        return facets(output<&Encoder::code>("code", "", "in a turn"),
                      output<&Encoder::counter>("counter", "", "runs on"),
                      output<&Encoder::runs>("runs", "", "cams may fire"));
    }

private:
    bool is_other_ = false;
};

struct Ejector {
    const Encoder* encoder = nullptr; ///< gives the true position
    std::vector<double> marks, hits, rests;
    int lost = 0;
    void mark() noexcept TAPPET_REALTIME { note(marks); }
    void hit() noexcept TAPPET_REALTIME { note(hits); }
    void rest() noexcept TAPPET_REALTIME { note(rests); }
    void lose() noexcept TAPPET_REALTIME { ++lost; }
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(operation<&Ejector::mark>("mark", "it is there"),
                      operation<&Ejector::hit>("hit", "it is there"),
                      operation<&Ejector::rest>("rest", "it is not there"),
                      operation<&Ejector::lose>("lose", "nobody knows"));
    }
    [[nodiscard]] bool is_driven() const { return hits.size() > rests.size() - 1; } // the start adds one rest

private:
    void note(std::vector<double>& where) const noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("the test's record", where.push_back(encoder == nullptr ? 0.0 : encoder->deg));
    }
};

// clang-format off
#define TAPPET_CAM_TABLE(CODE, ...) machine("press", \
    components(component<Encoder>("encoder"), component<CamShaft<cams>>("shaft", set("codes_per_turn", 4000) __VA_OPT__(,) __VA_ARGS__), \
               component<Ejector>("ejector")), \
    activities(activity("encoder", every(1ms), budget(5us), runs("encoder")), \
               activity("shaft", on_work(), at_most(4, 1ms), deadline(500us), budget(20us), runs("shaft", "ejector"))), \
    connections(data(CODE, "shaft.code", wakes, stale_after(15ms), hold), data("encoder.runs", "shaft.enabled")), \
    reactions(when("shaft.mark", call("ejector.mark")), when("shaft.lost", call("ejector.lose")), \
              when("shaft.eject.enters", call("ejector.hit")), when("shaft.eject.leaves", call("ejector.rest"))), \
    behaviours())
// clang-format on
inline constexpr auto absolute = TAPPET_CAM_TABLE("encoder.code");
inline constexpr auto counting = TAPPET_CAM_TABLE("encoder.counter", set("counter_bits", 16));

struct Turning : test::Hostile, VirtualRig {
    explicit Turning(const AcceptedMachine& machine = AtRunTime<absolute, test_board>::machine())
        : VirtualRig{machine} {
        start();
        ejector.encoder = &encoder;
    }

    /// Outputs are numbers meanwhile; half a second later the shaft follows as if nothing had happened.
    void expect_forgets_noise() {
        run(250ms);
        encoder.noise = this;
        if (random.one_in(2)) encoder.deg_s = 0.0;
        for (int n = 0; n < 500; ++n) {
            run(1ms);
            ASSERT_TRUE(shaft.angle_deg.last() >= 0.0 && shaft.angle_deg.last() < 360.0);
            ASSERT_TRUE(is_number(shaft.speed_rpm.last()));
        }
        encoder.noise = nullptr;
        encoder.deg_s = 360.0;
        run(500ms);
        EXPECT_TRUE(shaft.valid.last());
        EXPECT_NEAR(shaft.speed_rpm.last(), 60.0, 0.5);
        const std::size_t hits = ejector.hits.size();
        run(2s);
        EXPECT_EQ(ejector.hits.size(), hits + 2);
    }

    Encoder& encoder = *instance.find<Encoder>("encoder");
    CamShaft<cams>& shaft = *instance.find<CamShaft<cams>>("shaft");
    Ejector& ejector = *instance.find<Ejector>("ejector");
};

/// Degrees within the turn.
void expect_near(const std::vector<double>& where, double at, double within) {
    for (const double deg : where) EXPECT_NEAR(std::fmod(deg, 360.0), at, within);
}

TEST_F(Turning, points_fire_at_their_angle_and_windows_their_dead_time_earlier) {
    ejector.rests.clear(); // from the start
    run(3s);
    EXPECT_EQ(ejector.marks.size(), 3u);
    EXPECT_EQ(ejector.hits.size(), 3u);
    EXPECT_EQ(ejector.rests.size(), 3u);
    expect_near(ejector.marks, 40.0, 0.5);
    expect_near(ejector.hits, 80.0 - 1.8, 0.5);
    expect_near(ejector.rests, 120.0 - 1.8, 0.5);
    EXPECT_EQ(shaft.fired.last(), 6);
    EXPECT_EQ(shaft.skipped.last(), 0);
    EXPECT_NEAR(shaft.speed_rpm.last(), 60.0, 0.5);
    EXPECT_TRUE(shaft.valid.last());
}

TEST_F(Turning, nothing_fires_while_disabled_and_actuators_rest_at_once) {
    run(250ms); // 90 degrees
    EXPECT_TRUE(ejector.is_driven());
    encoder.enabled = false;
    run(3ms);
    EXPECT_FALSE(ejector.is_driven());
    run(2s);
    EXPECT_EQ(ejector.hits.size(), 1u);
    encoder.enabled = true;
    run(1s);
    EXPECT_EQ(ejector.hits.size(), 2u) << "the angle was followed meanwhile";
}

TEST_F(Turning, a_silent_encoder_loses_the_angle_once_and_actuators_rest) {
    run(250ms);
    EXPECT_TRUE(ejector.is_driven());
    encoder.silent = true;
    run(20ms);
    EXPECT_FALSE(ejector.is_driven());
    EXPECT_FALSE(shaft.valid.last());
    EXPECT_EQ(shaft.speed_rpm.last(), 0.0);
    encoder.silent = false;
    run(150ms);
    EXPECT_EQ(ejector.lost, 1);
    EXPECT_FALSE(shaft.valid.last()) << "who looks seldom sees it, too";
    run(100ms);
    EXPECT_TRUE(shaft.valid.last());
    EXPECT_EQ(ejector.hits.size(), 1u);
}

TEST_F(Turning, cams_passed_unseen_do_not_fire_later) {
    run(90ms); // 32 degrees
    encoder.silent = true;
    run(20ms);
    encoder.silent = false;
    run(220ms); // 119 degrees
    EXPECT_TRUE(shaft.valid.last());
    EXPECT_TRUE(ejector.marks.empty());
}

TEST_F(Turning, an_encoder_jump_is_rejected_and_actuators_rest) {
    run(250ms);
    EXPECT_TRUE(ejector.is_driven());
    encoder.offset = -1000; // a permanent quarter of a turn
    run(10ms);
    EXPECT_EQ(ejector.lost, 1);
    EXPECT_FALSE(ejector.is_driven());
    EXPECT_FALSE(shaft.valid.last());
    run(300ms);
    EXPECT_TRUE(shaft.valid.last());
}

TEST_F(Turning, two_alternating_encoders_are_rejected) {
    encoder.deg_s = 0.0;
    run(100ms);
    EXPECT_TRUE(shaft.valid.last());
    encoder.fights = true;
    run(50ms);
    EXPECT_EQ(ejector.lost, 1);
    run(2s);
    EXPECT_FALSE(shaft.valid.last());
    EXPECT_EQ(shaft.fired.last(), 0);
}

TEST_F(Turning, an_angle_that_was_seen_too_late_is_counted) {
    encoder.deg_s = 12'000.0; // far beyond the purpose of the table
    encoder.deg = 345.0 - 720.0;
    run(60ms);
    encoder.silent = true; // 14 ms are 168 degrees, not yet a loss
    run(13ms);
    encoder.silent = false;
    const std::size_t marks = ejector.marks.size();
    run(2ms);
    EXPECT_EQ(ejector.marks.size(), marks);
    EXPECT_EQ(shaft.skipped.last(), 1);
    EXPECT_EQ(ejector.lost, 0);
}

TEST_F(Turning, impossible_codes_and_stamps_are_ignored) { expect_forgets_noise(); }

TEST_F(Turning, the_encoder_is_configured_only_at_a_start) {
    const auto asks = [](CamShaft<cams>& of) {
        const std::array<std::byte, sizeof(std::int64_t)> finer{std::byte{8}};
        const ProposedValue value{reinterpret_cast<std::byte*>(&of.codes_per_turn), finer.data()};
        return of.accepts(Proposal{{&value, 1}});
    };
    EXPECT_EQ(asks(shaft).view(), "the encoder is described at a start; write it into the table");
    CamShaft<cams> early;
    EXPECT_TRUE(asks(early).empty());
}

TEST_F(Turning, windows_are_left_at_start_and_stop) {
    EXPECT_EQ(ejector.rests.size(), 1u);
    EXPECT_TRUE(ejector.hits.empty());
    world.stop();
    EXPECT_EQ(ejector.rests.size(), 2u);
}

struct Counting : Turning {
    Counting() : Turning{AtRunTime<counting, test_board>::machine()} {}
};

TEST_F(Counting, a_turn_starts_at_the_first_count_despite_wraps) {
    encoder.offset = 65'000;
    run(20s); // 80'000 codes
    EXPECT_EQ(ejector.hits.size(), 20u);
    expect_near(ejector.hits, 80.0 - 1.8 + 0.36, 0.5); // the first code arrived after a millisecond
    EXPECT_EQ(ejector.lost, 0);
}

TEST_F(Counting, a_turn_starts_anew_after_a_loss) {
    run(250ms);
    encoder.silent = true;
    run(100ms);
    encoder.silent = false;
    encoder.deg = 0.0;
    ejector.hits.clear();
    run(1s);
    ASSERT_EQ(ejector.hits.size(), 1u);
    expect_near(ejector.hits, 80.0 - 1.8, 0.8);
}

TEST_F(Counting, impossible_codes_and_stamps_are_ignored) { expect_forgets_noise(); }

TEST_F(Counting, a_far_future_stamp_does_not_block_a_standing_shaft) {
    encoder.deg_s = 0.0;
    run(300ms);
    encoder.ahead = 1h;
    run(1ms);
    encoder.ahead = 0ns;
    encoder.deg_s = 360.0;
    run(2s);
    EXPECT_NEAR(shaft.speed_rpm.last(), 60.0, 0.5);
    EXPECT_GE(ejector.hits.size(), 1u);
}

TEST_F(Counting, nothing_fires_backwards) {
    encoder.deg_s = -360.0;
    run(3s);
    EXPECT_EQ(shaft.fired.last(), 0);
    EXPECT_TRUE(shaft.valid.last());
    EXPECT_NEAR(shaft.speed_rpm.last(), -60.0, 0.5);
}

TEST_F(Turning, a_forced_code_without_a_writer_ends_with_the_force) {
    encoder.silent = true;
    run(5ms);
    End end;
    ASSERT_TRUE(resolve(instance.machine().table, "shaft.code", FacetKind::input, end).empty());
    const PortOperations& port = *facet_at(instance.machine().table, end).port;
    const auto look = [&](Duration time) {
        instance.engines()[instance.machine().index.activity[end.component]].waiter().wake();
        run(time);
    };
    for (std::int64_t code = 0; code < 1200; code += 4) {
        port.force(instance.place_of(end), true, reinterpret_cast<const std::byte*>(&code));
        look(1ms);
    }
    EXPECT_TRUE(shaft.valid.last());
    port.release(instance.place_of(end), true);
    look(1s);
    EXPECT_FALSE(shaft.valid.last());
    EXPECT_EQ(shaft.speed_rpm.last(), 0);
}

TEST_F(Turning, codes_with_future_stamps_count_from_their_reception) {
    for (const Duration ahead : {Duration{10ms}, Duration{100ms}, Duration{900ms}}) {
        encoder.ahead = 0ms;
        run(2s);
        encoder.ahead = ahead;
        run(10ms);
        ejector.marks.clear();
        for (int n = 0; n < 3000; ++n) {
            run(1ms);
            ASSERT_TRUE(shaft.valid.last());
            ASSERT_LT(std::abs(std::remainder(shaft.angle_deg.last() - encoder.deg, 360.0)), 2.0);
        }
        expect_near(ejector.marks, 40.0, 0.5);
    }
}

} // namespace
} // namespace tappet
