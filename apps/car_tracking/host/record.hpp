// The true and the believed values of a run.
#pragma once

#include "apps/car_tracking/scene/scene.hpp"
#include "kernel/base/digest.hpp"
#include "kernel/machine/instance/instance.hpp"

#include <cmath>
#include <string_view>
#include <vector>

namespace tappet::car_tracking {

/// One sample of the run.
struct Moment {
    double at_s = 0.0;
    double car_x = 0.0, car_y = 0.0; ///< true
    bool car_hidden = false;
    double looks_x = 0.0, looks_y = 0.0; ///< true point where the camera's axis meets the floor
    std::string_view state{};            ///< outermost state of the tracking component
};

/// One processed image.
struct Look {
    double at_s = 0.0; ///< when it was taken
    bool located = false;
    bool whole = false; ///< the whole car was inside the image
    double x = 0.0, y = 0.0;
    double car_x = 0.0, car_y = 0.0; ///< true position at that time
    bool car_hidden = false;
    [[nodiscard]] double error_m() const { return std::hypot(x - car_x, y - car_y); }
};

class Record {
public:
    void look(MachineInstance& machine, const Scene& scene, Time now);

    [[nodiscard]] const std::vector<Moment>& moments() const { return moments_; }
    [[nodiscard]] const std::vector<Look>& looks() const { return looks_; }
    void add_to(Digest& digest) const;

    static constexpr Duration every = 10ms;

private:
    std::vector<Moment> moments_{};
    std::vector<Look> looks_{};
    std::int64_t images_seen_ = 0;
};

} // namespace tappet::car_tracking
