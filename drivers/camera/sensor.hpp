// A camera as a component: an output with its images, and what is known about those that did not come.
#pragma once

#include "drivers/camera/checked_frames.hpp"
#include "drivers/camera/pixels.hpp"
#include "kernel/component/cause.hpp"
#include "kernel/component/component.hpp"

#include <array>

namespace tappet::camera {

/// component<camera::Sensor<160, 120>>("eye", device("tracking-camera")), in an activity on_device("eye").
/// The machine states the size of its images, the board that of its camera; they must be equal. Real-time.
///
/// Each good frame is written with its time and reported by `arrived`. A frame that is lost, flawed, repeated
/// or late is counted and not written. `faulted` is true when the camera is gone, or while no good frame has
/// arrived for `silent_after`. Frames that come later end it; a camera that was unplugged needs a new start
/// of the machine.
template <std::size_t columns, std::size_t rows>
struct Sensor {
    static constexpr Size device_map{columns, rows};
    static constexpr const DeviceKind& device_kind = camera::device_kind;
    static constexpr bool woken_by_device = true;
    static constexpr Sentence size_text{columns, " x ", rows};
    static constexpr std::array<std::string_view, 1> size_as_part{size_text.view()};
    static constexpr std::span<const std::string_view> device_lines() { return size_as_part; }
    static constexpr std::size_t frames_per_cycle = 2;
    static constexpr Duration look_while_faulted = 50ms;

    Output<Image<columns, rows>> image{};
    Event<Time> arrived{};
    Output<std::int64_t> lost{}, flawed{}, repeated{}, late{};
    Output<bool> is_faulted{};
    Event<> fault{}, recovered{};
    Timer next_look{};
    Property<Duration> stamp_delay{0ms};
    Property<Duration> oldest{250ms};
    Property<Duration> silent_after{1s};

    Sentence configure(Setup& setup) {
        device_ = setup.device<Device>();
        waiter_ = setup.waiter;
        clock_ = setup.clock;
        return device_ == nullptr ? setup.no_device() : setup.woken_by(*device_);
    }

    /// Frames from before the start are dropped.
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        device_->begin_anew();
        before_ = device_->counters();
        seen_at_ = cycle.now;
        is_gone_ = faulted_ = false;
        for (Output<std::int64_t>* each : {&lost, &flawed, &repeated, &late}) each->write(0);
        is_faulted.write(false);
        waiter_->wake(); // for frames that arrive in between
    }

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        std::size_t n = 0;
        for (Taken taken = Taken::refused; n < frames_per_cycle; ++n) {
            Frame frame;
            const Time now = clock_->now();
            taken = device_->take(frame, now - oldest.get(), now);
            if (taken == Taken::nothing) break;
            is_gone_ = taken == Taken::failed;
            if (is_gone_) break;
            tell_losses();
            if (taken == Taken::frame) tell(frame);
        }
        if (n == frames_per_cycle) waiter_->wake();
        judge(clock_->now());
    }

    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        if (!faulted_) fault.emit(); // images without a driver cannot be relied on
    }
    [[nodiscard]] bool stopped_safely() const noexcept TAPPET_REALTIME { return true; } // nothing goes out

    [[nodiscard]] Counters counters() const noexcept { return device_->counters(); }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            output<&Sensor::image>("image", "", "the last good image, at the time of the device's stamp less `stamp_delay`"),
            event<&Sensor::arrived>("arrived", "an image was written, with that time"),
            output<&Sensor::lost>("frames_lost", "", "by their numbers, since start"),
            output<&Sensor::flawed>("frames_flawed", "", "marked by the camera, incomplete or with a time of the future, since start"),
            output<&Sensor::repeated>("frames_repeated", "", "with the number or the time of an earlier one, since start"),
            output<&Sensor::late>("frames_late", "", "older than `oldest`, since start"),
            output<&Sensor::is_faulted>("faulted", "", "the camera is gone or silent; written on change", while_stopped(true)),
            event<&Sensor::fault>("camera_fault", "no image can be relied on any longer"),
            event<&Sensor::recovered>("camera_recovered", "good frames arrive again"),
            timer<&Sensor::next_look, &Sensor::step>("next_look", "whether frames still arrive"),
            property<&Sensor::stamp_delay>("stamp_delay", "s", "from the time that an image shows to the device's stamp", range(0, 1)),
            property<&Sensor::oldest>("oldest", "s", "age from which a frame is late", range(0.001, 10)),
            property<&Sensor::silent_after>("silent_after", "s", "time without a good frame after which the camera is faulted", range(0.01, 60)));
    }
    // clang-format on

private:
    void tell(const Frame& frame) noexcept TAPPET_REALTIME {
        decode(frame, device_map, picture_.pixels);
        is_gone_ = !device_->give_back();
        seen_at_ = clock_->now();
        const CausedBy cause{frame.stamp};
        const Time taken = frame.stamp - stamp_delay.get();
        image.write(picture_, taken);
        arrived.emit(taken);
    }
    void tell_losses() noexcept TAPPET_REALTIME {
        const Counters now = device_->counters();
        const auto tell_one = [](Output<std::int64_t>& output, std::uint64_t count) noexcept TAPPET_REALTIME {
            if (const auto since = static_cast<std::int64_t>(count); since != output.last())
                output.write(since);
        };
        tell_one(lost, now.lost - before_.lost);
        tell_one(flawed, now.flawed - before_.flawed);
        tell_one(repeated, now.repeated - before_.repeated);
        tell_one(late, now.late - before_.late);
    }
    void judge(Time now) noexcept TAPPET_REALTIME {
        const bool bad = is_gone_ || now - seen_at_ >= silent_after.get();
        next_look.arm(bad ? now + look_while_faulted : seen_at_ + silent_after.get());
        if (bad == faulted_) return;
        faulted_ = bad;
        is_faulted.write(bad);
        (bad ? fault : recovered).emit();
    }

    Device* device_ = nullptr;
    os::Waiter* waiter_ = nullptr;
    os::Clock* clock_ = nullptr;
    Image<columns, rows> picture_{};
    Counters before_{}; // at the start
    Time seen_at_{};    // when the last good frame was taken
    bool is_gone_ = false;
    bool faulted_ = false;
};

} // namespace tappet::camera
