// The car tracker and its room under virtual time, with a record of what was true and what was believed.
#pragma once

#include "apps/car_tracking/scene/scene.hpp"
#include "apps/car_tracking/sighting.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"

#include <string>
#include <vector>

namespace tappet::car_tracking {

/// One look at the run.
struct Moment {
    double at_s = 0.0;
    double car_x = 0.0, car_y = 0.0; ///< true
    bool car_hidden = false;
    double looks_x = 0.0, looks_y = 0.0; ///< where the camera's axis meets the floor, truly
    std::string_view state{};            ///< of the tracking component, its outermost one
};

/// One image that was processed.
struct Look {
    double at_s = 0.0; ///< when it was taken
    bool located = false;
    bool whole = false; ///< no part of the car lay outside the image
    double x = 0.0, y = 0.0;
    double car_x = 0.0, car_y = 0.0; ///< true then
    bool car_hidden = false;
    [[nodiscard]] double error_m() const { return std::hypot(x - car_x, y - car_y); }
};

/// The car tracker, accepted for the host's board.
AcceptedMachine on_host();

/// Everything of one run; lives as long as the run. One at a time: the machine's memory is static.
class VirtualRun {
public:
    /// `machine`: the car tracker, or one that differs in how its behaviour is executed.
    explicit VirtualRun(std::uint64_t seed, const AcceptedMachine& machine = on_host());

    std::expected<void, Sentence> start();
    /// Looks every `look_every`. False: the machine asked to stop.
    bool run_for(Duration time);
    void stop();

    [[nodiscard]] const std::vector<Moment>& moments() const { return moments_; }
    [[nodiscard]] const std::vector<Look>& looks() const { return looks_; }
    [[nodiscard]] std::string_view state() const;
    [[nodiscard]] Scene& scene() { return scene_; }
    [[nodiscard]] MachineInstance& instance() { return instance_; }
    [[nodiscard]] Time now() { return clock_.now(); }
    /// Of everything that happened, in machine and room.
    [[nodiscard]] std::uint64_t digest() const;

    static constexpr Duration look_every = 10ms;

private:
    void look();

    os::Clock clock_{os::Clock::Kind::virtual_time};
    Scene scene_;
    std::array<ProvidedDevice, 1> devices_;
    MachineInstance instance_;
    VirtualWorld world_;
    std::vector<Moment> moments_;
    std::vector<Look> looks_;
    std::int64_t images_seen_ = 0;
};

} // namespace tappet::car_tracking
