// The states of the robot that holds the tool: a script, compiled against the components that it names.
#pragma once

#include "apps/two_robots/generators.hpp"
#include "apps/two_robots/joints.hpp"
#include "apps/two_robots/k361/tool_robot.osd.hpp"
#include "apps/two_robots/robot.hpp"
#include "apps/two_robots/tool/replay.hpp"
#include "kernel/control/chain_switch.hpp"
#include "kernel/script/compiled.hpp"

namespace two_robots::k361 {

/// The tool's loop runs in its own activity.
inline constexpr auto reach =
    script_reach(reachable<Robot>("robot"), reachable<ChainSwitch>("mode"), reachable<JointPath>("path"),
                 reachable<JointEffector>("drives"), reachable<Replay>("replay", false));

inline constexpr const ScriptUnit& states = compiled_script<scripts::tool_robot, reach>;

} // namespace two_robots::k361
