// No NaN or infinity reaches another machine, as a value, with an event, with a command or in its result, in
// steps or unscaled.
#include "tests/drivers/system/pair_run.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace tappet {
namespace {

struct Lead {
    Output<double> level{};
    Output<float> raw{};
    Event<double> moved{};
    CommandCall<double, double&> stop_at{};
    double tells = 5;
    bool acts = false;
    int losses = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        level.write(tells);
        raw.write(static_cast<float>(tells));
        if (!std::exchange(acts, false)) return;
        moved.emit(tells);
        static_cast<void>(stop_at.send(tells));
    }
    void on_loss() noexcept TAPPET_REALTIME { ++losses; }
    static constexpr auto interface() {
        return facets(output<&Lead::level>("level", "mm", "in steps"),
                      output<&Lead::raw>("raw", "mm", "as it is"), event<&Lead::moved>("moved", "to there"),
                      sends<&Lead::stop_at>("stop_at", "stop there"),
                      operation<&Lead::on_loss>("on_loss", "an event is lost"));
    }
};
struct Follow {
    Input<double> level{};
    Input<float> raw{};
    int moves = 0, stops = 0;
    double to = 0, at = 0, answer = 1;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    void move(double where) noexcept TAPPET_REALTIME {
        ++moves;
        to = where;
    }
    bool stop_at(double where, double& result) noexcept TAPPET_REALTIME {
        ++stops;
        at = where;
        result = answer;
        return true;
    }
    static constexpr auto interface() {
        return facets(input<&Follow::level>("level", "mm", "in steps"),
                      input<&Follow::raw>("raw", "mm", "as it is"),
                      operation<&Follow::move>("move", "to there"),
                      command<&Follow::stop_at>("stop_at", "stops there"));
    }
};

// clang-format off
constexpr auto lead_table = machine("lead", components(component<Lead>("x")),
    activities(activity("x", every(5ms), runs("x"), budget(50us))), connections(), reactions(), behaviours());
constexpr auto follow_table = machine("follow", components(component<Follow>("x")),
    activities(activity("x", every(5ms), runs("x"), budget(50us))), connections(), reactions(), behaviours());
constexpr auto two = system("two", nodes(node<lead_table>("a"), node<follow_table>("b")),
    pair::usual_wire("wire"),
    crossings(
        across(data("a.x.level", "b.x.level", stale_after(60ms), hold), every(10ms), in_bits(24, 0.1)),
        across(data("a.x.raw",   "b.x.raw",   stale_after(60ms), hold), every(20ms)),
        across(when("a.x.moved", tell("b.x.move")), at_most(1, 40ms), within(30ms), in_bits(24, 0.1), if_lost("a.x.on_loss")),
        across(uses("a.x.stop_at", "b.x.stop_at"), at_most(1, 100ms), within(20ms), in_bits(24, 0.1))));
// clang-format on

using LeadFirmware = AtRunTime<station<two, "a", lead_table>, board::host>;
using FollowFirmware = AtRunTime<station<two, "b", follow_table>, board::host>;

struct TwoMachines : testing::Test, OnOneWire<LeadFirmware, FollowFirmware> {
    TwoMachines() : OnOneWire{two.view()} {}
    void SetUp() override {
        start();
        a = run.instance(0).find<Lead>("x");
        b = run.instance(1).find<Follow>("x");
        tell(5);
        ASSERT_EQ(b->moves, 1);
        ASSERT_EQ(b->stops, 1);
        ASSERT_EQ(b->raw.get(), 5);
        ASSERT_EQ(a->stop_at.state(), CommandState::done);
    }
    void tell(double what) {
        a->tells = what;
        a->acts = true;
        run.run_for(500ms);
    }
    Lead* a = nullptr;
    Follow* b = nullptr;
};

TEST_F(TwoMachines, ignore_values_that_are_not_finite) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    for (const double none : {std::nan(""), endless, -endless}) {
        tell(none);
        EXPECT_EQ(b->moves, 1) << none;
        EXPECT_EQ(b->stops, 1) << none;
        EXPECT_FALSE(b->level.good()) << none;
        EXPECT_FALSE(b->raw.good()) << none;
        EXPECT_EQ(b->raw.get(), 5) << none;
        EXPECT_EQ(a->stop_at.state(), CommandState::failed) << none;
    }
    EXPECT_EQ(a->losses, 3);
    tell(6);
    EXPECT_EQ(b->to, 6);
    EXPECT_EQ(b->at, 6);
    EXPECT_TRUE(b->raw.good());
    EXPECT_EQ(a->stop_at.state(), CommandState::done);
}

TEST_F(TwoMachines, fail_a_command_whose_result_is_nan) {
    b->answer = std::nan("");
    tell(6);
    EXPECT_EQ(b->stops, 2);
    EXPECT_EQ(a->stop_at.state(), CommandState::failed);
}

} // namespace
} // namespace tappet
