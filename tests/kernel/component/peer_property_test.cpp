// A peer sets and reads a property by rows of the table: in the owner's engine, within its range, with its
// consent, and only while the owner runs.
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

/// Inherits the member and declares a narrower range.
struct SmallPump : Pump {
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        return proposal.of(limit) == 3.0 ? Sentence{"not that one"} : Sentence{};
    }
    void changed() noexcept TAPPET_REALTIME { changes += 100; }
    static constexpr auto interface() {
        return facets(property<&SmallPump::limit>("most", "bar", "of the pressure", range(0, 5)),
                      property<&SmallPump::least>("least", "bar", "of the pressure", range(0, 5)),
                      property<&SmallPump::mode>("mode", "", "of the motor"),
                      setter<&SmallPump::limit>("set_limit", "by a peer"),
                      getter<&SmallPump::limit>("get_limit", "for a peer"));
    }
};

struct Recipe {
    Property<Sequence<double, 4>> steps{};
    Property<Text<8>> name{};
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(property<&Recipe::steps>("steps", "mm", "of the cut", range(0, 10)),
                      property<&Recipe::name>("name", "", "of the part"),
                      setter<&Recipe::steps>("set_steps", "by a peer"),
                      setter<&Recipe::name>("set_name", "by a peer"));
    }
};
struct Desk {
    CommandCall<Sequence<double, 4>> steps;
    CommandCall<Text<8>> name;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(sends<&Desk::steps>("steps", "of the cut"), sends<&Desk::name>("name", "of the part"));
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
    components(component<Pump>("pump"), component<Tuner>("tuner"), component<Tuner>("near"),
               component<SmallPump>("small"), component<Tuner>("careful"), component<Recipe>("recipe"), component<Desk>("desk")),
    activities(
        activity("fast", every(1ms),  budget(50us), runs("pump", "near", "small", "careful", "recipe", "desk")),
        activity("slow", every(10ms), budget(50us), runs("tuner"))),
    connections(),
    reactions(
        uses("tuner.set", "pump.set_limit"), uses("tuner.get", "pump.get_limit"),
        uses("tuner.set_mode", "pump.set_mode"), uses("tuner.get_mode", "pump.get_mode"),
        uses("near.set", "pump.set_limit"), uses("near.get", "pump.get_limit"),
        uses("careful.set", "small.set_limit"), uses("careful.get", "small.get_limit"),
        uses("desk.steps", "recipe.set_steps"), uses("desk.name", "recipe.set_name")),
    behaviours());
// clang-format on

/// Set by a peer of another activity and by one of the owner's activity.
struct PeerProperty : testing::TestWithParam<const char*>, RunningRig<table> {
    Pump& pump = the<Pump>("pump");
    Tuner& tuner = the<Tuner>(GetParam());

    const int configured = pump.changes; ///< changed() ran during configuration

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

TEST_P(PeerProperty, changes_only_in_the_owners_engine) {
    ASSERT_TRUE(tuner.set.send(7.5));
    EXPECT_EQ(pump.limit.get(), 4.0);
    pass(20ms);
    EXPECT_EQ(pump.limit.get(), 7.5);
}

TEST_P(PeerProperty, keeps_its_value_when_the_new_one_is_invalid) {
    for (const double wrong :
         {16.5, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(send(tuner.set, wrong), CommandState::rejected) << wrong;
        EXPECT_EQ(pump.limit.get(), 4.0) << wrong;
    }
    EXPECT_EQ(pump.changes, configured);
    EXPECT_EQ(send(tuner.set, 16.0), CommandState::done) << "the end of the range is in it";
}

TEST_P(PeerProperty, keeps_its_value_when_the_owner_rejects_the_new_one) {
    EXPECT_EQ(send(tuner.set, 0.5), CommandState::rejected);
    EXPECT_EQ(pump.limit.get(), 4.0);
    EXPECT_EQ(pump.changes, configured);
}

TEST_P(PeerProperty, is_unreachable_while_the_owner_is_not_running) {
    ASSERT_EQ(change(0, LifeChange::stop, 20ms).outcome, LifeOutcome::done);
    EXPECT_EQ(send(tuner.set, 7.5), CommandState::rejected);
    EXPECT_EQ(send(tuner.get), CommandState::rejected);
    EXPECT_EQ(pump.limit.get(), 4.0);
    ASSERT_EQ(change(0, LifeChange::start, 20ms).outcome, LifeOutcome::done);
    EXPECT_EQ(send(tuner.set, 7.5), CommandState::done);
}

TEST_F(RunningMode, accepts_only_values_of_its_enumeration) {
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

/// Sends, and lets the owner serve it.
struct Served : testing::Test, RunningRig<table> {
    template <class Call, class... Values> CommandState send(Call& call, const Values&... values) {
        EXPECT_TRUE(call.reset());
        EXPECT_TRUE(call.send(values...));
        EXPECT_TRUE(run(20ms));
        return call.state();
    }
};

TEST_F(Served, property_follows_the_rules_of_the_derived_component) {
    auto& small = the<SmallPump>("small");
    auto& careful = the<Tuner>("careful");
    const int configured = small.changes;
    EXPECT_EQ(send(careful.set, 6.0), CommandState::rejected) << "its own range, not the base's";
    EXPECT_EQ(send(careful.set, 3.0), CommandState::rejected) << "its own consent";
    EXPECT_EQ(small.changes, configured);
    EXPECT_EQ(send(careful.set, 2.5), CommandState::done);
    EXPECT_EQ(small.limit.get(), 2.5);
    EXPECT_EQ(small.changes, configured + 100) << "its own changed()";
}

TEST_F(Served, list_is_rejected_when_longer_than_its_type) {
    auto& recipe = the<Recipe>("recipe");
    Sequence<double, 4> list{{1.0, 2.0, 3.0, std::numeric_limits<double>::quiet_NaN()}, 3};
    EXPECT_EQ(send(the<Desk>("desk").steps, list), CommandState::done) << "behind its end may stand anything";
    EXPECT_EQ(recipe.steps.get().size(), 3u);
    EXPECT_EQ(recipe.steps.get().items[3], 0.0) << "but it is not kept";
    for (const std::size_t wild : {std::size_t{5}, std::size_t{1} << 30, ~std::size_t{0}}) {
        list.used = wild;
        EXPECT_EQ(send(the<Desk>("desk").steps, list), CommandState::rejected) << wild;
        EXPECT_EQ(recipe.steps.get().size(), 3u);
    }
}

TEST_F(Served, text_is_rejected_when_too_long_or_impossible_to_save) {
    auto& recipe = the<Recipe>("recipe");
    EXPECT_EQ(send(the<Desk>("desk").name, Text<8>{"plate"}), CommandState::done);
    Text<8> wild{"wild"};
    wild.length = 0x0fff'ffff;
    EXPECT_EQ(send(the<Desk>("desk").name, wild), CommandState::rejected);
    EXPECT_EQ(send(the<Desk>("desk").name, Text<8>{"a\0b"}), CommandState::rejected);
    EXPECT_EQ(recipe.name.get().view(), "plate");
}

} // namespace
} // namespace tappet
