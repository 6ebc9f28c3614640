// Moves head and car in steps of a millisecond and exposes the sensor.
#include "apps/car_tracking/scene/scene.hpp"

#include <algorithm>

namespace tappet::car_tracking {

namespace {

constexpr double acceleration = 600.0; // deg/s^2, of the head's motors

/// Draws a lens whose parameters differ from the data sheet by some per cent.
Lens drawn_lens(Random& random) {
    const double side = random.one_in(2) ? 1.0 : -1.0;
    const double off = 0.03 + 0.03 * random.unit();
    const double bend = -0.10 - 0.06 * random.unit();
    return {150.0 * (1.0 + side * off), bend};
}

} // namespace

void Scene::Axis::advance(double seconds) {
    const double most = acceleration * seconds;
    speed += std::clamp(wanted_speed - speed, -most, most);
    const double before = angle;
    angle += speed * seconds;
    if (is_index_seen || (before - index) * (angle - index) > 0.0) return;
    is_index_seen = true;
    index_counts = counts_at(index);
}

std::int64_t Scene::Axis::counts_at(double at) const noexcept TAPPET_REALTIME {
    return static_cast<std::int64_t>(std::floor((at - origin) * AxisReading::counts_per_degree + 0.5));
}

AxisReading Scene::Axis::reading() const noexcept TAPPET_REALTIME {
    return {counts_at(angle), is_index_seen, index_counts};
}

Scene::Scene(std::uint64_t seed)
    : random_{seed},
      noise_{seed ^ 0x5eed5eed5eed5eedu},
      car_{random_},
      lens_{drawn_lens(random_)},
      renderer_{lens_} {
    pan_.index = index_marks.pan;
    tilt_.index = index_marks.tilt;
    pan_.angle = index_marks.pan + 16.0 * random_.unit() - 8.0;
    tilt_.angle = index_marks.tilt + 16.0 * random_.unit() - 8.0;
    pan_.origin = 100.0 * random_.unit() - 50.0;
    tilt_.origin = 100.0 * random_.unit() - 50.0;
}

void Scene::switch_on(bool on) noexcept TAPPET_REALTIME {
    is_on_ = on;
    if (!on) sensor_ = Sensor::idle;
}

void Scene::turn(double pan, double tilt) noexcept TAPPET_REALTIME {
    pan_.wanted_speed = pan;
    tilt_.wanted_speed = tilt;
}

HeadReading Scene::head() const noexcept TAPPET_REALTIME { return {pan_.reading(), tilt_.reading()}; }

bool Scene::expose(Duration exposure) noexcept TAPPET_REALTIME {
    if (!is_on_ || sensor_ == Sensor::asked || sensor_ == Sensor::exposing || sensor_ == Sensor::reading_out)
        return false;
    sensor_ = Sensor::asked;
    exposure_ = exposure;
    return true;
}

bool Scene::take(Image& into, Time& taken) noexcept TAPPET_REALTIME {
    if (sensor_ != Sensor::ready) return false;
    into = image_;
    taken = exposure_began_ + exposure_ / 2;
    sensor_ = Sensor::idle;
    return true;
}

void Scene::advance(Time now) {
    constexpr double seconds = 1e-9 * static_cast<double>(step.count());
    while (now_ + step <= now) {
        now_ += step;
        for (Axis* axis : {&pan_, &tilt_}) {
            if (!is_on_) axis->wanted_speed = 0.0;
            axis->advance(seconds);
        }
        car_.advance(seconds);
        advance_sensor();
    }
}

void Scene::advance_sensor() {
    if (sensor_ == Sensor::asked) {
        sensor_ = Sensor::exposing;
        exposure_began_ = now_;
        moments_taken_ = 0;
        renderer_.begin();
    }
    if (sensor_ == Sensor::exposing) {
        // One moment in the middle of each quarter of the exposure.
        if (now_ - exposure_began_ >= (2 * moments_taken_ + 1) * exposure_ / (2 * Renderer::moments)) {
            if (moments_taken_ == Renderer::moments / 2) pictured_ = truth();
            renderer_.add(moments_taken_++, {pan_.angle, tilt_.angle}, car_.pose());
        }
        if (moments_taken_ == Renderer::moments) sensor_ = Sensor::reading_out;
    } else if (sensor_ == Sensor::reading_out && now_ - exposure_began_ >= exposure_ + readout) {
        renderer_.finish(noise_, image_);
        ++images_;
        sensor_ = Sensor::ready;
    }
}

} // namespace tappet::car_tracking
