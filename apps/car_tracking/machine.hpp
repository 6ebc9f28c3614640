// The car tracker on one page (thesis 1.4, 5.4): a steerable camera, the recognition of a car in its images,
// and the component that tracks the car.
#pragma once

#include "apps/car_tracking/behaviour.hpp"
#include "apps/car_tracking/maps.hpp"
#include "drivers/camera/sensor.hpp"
#include "drivers/can/restarter.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/tasks/behaviour_task.hpp"

namespace tappet::car_tracking {

// clang-format off
inline constexpr auto table = machine("car-tracking",
    components(
        component<camera::Sensor<image_columns, image_rows>>("sensor", device("tracking-camera"), set("stamp_delay", 16ms)),
        component<can::Bus<head_signals>>("head", device("tracking-head")),
        component<Camera>("camera"),                 // takes images and aims
        component<ImageRecognition>("recognition"),  // locates the car in the room
        component<Tracking>("tracking"),             // aims the camera at it
        component<BehaviourTask<tracking_script, "application">>("application", controls("tracking"), set("patience", 3)),
        component<Panel>("panel"),                   // the buttons
        component<can::Restarter>("restarter", device("tracking-head"))),
    activities(
        activity("head",     on_device("head"),   at_most(4, 5ms),   runs("head"),   deadline(2ms), budget(30us)),
        activity("sensor",   on_device("sensor"), at_most(2, 100ms),  runs("sensor"), deadline(10ms), budget(1ms), stack(256 * 1024)),
        activity("camera",   every(5ms),  runs("camera"),      budget(500us), stack(256 * 1024)),
        activity("vision",   every(10ms), runs("recognition"), budget(2ms), stack(256 * 1024)),
        activity("tracking", every(10ms), runs("tracking", "application"), budget(50us)),
        activity("panel",    every(50ms), runs("panel"),       not_real_time),
        activity("restarter", every(100ms), runs("restarter"), not_real_time)),
    connections( // data flow
        data("sensor.image",         "camera.picture"),
        data("sensor.faulted",       "camera.sensor_faulted"),
        data("head.pan.counts",      "camera.pan_counts",      stale_after(50ms), hold), // then the camera gives up
        data("head.pan.index",       "camera.pan_index",       stale_after(50ms), hold),
        data("head.pan.index_seen",  "camera.pan_index_seen",  stale_after(50ms), hold),
        data("head.tilt.counts",     "camera.tilt_counts",     stale_after(50ms), hold),
        data("head.tilt.index",      "camera.tilt_index",      stale_after(50ms), hold),
        data("head.tilt.index_seen", "camera.tilt_index_seen", stale_after(50ms), hold),
        data("camera.drives_on",     "head.drives.on",         stale_after(50ms), substitute(0.0)),
        data("camera.pan_speed",     "head.drives.pan_speed",  stale_after(50ms), substitute(0.0)),
        data("camera.tilt_speed",    "head.drives.tilt_speed", stale_after(50ms), substitute(0.0)),
        data("head.faulted",         "restarter.faulted"),
        data("camera.image", "recognition.image"),
        data("camera.lens",  "recognition.lens")),
    reactions(), // tracking.osd handles the panel's buttons
    behaviours(
        behaviour("tracking", compiled<tracking_script>)));
// clang-format on

} // namespace tappet::car_tracking
