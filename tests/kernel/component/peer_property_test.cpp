// A peer sets and reads a property by rows of the table: in the owner's engine, within its range, with its
// consent, and only while it runs.
#include "tests/kernel/machine/virtual_rig.hpp"

#include <limits>

namespace tappet {
namespace {

enum class Mode : std::uint8_t { slow, fast };

} // namespace
template <> inline constexpr auto names_of<Mode> = std::array<std::string_view, 2>{"slow", "fast"};
namespace {

struct Pump {
    Property<double> limit{4.0};
    Property<double> least{1.0};
    Property<Mode> mode{Mode::slow};
    int changes = 0;

    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        return proposal.of(limit) < proposal.of(least) ? Sentence{"set limit to no less than least"}
                                                       : Sentence{};
    }
    void changed() noexcept TAPPET_REALTIME { ++changes; }
    static constexpr auto interface() {
        return facets(
            bag("limits", "of the pressure",
                property<&Pump::limit>("most", "bar", "of the pressure", range(0, 16)),
                property<&Pump::least>("least", "bar", "of the pressure", range(0, 16))),
            property<&Pump::mode>("mode", "", "of the motor"), setter<&Pump::limit>("set_limit", "by a peer"),
            getter<&Pump::limit>("get_limit", "for a peer"), setter<&Pump::mode>("set_mode", "by a peer"),
            getter<&Pump::mode>("get_mode", "for a peer"));
    }
};

struct Tuner {
    CommandCall<double> set;
    CommandCall<double&> get;
    CommandCall<Mode> set_mode;
    CommandCall<Mode&> get_mode;

    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(sends<&Tuner::set>("set", "the limit"), sends<&Tuner::get>("get", "the limit"),
                      sends<&Tuner::set_mode>("set_mode", "of the pump", optional),
                      sends<&Tuner::get_mode>("get_mode", "of the pump", optional));
    }
};

// clang-format off
constexpr auto table = machine("pressure",
    components(component<Pump>("pump"), component<Tuner>("tuner"), component<Tuner>("near")),
    activities(
        activity("fast", every(1ms),  budget(50us), runs("pump", "near")),
        activity("slow", every(10ms), budget(50us), runs("tuner"))),
    connections(),
    reactions(
        uses("tuner.set", "pump.set_limit"), uses("tuner.get", "pump.get_limit"),
        uses("tuner.set_mode", "pump.set_mode"), uses("tuner.get_mode", "pump.get_mode"),
        uses("near.set", "pump.set_limit"), uses("near.get", "pump.get_limit")),
    behaviours());
// clang-format on

/// By a peer of another activity, and by one of the owner's own.
struct PeerProperty : testing::TestWithParam<const char*>, RunningRig<table> {
    Pump& pump = the<Pump>("pump");
    Tuner& tuner = the<Tuner>(GetParam());

    const int configured = pump.changes; ///< told as it was configured

    template <class Call, class... Values> CommandState send(Call& call, const Values&... values) {
        EXPECT_TRUE(call.reset());
        EXPECT_TRUE(call.send(values...));
        EXPECT_TRUE(run(20ms));
        return call.state();
    }
};
struct RunningMode : testing::Test, RunningRig<table> {
    Pump& pump = the<Pump>("pump");
    Tuner& tuner = the<Tuner>("tuner");
};
INSTANTIATE_TEST_SUITE_P(_, PeerProperty, testing::Values("tuner", "near"));

TEST_P(PeerProperty, is_set_and_read) {
    EXPECT_EQ(send(tuner.set, 7.5), CommandState::done);
    EXPECT_EQ(pump.limit.get(), 7.5);
    EXPECT_EQ(pump.changes, configured + 1);
    EXPECT_EQ(send(tuner.get), CommandState::done);
    EXPECT_EQ(tuner.get.result(), 7.5);
}

TEST_P(PeerProperty, is_set_in_the_owners_engine_only) {
    ASSERT_TRUE(tuner.set.send(7.5));
    EXPECT_EQ(pump.limit.get(), 4.0);
    pass(20ms);
    EXPECT_EQ(pump.limit.get(), 7.5);
}

TEST_P(PeerProperty, keeps_its_value_when_the_new_one_is_out_of_range_or_no_number) {
    for (const double wrong :
         {16.5, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(send(tuner.set, wrong), CommandState::rejected) << wrong;
        EXPECT_EQ(pump.limit.get(), 4.0) << wrong;
    }
    EXPECT_EQ(pump.changes, configured);
    EXPECT_EQ(send(tuner.set, 16.0), CommandState::done) << "the end of the range is in it";
}

TEST_P(PeerProperty, keeps_its_value_when_the_owner_does_not_consent) {
    EXPECT_EQ(send(tuner.set, 0.5), CommandState::rejected);
    EXPECT_EQ(pump.limit.get(), 4.0);
    EXPECT_EQ(pump.changes, configured);
}

TEST_P(PeerProperty, is_not_reached_while_the_owner_does_not_run) {
    ASSERT_EQ(change(0, LifeChange::stop, 20ms).outcome, LifeOutcome::done);
    EXPECT_EQ(send(tuner.set, 7.5), CommandState::rejected);
    EXPECT_EQ(send(tuner.get), CommandState::rejected);
    EXPECT_EQ(pump.limit.get(), 4.0);
    ASSERT_EQ(change(0, LifeChange::start, 20ms).outcome, LifeOutcome::done);
    EXPECT_EQ(send(tuner.set, 7.5), CommandState::done);
}

TEST_F(RunningMode, of_an_enumeration_is_one_of_its_values) {
    ASSERT_TRUE(tuner.set_mode.send(Mode::fast));
    pass(20ms);
    EXPECT_EQ(pump.mode.get(), Mode::fast);
    ASSERT_TRUE(tuner.get_mode.send());
    pass(20ms);
    EXPECT_EQ(tuner.get_mode.result(), Mode::fast);
    ASSERT_TRUE(tuner.set_mode.send(static_cast<Mode>(7)));
    pass(20ms);
    EXPECT_EQ(tuner.set_mode.state(), CommandState::rejected);
    EXPECT_EQ(pump.mode.get(), Mode::fast);
}

} // namespace
} // namespace tappet
