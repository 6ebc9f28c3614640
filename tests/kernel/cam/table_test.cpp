// A cam table that cannot work is refused with one sentence that names the row, the fault and the cure.
#include "kernel/cam/table.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace tappet {
namespace {

template <class... Rows> constexpr Sentence fault_of(const Rows&... rows) {
    return check(cam_table(600_rpm, rows...).view());
}

TEST(CamTable, says_nothing_of_a_good_table) {
    static constexpr auto cams = cam_table(
        700_rpm, cam("beat_up", at(0_deg)), cam("pick_window", at(80_deg), dead_time(2500us)),
        cam("arrival", window(200_deg, 260_deg), min_speed(60_rpm), direction(Direction::both)),
        cam("main_nozzle", window(300_deg, 60_deg), dead_time(2500us, 1800us), exclusive("nozzles")),
        cam("relay_nozzle", window(60_deg, 180_deg), dead_time(2500us, 1800us), exclusive("nozzles")));
    static_assert(check(cams.view()).empty());
    EXPECT_EQ(cams.size(), 5u);
    EXPECT_EQ(cams.rows[3].leave_dead_time, Duration{1800us});
    EXPECT_EQ(cams.rows[1].dead_time, Duration{2500us});
}

TEST(CamTable, refuses_a_name_used_twice) {
    constexpr Sentence fault =
        fault_of(cam("pick", at(80_deg)), cam("beat", at(0_deg)), cam("pick", at(90_deg)));
    EXPECT_EQ(fault.view(), "cam row 'pick': the name is used by two rows; rename one of them");
}

TEST(CamTable, refuses_a_row_without_a_name) {
    constexpr Sentence fault = fault_of(cam("", at(80_deg)));
    EXPECT_EQ(fault.view(), "cam table: a row has no name; give it one");
}

TEST(CamTable, refuses_an_angle_outside_the_turn) {
    constexpr Sentence far = fault_of(cam("pick", at(400_deg)));
    EXPECT_EQ(far.view(), "cam row 'pick': the angle 400 deg lies outside [0, 360); write 40 deg");
    constexpr Sentence negative = fault_of(cam("valve", window(20_deg, -10.5_deg)));
    EXPECT_EQ(negative.view(), "cam row 'valve': the angle -10.5 deg lies outside [0, 360); write 349.5 deg");
    constexpr Sentence full = fault_of(cam("pick", at(360_deg)));
    EXPECT_EQ(full.view(), "cam row 'pick': the angle 360 deg lies outside [0, 360); write 0 deg");
}

TEST(CamTable, refuses_a_dead_time_longer_than_a_turn) {
    constexpr Sentence fault = fault_of(cam("weft", at(80_deg), dead_time(120ms)));
    EXPECT_EQ(fault.view(),
              "cam row 'weft': its dead time is 432 deg at the table's maximum speed, not less than a "
              "turn; choose a faster actuator or lower the maximum speed");
    static_assert(fault_of(cam("weft", at(80_deg), dead_time(99ms))).empty());
    static_assert(!fault_of(cam("weft", at(80_deg), dead_time(99ms), dead_time_jitter(2ms))).empty());
}

TEST(CamTable, refuses_a_negative_dead_time) {
    constexpr Sentence fault = fault_of(cam("weft", at(80_deg), dead_time(-1us)));
    EXPECT_EQ(fault.view(),
              "cam row 'weft': a dead time or its jitter is negative; give how late the actuator answers");
}

TEST(CamTable, refuses_a_window_shorter_than_its_jitter) {
    constexpr Sentence fault =
        fault_of(cam("valve", window(60_deg, 65_deg), dead_time(2500us), dead_time_jitter(2ms)));
    EXPECT_EQ(fault.view(),
              "cam row 'valve': the window is 5 deg wide, but its dead times and their jitter take 7.2 "
              "deg at the table's maximum speed; widen the window or choose a steadier actuator");
}

TEST(CamTable, refuses_a_window_whose_closing_is_fired_before_its_opening) {
    static_assert(!fault_of(cam("valve", window(60_deg, 90_deg), dead_time(1ms, 10ms))).empty());
    static_assert(fault_of(cam("valve", window(60_deg, 100_deg), dead_time(1ms, 10ms))).empty());
    constexpr Sentence fault = fault_of(cam("valve", window(60_deg, 40_deg), dead_time(10ms, 1ms)));
    EXPECT_EQ(fault.view(),
              "cam row 'valve': the way outside the window is 20 deg wide, but its dead times and their "
              "jitter take 32.4 deg at the table's maximum speed; narrow the window or choose a "
              "steadier actuator");
}

TEST(CamTable, refuses_a_window_without_width) {
    constexpr Sentence fault = fault_of(cam("valve", window(60_deg, 60_deg)));
    EXPECT_EQ(fault.view(),
              "cam row 'valve': the window opens and closes at one angle; give two angles, or write at(...)");
}

TEST(CamTable, refuses_exclusive_windows_that_overlap) {
    constexpr Sentence fault = fault_of(cam("main", window(60_deg, 180_deg), exclusive("valves")),
                                        cam("relay", window(170_deg, 240_deg), exclusive("valves")));
    EXPECT_EQ(fault.view(), "cam row 'relay': its window overlaps that of 'main' by 10 deg, but both are "
                            "exclusive(\"valves\"); move one window or drop its group");
}

TEST(CamTable, sees_overlaps_over_zero_and_one_window_within_another) {
    static_assert(!fault_of(cam("a", window(300_deg, 20_deg), exclusive("g")),
                            cam("b", window(10_deg, 50_deg), exclusive("g")))
                       .empty());
    static_assert(!fault_of(cam("a", window(10_deg, 300_deg), exclusive("g")),
                            cam("b", window(50_deg, 60_deg), exclusive("g")))
                       .empty());
    static_assert(!fault_of(cam("a", window(10_deg, 300_deg), exclusive("g")),
                            cam("b", window(10_deg, 60_deg), exclusive("g")))
                       .empty());
    static_assert(fault_of(cam("a", window(300_deg, 20_deg), exclusive("g")),
                           cam("b", window(20_deg, 300_deg), exclusive("g")))
                      .empty());
    static_assert(fault_of(cam("a", window(300_deg, 20_deg), exclusive("g")),
                           cam("b", window(10_deg, 50_deg), exclusive("h")), cam("c", window(0_deg, 90_deg)))
                      .empty());
}

TEST(CamTable, counts_the_jitter_of_both_dead_times_between_exclusive_windows) {
    constexpr Sentence fault =
        fault_of(cam("main", window(60_deg, 180_deg), dead_time_jitter(1ms), exclusive("valves")),
                 cam("relay", window(185_deg, 240_deg), dead_time_jitter(1ms), exclusive("valves")));
    EXPECT_EQ(fault.view(),
              "cam row 'relay': its window overlaps that of 'main' by 2.2 deg with the jitter of both "
              "dead times, but both are exclusive(\"valves\"); move one window or drop its group");
}

TEST(CamTable, refuses_a_point_that_is_exclusive) {
    constexpr Sentence fault = fault_of(cam("pick", at(80_deg), exclusive("valves")));
    EXPECT_EQ(fault.view(),
              "cam row 'pick': it is exclusive(\"valves\"), but a point has no width; write window(...) "
              "or drop the group");
}

TEST(CamTable, refuses_a_row_that_is_never_fast_enough) {
    constexpr Sentence fault = fault_of(cam("pick", at(80_deg), min_speed(600_rpm)));
    EXPECT_EQ(fault.view(),
              "cam row 'pick': its min_speed is negative or not below the table's maximum speed, so it "
              "never fires; give a speed between 0 and the maximum");
}

TEST(CamTable, refuses_a_table_without_a_speed) {
    constexpr auto cams = cam_table(0_rpm, cam("pick", at(80_deg)));
    constexpr Sentence fault = check(cams.view());
    EXPECT_EQ(fault.view(),
              "cam table: the maximum speed is not above 0; give the fastest speed of the shaft");
}

} // namespace
} // namespace tappet
