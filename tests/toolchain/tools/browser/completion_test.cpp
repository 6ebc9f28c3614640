// Completion knows the commands and the names that each of them takes (thesis 4.8).
#include "toolchain/tools/browser/completion.hpp"

#include "tests/toolchain/tools/browser/sample_machine.hpp"

#include <gmock/gmock.h>

namespace tappet::browser {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

class Completing : public testing::Test {
protected:
    void SetUp() override {
        auto found = Machines::find({.directory = machine.directory()});
        ASSERT_TRUE(found.has_value()) << found.error().sentence;
        machines = std::move(*found);
    }
    Completion after(std::string_view typed) { return complete(machines, typed); }
    SampleMachine machine;
    Machines machines;
};

TEST_F(Completing, an_empty_line_offers_the_commands) {
    EXPECT_THAT(after("").candidates, Contains("watch"));
    EXPECT_THAT(after("").candidates, Contains("quit"));
    EXPECT_THAT(after("wa").candidates, ElementsAre("watch"));
}

TEST_F(Completing, a_command_offers_only_names_that_it_accepts) {
    EXPECT_THAT(after("set ").candidates, ElementsAre("shaft.gains.i", "shaft.gains.p"));
    EXPECT_THAT(after("send ").candidates, ElementsAre("loom.run", "shaft.stop"));
    EXPECT_THAT(after("events ").candidates, ElementsAre("shaft.beat_up"));
    EXPECT_THAT(after("force l").candidates, ElementsAre("loom.angle", "loom.lamp"));
    EXPECT_THAT(after("call s").candidates, ElementsAre("shaft.reset"));
    EXPECT_THAT(after("stop ").candidates, ElementsAre("logic", "loom", "motion", "shaft"));
    EXPECT_THAT(after("get shaft.").candidates, Not(Contains("shaft.stop")));
}

TEST_F(Completing, no_name_is_offered_in_place_of_a_value) {
    EXPECT_THAT(after("set shaft.gains.p ").candidates, IsEmpty());
    EXPECT_THAT(after("set shaft.gains.p 1 ").candidates, ElementsAre("shaft.gains.i", "shaft.gains.p"));
    EXPECT_THAT(after("force loom.lamp ").candidates, IsEmpty());
    EXPECT_THAT(after("get shaft.angle l").candidates, Contains("loom.lamp"));
}

TEST_F(Completing, a_name_extends_as_far_as_all_candidates_agree) {
    const Completion completion = after("set sh");
    EXPECT_EQ(completion.begin, 4u);
    EXPECT_EQ(completion.common(), "shaft.gains.");
    EXPECT_EQ(after("nonsense sh").common(), "");
}

TEST_F(Completing, options_are_offered_after_a_dash) {
    EXPECT_THAT(after("get --js").candidates, ElementsAre("--json"));
    EXPECT_THAT(after("--json ge").candidates, ElementsAre("get"));
}

TEST(CompletingAmongSeveral, a_name_begins_with_a_machine_that_answers) {
    SampleMachine left, right, silent;
    silent.end();
    auto machines = Machines::find(
        {.sockets = {"left=" + left.socket(), "right=" + right.socket(), "silent=" + silent.socket()}});
    ASSERT_TRUE(machines.has_value()) << machines.error().sentence;
    EXPECT_EQ(machines->reachable().size(), 2u);
    const auto after = [&](std::string_view typed) { return complete(*machines, typed).candidates; };
    EXPECT_THAT(after("send "), ElementsAre("left", "left.loom.run", "left.shaft.stop", "right",
                                            "right.loom.run", "right.shaft.stop", "silent"));
    EXPECT_THAT(after("set left.shaft.gains.p 1 l"), ElementsAre("left.shaft.gains.i", "left.shaft.gains.p"));
    EXPECT_THAT(after("events l"), ElementsAre("left.shaft.beat_up"));
    EXPECT_THAT(after("manifest r"), ElementsAre("right"));
}

} // namespace
} // namespace tappet::browser
