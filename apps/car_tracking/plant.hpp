// The simulated room behind the wires of the camera and its head, and the record of a run in it.
#pragma once

#include "apps/car_tracking/host/record.hpp"
#include "apps/car_tracking/maps.hpp"
#include "drivers/camera/far_end.hpp"
#include "drivers/can/far_end.hpp"
#include "drivers/plant/plant.hpp"

#include <string>

namespace tappet::car_tracking {

class Plant final : public tappet::Plant {
public:
    explicit Plant(std::uint64_t seed) : scene{seed} {
        head.send_every("pan", head_period);
        head.send_every("tilt", head_period);
    }

    Time move(Time now) override {
        scene.drive(head.integer("drives.on") != 0, head.get("drives.pan_speed"),
                    head.get("drives.tilt_speed"));
        scene.advance(now);
        const AxisReading pan = scene.pan();
        head.set("pan.counts", static_cast<double>(pan.counts));
        head.set("pan.index", static_cast<double>(pan.index_counts));
        head.set("pan.index_seen", pan.is_index_seen ? 1.0 : 0.0);
        const AxisReading tilt = scene.tilt();
        head.set("tilt.counts", static_cast<double>(tilt.counts));
        head.set("tilt.index", static_cast<double>(tilt.index_counts));
        head.set("tilt.index_seen", tilt.is_index_seen ? 1.0 : 0.0);
        if (const Picture* image = scene.new_image()) camera.show(image->pixels, now);
        return scene.next();
    }
    [[nodiscard]] Duration usual_time() const override { return 60s; }
    [[nodiscard]] std::string_view usage() const override {
        return "  --picture FILE      draws the run as SVG: tracks, states, images, errors\n";
    }
    bool take_option(std::string_view option, std::string_view value, Sentence&) override {
        if (option == "--picture") picture = value;
        return option == "--picture";
    }
    [[nodiscard]] std::uint64_t digest() const override {
        Digest digest;
        record.add_to(digest);
        return digest.value();
    }
    void report(JsonText& json) const override {
        std::int64_t located = 0;
        double worst = 0.0;
        for (const Look& look : record.looks()) {
            located += look.located ? 1 : 0;
            if (look.located) worst = std::max(worst, look.error_m());
        }
        json.field("images", static_cast<std::int64_t>(record.looks().size()));
        json.field("located", located).field("worst_error_mm", worst * 1000.0);
    }

    Scene scene;
    Record record{};
    std::string picture{}; ///< the file to write; empty: no picture

private:
    can::FarEnd<head_signals> head{ends, "tracking-head"};
    camera::FarEnd camera{ends, "tracking-camera"};
};

} // namespace tappet::car_tracking
