// The states of the robot that holds the body: a script, compiled against the components that it names.
#pragma once

#include "apps/two_robots/generators.hpp"
#include "apps/two_robots/homing.hpp"
#include "apps/two_robots/joints.hpp"
#include "apps/two_robots/k160/body_robot.osd.hpp"
#include "apps/two_robots/robot.hpp"
#include "kernel/control/chain_switch.hpp"
#include "kernel/script/compiled.hpp"

namespace two_robots::k160 {

inline constexpr auto reach =
    script_reach(reachable<Robot>("robot"), reachable<ChainSwitch>("mode"), reachable<Homing>("homing"),
                 reachable<JointPath>("path"), reachable<JointEffector>("drives"));

inline constexpr const ScriptUnit& states = compiled_script<scripts::body_robot, reach>;

} // namespace two_robots::k160
