// Controller of the tool's loop: superimposes the tip's set point in the body's frame on the body's motion,
// and commands the result to the flange (thesis fig. 3.11).
#pragma once

#include "apps/two_robots/tool/replay.hpp"

namespace two_robots {

/// Writes nothing while the body is unknown: the component that it commands then falls back. Real-time.
struct Superposition {
    Input<TipSetPoint> set_point;
    Input<BodyModel> model;
    Output<FlangeCommand> command;

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (!model.good() || !set_point.good()) return;
        const BodyModel body = model.get();
        const TipSetPoint tip = set_point.get();
        const FlangeTip tool = tip_of_tool(tip.tool_length);
        FlangeCommand next;
        next.frame = body.frame * tip.frame * inverse(tool);
        const Eigen::Matrix3d& turned = body.frame.rotation;
        const Eigen::Vector3d at_tip = turned * tip.frame.position;
        const Eigen::Vector3d to_flange = next.frame.position - body.frame.position - at_tip;
        next.twist.angular = body.twist.angular + turned * tip.twist.angular;
        next.twist.linear = body.twist.linear + body.twist.angular.cross(at_tip) + turned * tip.twist.linear +
                            next.twist.angular.cross(to_flange);
        command.write(next);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        FlangeCommand last = command.last();
        last.twist = {};
        command.write(last);
    }
    static constexpr auto interface() {
        return facets(input<&Superposition::set_point>("set_point", "", "of the tip in the body's frame"),
                      input<&Superposition::model>("model", "", "where the body is"),
                      output<&Superposition::command>("command", "", "of the flange, and its twist"));
    }
};

} // namespace two_robots
