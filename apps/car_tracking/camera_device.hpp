// A steerable camera as its component sees it: a head with two motors and encoders, and a sensor. Behind it
// stands the simulated scene.
#pragma once

#include "apps/car_tracking/image.hpp"
#include "kernel/base/time.hpp"

namespace tappet::car_tracking {

/// One axis of the head. Counts begin anywhere at power-on; passing the index mark stores the count there.
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
    /// Off: the motors hold, and no image is taken.
    virtual void switch_on(bool on) noexcept TAPPET_REALTIME = 0;
    /// Speeds in deg/s, until told anew; the motors need their time to reach them.
    virtual void turn(double pan, double tilt) noexcept TAPPET_REALTIME = 0;
    [[nodiscard]] virtual HeadReading head() const noexcept TAPPET_REALTIME = 0;
    /// Begins to expose at once; false while an image is being taken, or when it is off.
    [[nodiscard]] virtual bool expose(Duration exposure) noexcept TAPPET_REALTIME = 0;
    /// Copies the pixels of the image that was exposed, once; false before it was read out. `taken`: the
    /// middle of its exposure.
    [[nodiscard]] virtual bool take(Image& into, Time& taken) noexcept TAPPET_REALTIME = 0;

protected:
    CameraDevice() = default;
    CameraDevice(const CameraDevice&) = default;
    CameraDevice& operator=(const CameraDevice&) = default;
};

} // namespace tappet::car_tracking
