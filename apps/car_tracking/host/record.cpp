// Samples machine and room, and digests the samples.
#include "apps/car_tracking/host/record.hpp"

#include "apps/car_tracking/image_recognition.hpp"
#include "toolchain/machine/host_hooks.hpp"

#include <bit>

namespace tappet::car_tracking {

void Record::look(MachineInstance& machine, const Scene& scene, Time time) {
    const Truth truth = scene.truth();
    Moment now{to_seconds(time.time_since_epoch()), truth.car.x, truth.car.y, truth.car_hidden};
    if (const auto floor = meet_height(room::eye(), axes_at(truth.aim).col(2), 0.0)) {
        now.looks_x = floor->x();
        now.looks_y = floor->y();
    }
    now.state = state_of(machine, "tracking");
    moments_.push_back(now);

    auto& recognition = *machine.find<ImageRecognition>("recognition");
    if (recognition.images_processed.last() == images_seen_) return;
    images_seen_ = recognition.images_processed.last();
    const Sighting& seen = recognition.sighting.last();
    const Truth& then =
        scene.pictured(*PortAccess::data<Sighting>.places(&recognition.sighting, false).stamp);
    looks_.push_back(
        {now.at_s, seen.located, seen.whole, seen.x, seen.y, then.car.x, then.car.y, then.car_hidden});
}

void Record::add_to(Digest& digest) const {
    const auto add = [&digest](double value) { digest.add(std::bit_cast<std::uint64_t>(value)); };
    for (const Moment& each : moments_)
        for (const double value : {each.car_x, each.car_y, each.looks_x, each.looks_y}) add(value);
    for (const Look& each : looks_)
        for (const double value : {each.at_s, each.x, each.y, each.located ? 1.0 : 0.0}) add(value);
}

} // namespace tappet::car_tracking
