// The main drive: enables the CiA 402 velocity drive, runs and halts the loom.
#pragma once

#include "apps/carpet_loom/drive_axis.hpp"
#include "apps/carpet_loom/wires.hpp"
#include "kernel/component/component.hpp"
#include "kernel/pieces/changed.hpp"

namespace tappet::carpet {

namespace wires = loom::wires;

/// All real-time, each cycle of a periodic activity.
struct MainDrive {
    Input<std::int64_t> statusword;
    Input<double> velocity;
    Output<std::int64_t> controlword;
    Output<double> target;
    Output<bool> enabled;
    Output<bool> at_speed;
    Output<bool> fault;
    Output<bool> slips;
    Property<double> speed_rpm{wires::nominal::speed_rpm};
    Property<double> at_speed_within_rpm{12.0};
    Property<Duration> brake_release{15ms};
    Property<Duration> slip_for{100ms};

    void enable() noexcept TAPPET_REALTIME { axis_.enable(); }
    void disable() noexcept TAPPET_REALTIME {
        running_ = false;
        axis_.disable();
    }
    void quick_stop() noexcept TAPPET_REALTIME {
        running_ = false;
        axis_.quick_stop();
    }
    void run() noexcept TAPPET_REALTIME { running_ = start_asked_ = true; }
    void halt() noexcept TAPPET_REALTIME { running_ = false; }

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        running_ = start_asked_ = false;
        axis_.start(controlword, target);
        slips_.write(slips, false);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (start_asked_) {
            start_asked_ = false;
            run_from_ = cycle.now +
                        brake_release.get(); // a motor that runs against the holding brake would be blocked
        }
        const bool runs = running_ && cycle.now >= run_from_;
        static_cast<void>(axis_.lead(statusword, controlword, enabled, fault));
        target.write(runs ? speed_rpm.get() : 0.0);
        const double off = velocity.get() - speed_rpm.get();
        const bool reached = runs && off < at_speed_within_rpm.get() && -off < at_speed_within_rpm.get();
        watch_speed(cycle.now, reached);
        at_speed_.write(at_speed, reached);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        axis_.stop(controlword, target, enabled, fault);
        at_speed_.write(at_speed, false);
    }

    static constexpr auto interface() {
        return facets(
            input<&MainDrive::statusword>("statusword", "", "CiA 402 statusword of the drive"),
            input<&MainDrive::velocity>("velocity", "rpm", "actual velocity of the drive"),
            output<&MainDrive::controlword>("controlword", "", "CiA 402 controlword for the drive"),
            output<&MainDrive::target>("target", "rpm", "target velocity for the drive"),
            output<&MainDrive::enabled>("enabled", "", "operation enabled; written on change"),
            output<&MainDrive::at_speed>("at_speed", "", "runs at its speed; written on change"),
            output<&MainDrive::fault>("fault", "", "the drive is faulty or silent; written on change"),
            output<&MainDrive::slips>("slips", "",
                                      "the drive lost its speed while it had to keep it; written on change"),
            property<&MainDrive::speed_rpm>("speed_rpm", "rpm", "weaving speed", range(30, 700)),
            property<&MainDrive::at_speed_within_rpm>("at_speed_within_rpm", "rpm",
                                                      "at speed within this deviation", range(1, 100)),
            property<&MainDrive::brake_release>(
                "brake_release", "s", "time that the brake holds after its line fell", range(0, 0.5)),
            property<&MainDrive::slip_for>("slip_for", "s", "how long it may be off its speed", range(0, 10)),
            operation<&MainDrive::enable>("enable", "leads the drive to operation enabled; resets one fault",
                                          required),
            operation<&MainDrive::disable>("disable", "disables the drive's voltage", required),
            operation<&MainDrive::quick_stop>("quick_stop", "brakes with the drive's quick stop", required),
            operation<&MainDrive::run>("run", "turns at the weaving speed", required),
            operation<&MainDrive::halt>("halt", "target velocity zero", required));
    }

private:
    /// Detects a gripping brake or a load too heavy. Ignores a run-up, or a change of speed.
    void watch_speed(Time now, bool reached) noexcept TAPPET_REALTIME {
        if (reached) kept_rpm_ = speed_rpm.get();
        const bool keeps = running_ && kept_rpm_ == speed_rpm.get();
        if (!keeps) kept_rpm_ = 0.0;
        if (reached || !keeps) kept_at_ = now;
        slips_.write(slips, now - kept_at_ > slip_for.get());
    }

    DriveAxis axis_{};
    bool running_ = false;
    bool start_asked_ = false;
    Time run_from_{};
    double kept_rpm_ = 0.0; // speed reached since it runs; 0: not yet
    Time kept_at_{};
    Changed<bool> at_speed_, slips_;
};

} // namespace tappet::carpet
