// Moves head and car in steps of a millisecond and exposes the sensor.
#include "apps/car_tracking/scene/scene.hpp"

#include <algorithm>
#include <utility>

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

std::int64_t Scene::Axis::counts_at(double at) const {
    return static_cast<std::int64_t>(std::floor((at - origin) * AxisReading::counts_per_degree + 0.5));
}

AxisReading Scene::Axis::reading() const { return {counts_at(angle), is_index_seen, index_counts}; }

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

void Scene::drive(bool on, double pan, double tilt) {
    is_on_ = on;
    pan_.wanted_speed = on ? pan : 0.0;
    tilt_.wanted_speed = on ? tilt : 0.0;
}

const Picture* Scene::new_image() { return std::exchange(is_new_, false) ? &image_ : nullptr; }

const Truth& Scene::pictured(Time taken) const {
    return std::ranges::min_element(
               shots_, {}, [taken](const Shot& each) { return std::chrono::abs(each.taken - taken); })
        ->truth;
}

void Scene::advance(Time now) {
    constexpr double seconds = 1e-9 * static_cast<double>(step.count());
    while (now_ + step <= now) {
        now_ += step;
        for (Axis* axis : {&pan_, &tilt_}) axis->advance(seconds);
        car_.advance(seconds);
        advance_sensor();
    }
}

void Scene::advance_sensor() {
    const Duration into_frame = now_.time_since_epoch() % frame;
    if (into_frame == Duration::zero()) {
        moments_taken_ = 0;
        renderer_.begin();
    }
    // One moment in the middle of each quarter of the exposure.
    if (moments_taken_ < Renderer::moments &&
        into_frame >= (2 * moments_taken_ + 1) * exposure / (2 * Renderer::moments)) {
        if (moments_taken_ == Renderer::moments / 2)
            shots_[images_ % shots_.size()] = {now_ - into_frame + exposure / 2, truth()};
        renderer_.add(moments_taken_++, {pan_.angle, tilt_.angle}, car_.pose());
    }
    if (into_frame != exposure + readout) return;
    renderer_.finish(noise_, image_);
    ++images_;
    is_new_ = true;
}

} // namespace tappet::car_tracking
