// The interface of a steerable camera to its component: a head with two motors and encoders, and a sensor.
// The simulated scene implements it.
#pragma once

#include "apps/car_tracking/image.hpp"
#include "kernel/base/time.hpp"

namespace tappet::car_tracking {

/// One axis of the head. Counts start at any value at power-on; passing the index mark stores its count.
struct AxisReading {
    static constexpr double counts_per_degree = 200.0;
    std::int64_t counts = 0;
    bool is_index_seen = false; ///< since power-on
    std::int64_t index_counts = 0;
};

struct HeadReading {
    AxisReading pan{};
    AxisReading tilt{};
};

/// The angles at which the index marks are mounted, in degrees.
inline constexpr Aim index_marks{0.0, -30.0};

/// All real-time, from one activity.
class CameraDevice {
public:
    virtual ~CameraDevice() = default;
    /// Switches the camera on or off. Off: the motors hold, and no image is taken.
    virtual void switch_on(bool on) noexcept TAPPET_REALTIME = 0;
    /// Sets the speeds in deg/s, valid until the next call. The motors need time to reach them.
    virtual void turn(double pan, double tilt) noexcept TAPPET_REALTIME = 0;
    [[nodiscard]] virtual HeadReading head() const noexcept TAPPET_REALTIME = 0;
    /// Starts the exposure at once; returns false while an image is being taken, or when off.
    [[nodiscard]] virtual bool expose(Duration exposure) noexcept TAPPET_REALTIME = 0;
    /// Copies the pixels of the exposed image, once; returns false until it was read out. `taken`: the middle
    /// of its exposure.
    [[nodiscard]] virtual bool take(Image& into, Time& taken) noexcept TAPPET_REALTIME = 0;

protected:
    CameraDevice() = default;
    CameraDevice(const CameraDevice&) = default;
    CameraDevice& operator=(const CameraDevice&) = default;
};

} // namespace tappet::car_tracking
