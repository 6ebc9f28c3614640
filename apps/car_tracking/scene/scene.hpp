// Simulates what stands at the camera's wires: head, sensor, and the room with the car.
#pragma once

#include "apps/car_tracking/head_axis.hpp"
#include "apps/car_tracking/scene/renderer.hpp"

namespace tappet::car_tracking {

/// The true values, which the machine cannot see.
struct Truth {
    Aim aim{};
    CarPose car{};
    bool car_hidden = false;
};

/// The same seed gives the same scene, bit for bit. The sensor exposes an image every `frame`, asked or not.
class Scene {
public:
    explicit Scene(std::uint64_t seed);

    // For the wires.
    /// Sets the speeds in deg/s; off, the motors hold. They need time to reach them.
    void drive(bool on, double pan, double tilt);
    [[nodiscard]] AxisReading pan() const { return pan_.reading(); }
    [[nodiscard]] AxisReading tilt() const { return tilt_.reading(); }
    /// Returns the image that was read out since the last call; null: none.
    [[nodiscard]] const Picture* new_image();

    // For the world, and for the code that compares the machine with the truth.
    /// Returns the next moment at which something moves.
    [[nodiscard]] Time next() const { return now_ + step; }
    void advance(Time now);
    [[nodiscard]] Truth truth() const { return {{pan_.angle, tilt_.angle}, car_.pose(), car_.hidden()}; }
    /// Returns the truth in the middle of the exposure of the image of that time, one of the last.
    [[nodiscard]] const Truth& pictured(Time taken) const;
    [[nodiscard]] bool is_on() const { return is_on_; }
    [[nodiscard]] const Lens& lens() const { return lens_; }
    [[nodiscard]] const Car& car() const { return car_; }
    [[nodiscard]] std::uint64_t images() const { return images_; }

    static constexpr Duration step = 1ms;
    static constexpr Duration frame = 100ms;
    static constexpr Duration exposure = 16ms;
    static constexpr Duration readout = 8ms;

private:
    struct Axis {
        double angle = 0.0;
        double speed = 0.0;
        double wanted_speed = 0.0;
        double origin = 0.0; // angle of count 0
        double index = 0.0;
        bool is_index_seen = false;
        std::int64_t index_counts = 0;
        void advance(double seconds);
        [[nodiscard]] std::int64_t counts_at(double at) const;
        [[nodiscard]] AxisReading reading() const;
    };
    struct Shot {
        Time taken{};
        Truth truth{};
    };

    void advance_sensor();

    Random random_;
    Random noise_;
    Car car_;
    Lens lens_{};
    Renderer renderer_;
    Axis pan_{}, tilt_{};
    bool is_on_ = false;
    int moments_taken_ = 0; // of the present exposure
    Picture image_{};
    bool is_new_ = false;
    std::array<Shot, 16> shots_{}; // the last ones
    std::uint64_t images_ = 0;
    Time now_{};
};

} // namespace tappet::car_tracking
