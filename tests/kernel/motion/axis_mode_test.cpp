// The state diagram of an axis compared with PLCopen's, cell by cell.
#include "kernel/motion/axis_mode.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace tappet::motion::test {
namespace {

using enum AxisMode;
using enum AxisCommand;

constexpr std::array modes{disabled,          standstill,          homing,   discrete_motion,
                           continuous_motion, synchronized_motion, stopping, error_stop};
constexpr std::array commands{power_on, power_off, home, move,  move_on, superimpose, synchronize,
                              release,  halt,      stop, reset, done,    error};

TEST(AxisMode, follows_the_diagram_of_plcopen) {
    // Rows are modes, columns are commands, in their order; a dot is a refusal.
    // clang-format off
    constexpr std::array<std::string_view, 8> diagram{
        // on off home move on superimpose sync release halt stop reset done error
        "s...........E",
        ".dhDCDS..X..E",
        ".d.......X.sE",
        ".d.DCDS.DX.sE",
        ".d.DCCS.DX..E",
        ".d.DCSSCDX..E",
        ".d.........sE",
        "..........s.E"};
    // clang-format on
    constexpr std::string_view letters = "dshDCSXE";
    for (std::size_t m = 0; m < modes.size(); ++m)
        for (std::size_t c = 0; c < commands.size(); ++c) {
            const auto found = after(modes[m], commands[c]);
            const char said = found ? letters[static_cast<std::size_t>(*found)] : '.';
            EXPECT_EQ(said, diagram[m][c]) << to_text(modes[m]) << ", command " << c;
        }
    EXPECT_EQ(
        describe(after(disabled, move).error()).view(),
        "element 0: the axis does not take this command in its state; bring it to standstill, or reset it");
}

TEST(AxisMode, continues_a_motion_when_another_is_superimposed) {
    for (const AxisMode running : {discrete_motion, continuous_motion, synchronized_motion})
        EXPECT_EQ(after(running, superimpose), running) << to_text(running);
    EXPECT_EQ(after(standstill, superimpose), after(standstill, move)) << "a relative motion";
}

TEST(AxisMode, reaches_every_mode_from_every_mode) {
    for (const AxisMode from : modes) {
        std::set<AxisMode> reached{from};
        for (std::size_t before = 0; before != reached.size();) {
            before = reached.size();
            for (const AxisMode mode : std::set<AxisMode>{reached})
                for (const AxisCommand command : commands)
                    if (const auto next = after(mode, command)) reached.insert(*next);
        }
        EXPECT_EQ(reached.size(), modes.size()) << to_text(from);
    }
}

TEST(AxisMode, has_the_names_of_plcopen) {
    EXPECT_EQ(to_text(disabled), "Disabled");
    EXPECT_EQ(to_text(synchronized_motion), "SynchronizedMotion");
    EXPECT_EQ(to_text(error_stop), "ErrorStop");
}

} // namespace
} // namespace tappet::motion::test
