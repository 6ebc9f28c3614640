// How a box judges a slot: it distinguishes a failed trial, an interrupted start, and a rejected version.
#include "board/box/slot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::box {
namespace {

using init::SlotState;
using testing::HasSubstr;

Slot slot(SlotState state, Standing standing, unsigned cut_short = 0) {
    return {.state = {.revision = 3, .state = state}, .record = {standing, cut_short}};
}

TEST(Records, are_read_as_they_were_written_and_fill_one_sector) {
    for (const Standing standing : {Standing::untried, Standing::proven, Standing::harmed, Standing::silent})
        for (const unsigned cut_short : {0U, 2U}) {
            const Record record{standing, cut_short};
            EXPECT_EQ(encode(record).size(), 512u);
            EXPECT_EQ(record_of(encode(record)), record);
        }
}

TEST(Records, are_those_of_an_untried_version_when_malformed) {
    for (const char* bytes : {"", "standing", "standing mine 1", "proven"})
        EXPECT_EQ(record_of(bytes), Record{}) << bytes;
    EXPECT_EQ(record_of(std::string(512, '\0')), Record{});
}

TEST(Slots, are_on_trial_until_they_have_proven_themselves) {
    EXPECT_TRUE(slot(SlotState::testing, Standing::untried).is_on_trial());
    EXPECT_TRUE(slot(SlotState::installed, Standing::untried).is_on_trial())
        << "the loader could not mark it";
    EXPECT_FALSE(slot(SlotState::testing, Standing::proven).is_on_trial()) << "it only starts";
    EXPECT_FALSE(slot(SlotState::good, Standing::untried).is_on_trial()) << "as a box comes from its maker";
}

TEST(Fallbacks, follow_from_an_interrupted_start) {
    const Slot runs = slot(SlotState::good, Standing::proven);
    EXPECT_TRUE(is_fallback(runs, slot(SlotState::failed, Standing::proven)));
    EXPECT_TRUE(
        is_fallback(slot(SlotState::good, Standing::untried), slot(SlotState::failed, Standing::proven)))
        << "as a box comes from its maker";
}

TEST(Fallbacks, do_not_follow_from_a_failed_trial_or_a_rejected_version) {
    const Slot runs = slot(SlotState::good, Standing::proven);
    for (const Standing standing : {Standing::untried, Standing::harmed, Standing::silent})
        EXPECT_FALSE(is_fallback(runs, slot(SlotState::failed, standing)));
    EXPECT_FALSE(is_fallback(runs, slot(SlotState::good, Standing::proven))) << "older";
    EXPECT_FALSE(
        is_fallback(slot(SlotState::testing, Standing::proven), slot(SlotState::failed, Standing::proven)))
        << "the newest runs, and the loader's file of the older one is torn";
}

TEST(Starts, are_repeated_twice_when_interrupted) {
    Record record{Standing::proven, 0};
    for (const unsigned times : {1U, 2U}) {
        record = after_cut_short(record, false);
        EXPECT_EQ(record, (Record{Standing::proven, times}));
    }
    EXPECT_EQ(after_cut_short(record, false).standing, Standing::silent);
    EXPECT_EQ(after_cut_short({Standing::proven, 0}, true).standing, Standing::harmed) << "at once";
}

TEST(Standings, are_shown_with_their_reason) {
    EXPECT_EQ(standing_of(slot(SlotState::installed, Standing::proven)), "good")
        << "what the loader does is its own";
    EXPECT_EQ(standing_of(slot(SlotState::testing, Standing::untried)), "on trial");
    EXPECT_EQ(summary_of(slot(SlotState::testing, Standing::untried)),
              "version unknown, revision 3, on trial");
    EXPECT_EQ(standing_of(slot(SlotState::failed, Standing::untried)), "failed");
    EXPECT_THAT(standing_of(slot(SlotState::failed, Standing::harmed)),
                HasSubstr("given up: its kernel is not what"));
    EXPECT_THAT(standing_of(slot(SlotState::failed, Standing::silent, 2)),
                HasSubstr("given up: 3 starts in a row"));
}

} // namespace
} // namespace tappet::box
