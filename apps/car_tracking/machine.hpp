// The car tracker on one page (thesis 1.4, 5.4): a steerable camera, the recognition of a car in its images,
// and the component that tracks it.
#pragma once

#include "apps/car_tracking/camera.hpp"
#include "apps/car_tracking/image_recognition.hpp"
#include "apps/car_tracking/panel.hpp"
#include "apps/car_tracking/tracking_cycle.hpp"
#include "kernel/machine/machine.hpp"

namespace tappet::car_tracking {

// clang-format off
inline constexpr auto car_tracking = machine("car-tracking",
    components(
        component<Camera>("camera", device("tracking-camera")),
        component<ImageRecognition>("recognition"),  // where in the room is the car
        component<Tracking>("tracking"),             // aims the camera at it
        component<Panel>("panel")),                  // the buttons
    activities(
        activity("camera",   every(5ms),  runs("camera"),      budget(500us), stack(256 * 1024)),
        activity("tracking", every(10ms), runs("tracking"),    budget(50us)),
        activity("vision",   every(10ms), runs("recognition"), budget(2ms), stack(256 * 1024)),
        activity("panel",    every(50ms), runs("panel"),       not_real_time)),
    connections( // data flow
        data("camera.image", "recognition.image"),
        data("camera.lens",  "recognition.lens")),
    reactions( // execution flow
        when("panel.move_camera",        tell("tracking.on_move_camera")),
        uses("tracking.start_camera",      "camera.start"),
        uses("tracking.stop_camera",       "camera.stop"),
        uses("tracking.calibrate",         "camera.calibrate"),
        uses("tracking.fetch_image",       "camera.fetch_image"),
        uses("tracking.move_camera",       "camera.move_camera"),
        uses("tracking.start_recognition", "recognition.start"),
        uses("tracking.stop_recognition",  "recognition.stop"),
        uses("tracking.process_image",     "recognition.process_image"),
        uses("tracking.get_position",      "camera.get_position"),
        uses("tracking.is_calibrated",     "camera.is_calibrated"),
        uses("tracking.car_located",       "recognition.car_located"),
        uses("tracking.car_location",      "recognition.car_location")),
    behaviours(
        behaviour("tracking", tracking_cycle)));
// clang-format on

} // namespace tappet::car_tracking
