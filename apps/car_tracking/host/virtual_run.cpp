// Runs machine and room, looks at both, and digests what it saw.
#include "apps/car_tracking/host/virtual_run.hpp"

#include "apps/car_tracking/machine.hpp"
#include "board/host/board.hpp"
#include "kernel/base/digest.hpp"
#include "kernel/statechart/execution.hpp"

#include <bit>

namespace tappet::car_tracking {

AcceptedMachine on_host() { return Firmware<car_tracking, board::host>::machine(); }

VirtualRun::VirtualRun(std::uint64_t seed, const AcceptedMachine& machine)
    : scene_{seed},
      devices_{{{type_id<CameraDevice>, "tracking-camera", static_cast<CameraDevice*>(&scene_)}}},
      instance_{machine, clock_},
      world_{instance_} {}

std::expected<void, Sentence> VirtualRun::start() {
    if (auto configured = instance_.configure(devices_); !configured)
        return std::unexpected(configured.error());
    world_.add({&scene_, [](void* scene) { return static_cast<Scene*>(scene)->next(); },
                [](void* scene, Time now) { static_cast<Scene*>(scene)->advance(now); }});
    if (const Sentence refusal = world_.start(); !refusal.empty()) return std::unexpected(refusal);
    return {};
}

bool VirtualRun::run_for(Duration time) {
    for (const Time end = clock_.now() + time; clock_.now() < end; look())
        if (!world_.run_until(std::min(end, clock_.now() + look_every))) return false;
    return true;
}

void VirtualRun::stop() {
    world_.stop();
    look();
}

std::string_view VirtualRun::state() const {
    const auto path = instance_.state_machine_of("tracking")->path();
    return path.empty() ? std::string_view{} : path[0];
}

void VirtualRun::look() {
    const Truth truth = scene_.truth();
    Moment now{to_seconds(clock_.now().time_since_epoch()), truth.car.x, truth.car.y, truth.car_hidden};
    if (const auto floor = meet_height(room::eye(), axes_at(truth.aim).col(2), 0.0)) {
        now.looks_x = floor->x();
        now.looks_y = floor->y();
    }
    now.state = state();
    moments_.push_back(now);

    auto& recognition = *instance_.find<ImageRecognition>("recognition");
    if (recognition.images_processed.last() == images_seen_) return;
    images_seen_ = recognition.images_processed.last();
    const Sighting& seen = recognition.sighting.last();
    const Truth& then = scene_.pictured();
    looks_.push_back(
        {now.at_s, seen.located, seen.whole, seen.x, seen.y, then.car.x, then.car.y, then.car_hidden});
}

std::uint64_t VirtualRun::digest() const {
    Digest digest;
    digest.add(instance_.observation().event_log_digest());
    const auto add = [&digest](double value) { digest.add(std::bit_cast<std::uint64_t>(value)); };
    for (const Moment& each : moments_)
        for (const double value : {each.car_x, each.car_y, each.looks_x, each.looks_y}) add(value);
    for (const Look& each : looks_)
        for (const double value : {each.at_s, each.x, each.y, each.located ? 1.0 : 0.0}) add(value);
    return digest.value();
}

} // namespace tappet::car_tracking
