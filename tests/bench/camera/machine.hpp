// A machine that only looks: the bench's camera, and a component that judges its images.
#pragma once

#include "drivers/camera/sensor.hpp"
#include "kernel/machine/table/machine.hpp"

#include <algorithm>

namespace tappet::camera_bench {

/// Judges each image as it comes.
struct Viewer {
    static constexpr std::size_t columns = 320, rows = 180;
    Input<camera::Image<columns, rows>> image;
    Input<std::int64_t> lost, flawed;
    Input<bool> faulted;

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (faulted.get() != was_faulted) {
            was_faulted = faulted.get();
            ++(was_faulted ? faults : recoveries);
        }
        if (image.read(seen_) != Flow::fresh) return;
        const Time stamp = image.stamp();
        if (++images > 3) { // the first ones of a stream may come closer together
            closest = std::min(closest, stamp - last_);
            farthest = std::max(farthest, stamp - last_);
        }
        oldest = std::max(oldest, cycle.now - stamp);
        last_ = stamp;
        for (const camera::Colour& each : seen_.pixels)
            brightest = std::max({brightest, each.red, each.green, each.blue});
    }

    static constexpr auto interface() {
        return facets(input<&Viewer::image>("image", "", "of the camera"),
                      input<&Viewer::lost>("lost", "", "frames that did not come"),
                      input<&Viewer::flawed>("flawed", "", "frames that were no good"),
                      input<&Viewer::faulted>("faulted", "", "nothing comes"));
    }

    // For the end's report.
    bool was_faulted = false;
    int faults = 0, recoveries = 0, images = 0;
    Duration closest = 1h, farthest{}, oldest{};
    std::uint8_t brightest = 0;

private:
    camera::Image<columns, rows> seen_{};
    Time last_{};
};

// clang-format off
inline constexpr auto table = machine("camera-bench",
    components(
        component<camera::Sensor<Viewer::columns, Viewer::rows>>("sensor", device("eye"), set("silent_after", 200ms)),
        component<Viewer>("viewer")),
    activities(
        activity("eye", on_device("sensor"), at_most(2, 40ms), runs("sensor", "viewer"), deadline(30ms), budget(10ms), stack(768 * 1024))),
    connections(
        data("sensor.image",         "viewer.image"),
        data("sensor.frames_lost",   "viewer.lost"),
        data("sensor.frames_flawed", "viewer.flawed"),
        data("sensor.faulted",       "viewer.faulted")),
    reactions(), behaviours());
// clang-format on

} // namespace tappet::camera_bench
