// A new weave is loaded into the weaving loom (thesis 5.2.4) at an angle of the shaft. A faulty one is
// refused with its line, a failing one is rolled back, and the loom keeps weaving.
#include "tests/apps/carpet_loom/loom_rig.hpp"
#include "toolchain/machine/test_names.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

namespace tappet::carpet {
namespace {

using testing::HasSubstr;

constexpr std::uint16_t twill[] = {0x1111, 0x2222, 0x4444, 0x8888};

class WeaveBehaviour : public testing::Test {
protected:
    LoomRig rig{7};
    BehaviourSlot& slot = *rig.run().instance().slot_of("weft");

    void SetUp() override { ASSERT_TRUE(rig.weave(10)) << rig.reason(); }

    std::string load(const std::string& file, std::string_view moment) {
        std::ifstream in{LOOM_BEHAVIOURS "/" + file};
        std::ostringstream text;
        text << in.rdbuf();
        const std::string script = text.str();
        EXPECT_FALSE(script.empty()) << file;
        std::ranges::copy(script, slot.text().begin());
        if (const Sentence fault = slot.compile(script.size(), file); !fault.empty())
            return std::string{fault.view()};
        SlotMoment at;
        if (const Sentence fault = slot.parse_moment(moment, at); !fault.empty())
            return std::string{fault.view()};
        EXPECT_TRUE(slot.ask(BehaviourSlot::Change::take_over, at));
        EXPECT_TRUE(rig.run().instance().requests().post_change(slot));
        return {};
    }
    std::uint64_t picks_of(std::uint16_t pattern) {
        const loom::Report report = rig.report();
        for (const loom::LiftedPattern& each : report.patterns)
            if (each.pattern == pattern) return each.picks;
        return 0;
    }
    std::uint64_t twill_picks() {
        std::uint64_t sum = 0;
        for (const std::uint16_t pattern : twill) sum += picks_of(pattern);
        return sum;
    }
    double angle() { return rig.component<MainShaft>("shaft").angle_deg.last(); }
    void expect_undisturbed() {
        EXPECT_EQ(rig.state(), "weave") << rig.reason();
        EXPECT_EQ(rig.report().stops_total, 0u);
        EXPECT_EQ(rig.report().patterns_repeated, 0u);
        expect_no_damage(rig.report());
        EXPECT_FALSE(rig.run().instance().stop_asked());
    }
};

TEST_F(WeaveBehaviour, a_twill_takes_over_at_its_angle_and_the_loom_weaves_on) {
    ASSERT_EQ(load("twill.osd", "180"), "");
    ASSERT_TRUE(rig.run_until([&] { return slot.phase() == SlotPhase::trial; }, 1s));
    EXPECT_GE(angle(), 180.0);
    EXPECT_LT(angle(), 190.0); // 600 rpm are 3.6 degrees a millisecond, and the rig looks once a millisecond
    const std::uint64_t before = rig.plant().picks();
    ASSERT_TRUE(rig.weave(40));
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
    const std::uint64_t after = rig.plant().picks() - before;
    EXPECT_GE(twill_picks() + 2, after);
    for (const std::uint16_t pattern : twill) EXPECT_NEAR(static_cast<double>(picks_of(pattern)), 10.0, 2.0);
    expect_undisturbed();
}

TEST_F(WeaveBehaviour, a_faulty_weave_is_refused_with_its_line_and_nothing_changes) {
    ASSERT_EQ(load("twill.osd", "shaft.beat_up"), "");
    ASSERT_TRUE(rig.weave(20));
    const std::string refusal = load("faulty_twill.osd", "180");
    EXPECT_THAT(refusal, HasSubstr("faulty_twill.osd:8:"));
    EXPECT_THAT(refusal, HasSubstr("did you mean \"lift\"?"));
    const std::uint64_t before = twill_picks();
    ASSERT_TRUE(rig.weave(20));
    EXPECT_NEAR(static_cast<double>(twill_picks() - before), 20.0, 2.0);
    EXPECT_EQ(slot.script(), "twill.osd");
    expect_undisturbed();
}

TEST_F(WeaveBehaviour, a_failing_weave_is_rolled_back_to_the_one_before_it) {
    ASSERT_EQ(load("twill.osd", "now"), "");
    ASSERT_TRUE(rig.weave(20));
    ASSERT_EQ(load("running_out.osd", "90"), "");
    ASSERT_TRUE(rig.run_until([&] { return slot.roll_backs() == 1; }, 3s));
    EXPECT_EQ(slot.script(), "twill.osd");
    EXPECT_EQ(slot.last_roll_back(), RollBack::error);
    EXPECT_THAT(std::string{slot.describe_roll_back().view()}, HasSubstr("running_out.osd: \"RunningOut\""));
    EXPECT_THAT(std::string{slot.describe_roll_back().view()}, HasSubstr("failed in line 10"));
    EXPECT_GT(picks_of(4), 0u); // it wove, for a few picks
    const std::uint64_t before = twill_picks();
    ASSERT_TRUE(rig.weave(20));
    EXPECT_NEAR(static_cast<double>(twill_picks() - before), 20.0, 2.0);
    expect_undisturbed();
}

TEST_F(WeaveBehaviour, the_loom_weaves_its_carpet_again_after_unloading) {
    ASSERT_EQ(load("twill.osd", "now"), "");
    ASSERT_TRUE(rig.weave(20));
    ASSERT_TRUE(slot.ask(BehaviourSlot::Change::unload));
    ASSERT_TRUE(rig.run().instance().requests().post_change(slot));
    ASSERT_TRUE(rig.weave(3));
    EXPECT_EQ(slot.phase(), SlotPhase::empty);
    const std::uint64_t before = twill_picks();
    ASSERT_TRUE(rig.weave(20));
    EXPECT_EQ(twill_picks(), before);
    expect_undisturbed();
}

TEST(LoomStates, are_active_with_all_that_enclose_them) {
    LoomRig rig{3};
    MachineInstance& machine = rig.run().instance();
    ASSERT_TRUE(rig.run_until([&] { return is_in_state(machine, "loom", "weave"); }, 60s));
    for (const std::string_view active : {"operating", "running", "weave"})
        EXPECT_TRUE(is_in_state(machine, "loom", active)) << active;
    EXPECT_FALSE(is_in_state(machine, "loom", "stopped"));
    EXPECT_EQ(check_state(machine, "loom", "running").view(), "");
}

} // namespace
} // namespace tappet::carpet
