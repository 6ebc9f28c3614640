// spin searches state machines, built from the tables that run (thesis 5.2, 6.2.5): no deadlock, each state
// reachable, the final state reached from everywhere, invariants kept; it must find each seeded fault.
#include "apps/car_tracking/behaviour.hpp"
#include "apps/carpet_loom/loom_model.hpp"
#include "tests/toolchain/tools/chart/sample.hpp"
#include "toolchain/tools/chart/promela.hpp"
#include "toolchain/tools/chart/spin.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <vector>

namespace tappet::chart {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

std::string in_words(const std::vector<std::string>& list) {
    std::string text;
    for (const std::string& each : list) text += each + "\n";
    return text;
}

SpinSearch searched(const PromelaModel& model, const std::vector<std::string>& defines) {
    EXPECT_EQ(model.fault, "");
    SpinSearch found = search(model.text, defines);
    EXPECT_TRUE(found.ran) << found.output;
    EXPECT_TRUE(found.complete || found.errors > 0) << found.output;
    std::cout << in_words(defines) << found.states << " states, " << found.seconds << " s\n";
    return found;
}

/// Expects a search without findings.
SpinSearch found_sound(const PromelaModel& model, const std::vector<std::string>& defines) {
    SpinSearch found = searched(model, defines);
    EXPECT_EQ(found.errors, 0) << found.error << "\n" << in_words(found.trail);
    return found;
}

/// States, transitions, events and requests that no run reaches.
std::vector<std::string> never(const SpinSearch& found) {
    std::vector<std::string> marks;
    for (const std::string& mark : found.unreached)
        if (mark.starts_with("state ") || mark.starts_with("transition ") || mark.starts_with("event "))
            marks.push_back(mark);
    return marks;
}

class Verification : public testing::Test {
protected:
    void SetUp() override {
        if (!has_spin()) GTEST_SKIP() << "spin is not installed; ci/setup does it";
    }
};

// ---- one machine

void expect_sound(const Chart& chart) {
    const PromelaModel model = to_promela(chart);
    found_sound(model, {});
    const SpinSearch asked = found_sound(model, {"REQUESTS"});
    EXPECT_THAT(never(asked), IsEmpty());
    found_sound(model, {"STOP"});
}

TEST_F(Verification, proves_that_the_loom_has_no_deadlock_and_reaches_every_state) {
    expect_sound(charts_of(carpet::table.view()).at(0));
}

TEST_F(Verification, proves_the_same_of_regions_history_and_choices) { expect_sound(press()); }

TEST_F(Verification, proves_the_same_of_the_flat_form_of_the_car_trackers_script) {
    const Chart chart = charts_of(car_tracking::tracking_script, "tracking").at(0);
    expect_sound(chart);
    // The program runs until stopProgram, which only an event sets: the model follows that variable.
    EXPECT_THAT(to_promela(chart).text, HasSubstr("tracking_v_stopProgram = 1;"));
    found_sound(to_promela(chart), {"FAILURES", "STOP"});
}

TEST_F(Verification, finds_a_state_that_is_never_left) {
    static constexpr std::array states{state("a", initial), state("b"), state("end", final)};
    static constexpr std::array rows{transition("a", "b", on("panel.go")),
                                     transition("a", "end", on("panel.stop"))};
    const Chart chart = chart_of("trap", states, rows);
    const SpinSearch found = searched(to_promela(chart), {});
    EXPECT_GT(found.errors, 0);
    EXPECT_THAT(found.error, HasSubstr("invalid end state"));
    EXPECT_THAT(in_words(found.trail), HasSubstr("transition trap 1 a -> b"));
}

TEST_F(Verification, finds_an_unreachable_state) {
    static constexpr std::array states{state("a", initial), state("b"), state("end", final)};
    static constexpr std::array rows{transition("a", "end", on("panel.stop")),
                                     transition("b", "a", on("panel.go"))};
    const Chart chart = chart_of("gap", states, rows);
    EXPECT_THAT(never(searched(to_promela(chart), {"REQUESTS"})), Contains("state gap b"));
}

// ---- the loom: its states with the release of the weft, by its own reactions

Composition loom() { return {charts_of(carpet::table.view()), carpet::table.view(), carpet::model}; }

TEST_F(Verification, proves_every_invariant_of_the_loom_with_its_weft) {
    const PromelaModel model = to_promela(loom());
    const SpinSearch found = found_sound(model, {"REQUESTS"});
    EXPECT_THAT(never(found), IsEmpty());
    EXPECT_GT(found.states, 10'000) << "so small a space shows nothing";
}

TEST_F(Verification, proves_that_the_loom_with_its_weft_can_always_finish) {
    found_sound(to_promela(loom()), {"STOP"});
}

/// The loom with one reaction row changed.
struct FaultyLoom {
    std::vector<ReactionRow> rows{carpet::table.reactions.begin(), carpet::table.reactions.end()};

    ReactionRow& row(std::string_view event, std::string_view operation) {
        const auto found = std::ranges::find_if(rows, [&](const ReactionRow& each) {
            return each.event == event && each.target.operation == operation;
        });
        EXPECT_NE(found, rows.end()) << event << " " << operation;
        return *found;
    }
    [[nodiscard]] SpinSearch search() const {
        Composition faulty = loom();
        faulty.machine.reactions = rows;
        return searched(to_promela(faulty), {});
    }
};

TEST_F(Verification, finds_a_weft_that_is_not_held_when_the_brake_falls) {
    FaultyLoom faulty;
    std::erase_if(faulty.rows, [](const ReactionRow& each) { return each.target.operation == "weft.hold"; });
    const SpinSearch found = faulty.search();
    ASSERT_GT(found.errors, 0);
    EXPECT_THAT(found.error, HasSubstr("brake<=1"));
    EXPECT_THAT(in_words(found.trail), HasSubstr("world shaft.brake_now"));
}

TEST_F(Verification, finds_a_weft_that_is_released_at_the_wrong_angle) {
    FaultyLoom faulty;
    faulty.row("shaft.weft_opens", "weft.on_release_angle").event = "shaft.offer_pattern";
    const SpinSearch found = faulty.search();
    ASSERT_GT(found.errors, 0);
    EXPECT_THAT(found.error, HasSubstr("angle>=2"));
}

TEST_F(Verification, finds_an_emergency_that_does_not_reach_the_weft) {
    FaultyLoom faulty;
    faulty.row("loom.inhibit_weft", "weft.inhibit").target.operation = "weft.on_arrival";
    const SpinSearch found = faulty.search();
    ASSERT_GT(found.errors, 0);
}

// ---- bad input

TEST(Model, with_an_unknown_event_is_refused_with_the_nearest_one) {
    static constexpr auto rows = verification(only_when("weft.open_valv", "true", "a slip of the pen"));
    Composition wrong = loom();
    wrong.model = rows;
    EXPECT_EQ(to_promela(wrong).fault,
              "verification of \"carpet-loom\": there is no event \"weft.open_valv\"; did you "
              "mean \"weft.open_valve\"?");
}

TEST(Model, with_a_cycle_of_events_is_refused) {
    static constexpr auto rows = verification(operation("weft.hold", emits("shaft.brake_now")));
    Composition wrong = loom();
    wrong.model = rows;
    EXPECT_THAT(to_promela(wrong).fault, HasSubstr("\"shaft.brake_now\" leads synchronously back to itself"));
}

} // namespace
} // namespace tappet::chart
