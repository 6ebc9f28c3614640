// The simulated room behind the camera's wires, and the record of a run in it.
#pragma once

#include "apps/car_tracking/host/record.hpp"
#include "drivers/plant/plant.hpp"

#include <array>
#include <string>

namespace tappet::car_tracking {

/// In virtual time only: machine and room share the sensor without a lock.
class Plant final : public tappet::Plant {
public:
    explicit Plant(std::uint64_t seed) : scene{seed} {}

    Time move(Time now) override {
        scene.advance(now);
        return scene.next();
    }
    [[nodiscard]] std::span<const ProvidedDevice> devices() override { return devices_; }
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
    std::array<ProvidedDevice, 1> devices_{
        {{type_id<CameraDevice>, "tracking-camera", static_cast<CameraDevice*>(&scene)}}};
};

} // namespace tappet::car_tracking
