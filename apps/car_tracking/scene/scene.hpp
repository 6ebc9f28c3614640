// Simulates the other end of the camera's wires: head, sensor, and the room with the car, in virtual time.
#pragma once

#include "apps/car_tracking/camera_device.hpp"
#include "apps/car_tracking/scene/renderer.hpp"

namespace tappet::car_tracking {

/// The true values, which the machine cannot see.
struct Truth {
    Aim aim{};
    CarPose car{};
    bool car_hidden = false;
};

/// The same seed gives the same scene, bit for bit. The machine uses CameraDevice only.
class Scene final : public CameraDevice {
public:
    explicit Scene(std::uint64_t seed);

    // For the machine.
    void switch_on(bool on) noexcept TAPPET_REALTIME override;
    void turn(double pan, double tilt) noexcept TAPPET_REALTIME override;
    [[nodiscard]] HeadReading head() const noexcept TAPPET_REALTIME override;
    [[nodiscard]] bool expose(Duration exposure) noexcept TAPPET_REALTIME override;
    [[nodiscard]] bool take(Image& into, Time& taken) noexcept TAPPET_REALTIME override;

    // For the world, and for the code that compares the machine with the truth.
    /// Returns the next moment at which something moves.
    [[nodiscard]] Time next() const { return now_ + step; }
    void advance(Time now);
    [[nodiscard]] Truth truth() const { return {{pan_.angle, tilt_.angle}, car_.pose(), car_.hidden()}; }
    /// Returns the truth in the middle of the exposure of the last image.
    [[nodiscard]] const Truth& pictured() const { return pictured_; }
    [[nodiscard]] const Lens& lens() const { return lens_; }
    [[nodiscard]] const Car& car() const { return car_; }
    [[nodiscard]] std::uint64_t images() const { return images_; }

    static constexpr Duration step = 1ms;
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
        [[nodiscard]] std::int64_t counts_at(double at) const noexcept TAPPET_REALTIME;
        [[nodiscard]] AxisReading reading() const noexcept TAPPET_REALTIME;
    };
    enum class Sensor : std::uint8_t { idle, asked, exposing, reading_out, ready };

    void advance_sensor();

    Random random_;
    Random noise_;
    Car car_;
    Lens lens_{};
    Renderer renderer_;
    Axis pan_{}, tilt_{};
    bool is_on_ = false;
    Sensor sensor_ = Sensor::idle;
    Duration exposure_{};
    Time exposure_began_{};
    int moments_taken_ = 0;
    Image image_{};
    Truth pictured_{};
    std::uint64_t images_ = 0;
    Time now_{};
};

} // namespace tappet::car_tracking
