// Restarts a faulted CAN bus: deliberately, after a pause, and only a limited number of times.
#pragma once

#include "drivers/can/device.hpp"
#include "kernel/component/component.hpp"

#include <cstdint>
#include <string_view>

namespace tappet::can {

/// Shares the Bus's device, in a background activity that is not_real_time, because a restart blocks. Connect
/// its input to the bus' `faulted`. Attempts count from its start and are never restored: a bus that fails
/// again and again needs service, and whoever starts it again is assumed to have checked it. The device's own
/// limit applies as well, from the machine's start.
struct Restarter {
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr bool shares_device = true;

    Property<std::int64_t> attempts{3};
    Property<Duration> pause{1s};
    Input<bool> faulted{};
    Output<std::int64_t> restarts{};
    Event<> gave_up{};

    Sentence configure(Setup& setup) {
        device_ = setup.device<Device>();
        return device_ == nullptr ? setup.no_device() : Sentence{};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        phase_ = Phase::watching;
        tried_ = done_ = 0;
        restarts.write(0);
    }

    void work(const Cycle& cycle) {
        if (!faulted.get()) {
            phase_ = Phase::watching;
            return;
        }
        if (phase_ == Phase::gave_up) return;
        if (phase_ == Phase::watching) {
            phase_ = Phase::pausing;
            next_attempt_ = cycle.now + pause.get();
            if (tried_ >= attempts.get()) return give_up();
        }
        if (cycle.now < next_attempt_) return;
        if (tried_ >= attempts.get()) return give_up();
        // Waits a pause for the result of the last attempt: by then the bus has taken it up, or it failed.
        next_attempt_ = cycle.now + pause.get();
        switch (device_->restart()) {
        case Restart::done:
            ++tried_;
            restarts.write(++done_);
            return;
        case Restart::failed: ++tried_; return;
        case Restart::not_needed: // the bus has not taken up the last one yet
            return;
        case Restart::exhausted: return give_up();
        }
    }

    static constexpr auto interface() {
        return facets(
            input<&Restarter::faulted>("faulted", "", "whether the bus is faulted, from its driver"),
            output<&Restarter::restarts>("restarts", "",
                                         "restarts that the controller accepted, since start"),
            event<&Restarter::gave_up>("gave_up", "the bus stays faulted: no more restarts"),
            property<&Restarter::attempts>("attempts", "", "restarts tried at most, since start",
                                           range(0, 1000)),
            property<&Restarter::pause>("pause", "s", "from a fault to a restart, and from one to the next",
                                        range(0.01, 3600)));
    }

private:
    enum class Phase : std::uint8_t { watching, pausing, gave_up };

    void give_up() noexcept TAPPET_REALTIME {
        phase_ = Phase::gave_up;
        gave_up.emit();
    }

    Device* device_ = nullptr;
    Phase phase_ = Phase::watching;
    Time next_attempt_{};
    std::int64_t tried_ = 0;
    std::int64_t done_ = 0;
};

} // namespace tappet::can
