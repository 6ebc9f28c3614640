// The tracking component's behaviour: the script tracking.osd, compiled with the firmware against the
// components it names.
#pragma once

#include "apps/car_tracking/camera.hpp"
#include "apps/car_tracking/image_recognition.hpp"
#include "apps/car_tracking/panel.hpp"
#include "apps/car_tracking/tracking.hpp"
#include "apps/car_tracking/tracking.osd.hpp"
#include "kernel/script/compiled.hpp"

namespace tappet::car_tracking {

/// Each of these components runs in its own activity.
inline constexpr auto tracking_reach =
    script_reach(reachable<Tracking>("tracking"), reachable<Camera>("camera", false),
                 reachable<ImageRecognition>("recognition", false), reachable<Panel>("panel", false));

inline constexpr const ScriptUnit& tracking_script = compiled_script<scripts::tracking, tracking_reach>;

} // namespace tappet::car_tracking
