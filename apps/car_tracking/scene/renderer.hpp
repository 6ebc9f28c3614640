// Computes the sensor's image of the room: lens distortion, noise, and several superimposed moments of one
// exposure, which blur moving objects.
#pragma once

#include "apps/car_tracking/scene/car.hpp"

#include <vector>

namespace tappet::car_tracking {

class Renderer {
public:
    static constexpr int moments = 4; ///< of one exposure

    explicit Renderer(const Lens& lens);

    void begin() { sums_.assign(sums_.size(), {}); }
    /// Adds one moment; `moment` counts from 0.
    void add(int moment, const Aim& aim, const CarPose& car);
    /// Writes the image of all moments.
    void finish(Random& noise, Picture& into) const;

private:
    struct Flat {
        double x, y;
    };
    struct Sum {
        int red = 0, green = 0, blue = 0;
    };

    std::vector<Flat> rays_; // moments, rows, columns: each moment samples another part of its pixels
    std::vector<Sum> sums_;
};

} // namespace tappet::car_tracking
