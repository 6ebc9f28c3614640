// An impossible cam table is refused with one message that names the row, the fault and the cure.
#include "kernel/cam/table.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace tappet {
namespace {

template <class... Rows> constexpr Sentence fault_of(const Rows&... rows) {
    return check(cam_table(600_rpm, rows...).view());
}

TEST(CamTable, accepts_a_good_table) {
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

struct Refused {
    std::string_view what;
    Sentence fault;
    std::string_view says;
};

constexpr Refused refused[] = {
    {"a name used twice", fault_of(cam("pick", at(80_deg)), cam("beat", at(0_deg)), cam("pick", at(90_deg))),
     "cam row 'pick': the name is used by two rows; rename one of them"},
    {"a row without a name", fault_of(cam("", at(80_deg))), "cam table: a row has no name; give it one"},
    {"an angle beyond the turn", fault_of(cam("pick", at(400_deg))),
     "cam row 'pick': the angle 400 deg lies outside [0, 360); write 40 deg"},
    {"a negative angle", fault_of(cam("valve", window(20_deg, -10.5_deg))),
     "cam row 'valve': the angle -10.5 deg lies outside [0, 360); write 349.5 deg"},
    {"the angle of a full turn", fault_of(cam("pick", at(360_deg))),
     "cam row 'pick': the angle 360 deg lies outside [0, 360); write 0 deg"},
    {"a dead time longer than a turn", fault_of(cam("weft", at(80_deg), dead_time(120ms))),
     "cam row 'weft': its dead time is 432 deg at the table's maximum speed, not less than a "
     "turn; choose a faster actuator or lower the maximum speed"},
    {"a negative dead time", fault_of(cam("weft", at(80_deg), dead_time(-1us))),
     "cam row 'weft': a dead time or its jitter is negative; give how late the actuator answers"},
    {"a window shorter than its jitter",
     fault_of(cam("valve", window(60_deg, 65_deg), dead_time(2500us), dead_time_jitter(2ms))),
     "cam row 'valve': the window is 5 deg wide, but its dead times and their jitter take 7.2 "
     "deg at the table's maximum speed; widen the window or choose a steadier actuator"},
    {"a window whose closing is fired before its opening",
     fault_of(cam("valve", window(60_deg, 40_deg), dead_time(10ms, 1ms))),
     "cam row 'valve': the way outside the window is 20 deg wide, but its dead times and their "
     "jitter take 32.4 deg at the table's maximum speed; narrow the window or choose a "
     "steadier actuator"},
    {"a window without width", fault_of(cam("valve", window(60_deg, 60_deg))),
     "cam row 'valve': the window opens and closes at one angle; give two angles, or write at(...)"},
    {"exclusive windows that overlap",
     fault_of(cam("main", window(60_deg, 180_deg), exclusive("valves")),
              cam("relay", window(170_deg, 240_deg), exclusive("valves"))),
     "cam row 'relay': its window overlaps that of 'main' by 10 deg, but both are "
     "exclusive(\"valves\"); move one window or drop its group"},
    {"exclusive windows that overlap by the jitter of both dead times",
     fault_of(cam("main", window(60_deg, 180_deg), dead_time_jitter(1ms), exclusive("valves")),
              cam("relay", window(185_deg, 240_deg), dead_time_jitter(1ms), exclusive("valves"))),
     "cam row 'relay': its window overlaps that of 'main' by 2.2 deg with the jitter of both "
     "dead times, but both are exclusive(\"valves\"); move one window or drop its group"},
    {"a point that is exclusive", fault_of(cam("pick", at(80_deg), exclusive("valves"))),
     "cam row 'pick': it is exclusive(\"valves\"), but a point has no width; write window(...) "
     "or drop the group"},
    {"a row that is never fast enough", fault_of(cam("pick", at(80_deg), min_speed(600_rpm))),
     "cam row 'pick': its min_speed is negative or not below the table's maximum speed, so it "
     "never fires; give a speed between 0 and the maximum"},
    {"a table without a speed", check(cam_table(0_rpm, cam("pick", at(80_deg))).view()),
     "cam table: the maximum speed is not above 0; give the fastest speed of the shaft"},
};

TEST(CamTable, refuses_impossible_rows) {
    for (const Refused& each : refused) EXPECT_EQ(each.fault.view(), each.says) << each.what;
}

// The closest allowed rows, and slightly closer ones.
static_assert(fault_of(cam("weft", at(80_deg), dead_time(99ms))).empty());
static_assert(!fault_of(cam("weft", at(80_deg), dead_time(99ms), dead_time_jitter(2ms))).empty());
static_assert(!fault_of(cam("valve", window(60_deg, 90_deg), dead_time(1ms, 10ms))).empty());
static_assert(fault_of(cam("valve", window(60_deg, 100_deg), dead_time(1ms, 10ms))).empty());

constexpr bool overlap(CamPlace one, CamPlace other) {
    return !fault_of(cam("a", one, exclusive("g")), cam("b", other, exclusive("g"))).empty();
}
static_assert(overlap(window(300_deg, 20_deg), window(10_deg, 50_deg)), "over zero");
static_assert(overlap(window(10_deg, 300_deg), window(50_deg, 60_deg)), "one within the other");
static_assert(overlap(window(10_deg, 300_deg), window(10_deg, 60_deg)));
static_assert(!overlap(window(300_deg, 20_deg), window(20_deg, 300_deg)));
static_assert(fault_of(cam("a", window(300_deg, 20_deg), exclusive("g")),
                       cam("b", window(10_deg, 50_deg), exclusive("h")), cam("c", window(0_deg, 90_deg)))
                  .empty());

} // namespace
} // namespace tappet
