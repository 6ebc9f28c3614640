// The car tracker on one page (thesis 1.4, 5.4): a steerable camera, the recognition of a car in its images,
// and the component that tracks the car.
#pragma once

#include "apps/car_tracking/behaviour.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/tasks/behaviour_task.hpp"

namespace tappet::car_tracking {

// clang-format off
inline constexpr auto table = machine("car-tracking",
    components(
        component<Camera>("camera", device("tracking-camera")),
        component<ImageRecognition>("recognition"),  // locates the car in the room
        component<Tracking>("tracking"),             // aims the camera at it
        component<BehaviourTask<tracking_script, "application">>("application", controls("tracking"), set("patience", 3)),
        component<Panel>("panel")),                  // the buttons
    activities(
        activity("camera",   every(5ms),  runs("camera"),      budget(500us), stack(256 * 1024)),
        activity("vision",   every(10ms), runs("recognition"), budget(2ms), stack(256 * 1024)),
        activity("tracking", every(10ms), runs("tracking", "application"), budget(50us)),
        activity("panel",    every(50ms), runs("panel"),       not_real_time)),
    connections( // data flow
        data("camera.image", "recognition.image"),
        data("camera.lens",  "recognition.lens")),
    reactions(), // tracking.osd handles the panel's buttons
    behaviours(
        behaviour("tracking", compiled<tracking_script>)));
// clang-format on

} // namespace tappet::car_tracking
