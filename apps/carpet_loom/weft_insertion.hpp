// The weft: releases it at its angle, watches for it in its window, and selects the pattern of each pick.
#pragma once

#include "apps/carpet_loom/weft_record.hpp"
#include "apps/carpet_loom/wires.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"

#include <array>

namespace tappet::carpet {

namespace wires = loom::wires;

/// All real-time. It runs in the shaft's activity, so that the angle events call it directly.
struct WeftInsertion {
    static constexpr bool slot_required = true; // the pattern's behaviour is loaded while the machine runs

    MethodCall<double(Time)> angle_at;
    Output<std::int64_t> pick;
    Output<std::int64_t> pattern;
    Output<std::int64_t> picks_woven;
    Output<double> arrival_deg;
    BufferOutput<Arrival> arrivals;
    Output<bool> working;
    Event<> open_valve, close_valve, missed;
    Event<> drive_cutter, rest_cutter;
    EventHandle detector;

    void allow() noexcept TAPPET_REALTIME { allowed_ = true; }
    /// Releases no weft in the coming turns; a weft in flight continues.
    void hold() noexcept TAPPET_REALTIME { allowed_ = ready_ = false; }
    /// Releases no weft from now on and closes an open valve.
    void lose_lines() noexcept TAPPET_REALTIME { inhibit(); }
    void inhibit() noexcept TAPPET_REALTIME {
        hold();
        close_valve.emit();
    }

    /// Sets the pattern of the coming picks in place of the carpet's, one bit for each harness of the dobby.
    /// Returns false for no harness, or for one that the dobby does not have.
    bool lift(std::int64_t harnesses) noexcept TAPPET_REALTIME {
        if (harnesses <= 0 || harnesses > all_harnesses) return false;
        lifted_ = harnesses;
        return true;
    }
    /// Returns to the carpet's patterns.
    void weave_carpet() noexcept TAPPET_REALTIME { lifted_ = 0; }

    void on_beat_up() noexcept TAPPET_REALTIME {
        if (arrived_) picks_woven.write(picks_woven.last() + 1);
        released_ = arrived_ = false;
        detector.disconnect(); // ignores pulses without a weft in flight
        ready_ = allowed_;     // only a turn that began with permission gets a weft
        cut(false);
    }
    void on_offer_pattern() noexcept TAPPET_REALTIME {
        const std::int64_t next = pick.last() + 1;
        pattern.write(lifted_ != 0 ? lifted_ : patterns[static_cast<std::size_t>(next) % patterns.size()]);
        pick.write(next);
    }
    void on_release_angle() noexcept TAPPET_REALTIME {
        if (!ready_ || released_) return;
        released_ = true;
        turning_ = true;
        detector.connect();
        open_valve.emit();
    }
    void on_close_angle() noexcept TAPPET_REALTIME {
        if (released_) close_valve.emit();
    }
    void on_window_opens() noexcept TAPPET_REALTIME { early_ = arrived_; }
    void on_window_closes() noexcept TAPPET_REALTIME {
        // A pulse before the window is no valid arrival: the weft flew too short, or the detector chatters.
        if (released_ && (!arrived_ || early_)) missed.emit();
    }
    void on_arrival(Time at) noexcept TAPPET_REALTIME {
        // A weft also counts while the shaft component is stopped and the angle is unknown.
        if (const auto angle_deg = angle_at(at); angle_deg.given()) {
            arrival_deg.write(angle_deg.value_or(0.0), at);
            // Ignores a second pulse of the same weft.
            if (!arrived_)
                static_cast<void>(arrivals.push({picks_woven.last() + 1, angle_deg.value_or(0.0)}));
        }
        arrived_ = true;
        if (turning_) cut(true);
    }
    /// Ends the cut: the shaft stands or is lost, and the beat-up that ends the cut may never come.
    void on_rest() noexcept TAPPET_REALTIME {
        turning_ = false;
        cut(false);
    }

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        pick.write(0);
        pattern.write(patterns[0]);
        picks_woven.write(0);
        working.write(true);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        working.write(false);
        if (allowed_) missed.emit(); // a loom that turns on without this component weaves nothing
        inhibit();
        on_rest();
        detector.disconnect();
        released_ = arrived_ = false;
    }

    static constexpr auto interface() {
        return facets(
            calls<&WeftInsertion::angle_at>("angle_at", "the main shaft's angle in degrees at a time"),
            output<&WeftInsertion::pick>("pick", "", "number of the pick whose pattern is offered"),
            output<&WeftInsertion::pattern>("pattern", "", "harnesses to lift, one bit each"),
            output<&WeftInsertion::picks_woven>("picks_woven", "", "picks whose weft arrived, since start"),
            output<&WeftInsertion::arrival_deg>("arrival_deg", "deg", "of the last weft"),
            output<&WeftInsertion::arrivals>("arrivals", "", "every weft that arrived, with its angle"),
            output<&WeftInsertion::working>("working", "", "wefts can be released and are judged"),
            event<&WeftInsertion::open_valve>("open_valve", "drive the weft's valve"),
            event<&WeftInsertion::close_valve>("close_valve", "let the weft's valve close", heard_by(1)),
            event<&WeftInsertion::drive_cutter>("drive_cutter", "the yarn cutter on"),
            event<&WeftInsertion::rest_cutter>("rest_cutter", "the yarn cutter off", heard_by(1)),
            event<&WeftInsertion::missed>("missed", "the weft of this pick did not arrive", heard_by(1)),
            handle<&WeftInsertion::detector>("detector", "of the detector, while a weft is on its way"),
            method<&WeftInsertion::lift>("lift", "the harnesses of the picks to come, one bit each"),
            method<&WeftInsertion::weave_carpet>("weave_carpet", "the carpet's patterns again"),
            operation<&WeftInsertion::allow>("allow", "wefts may be released", required),
            operation<&WeftInsertion::hold>("hold", "no weft in the turns to come", required),
            operation<&WeftInsertion::lose_lines>(
                "lose_lines", "like inhibit, because the lines' levels are unknown", required),
            operation<&WeftInsertion::inhibit>("inhibit", "no weft; the valve closes", required),
            operation<&WeftInsertion::on_beat_up>("on_beat_up", "a pick begins", required),
            operation<&WeftInsertion::on_offer_pattern>("on_offer_pattern", "offers the next pattern",
                                                        required),
            operation<&WeftInsertion::on_release_angle>("on_release_angle", "releases the weft", required),
            operation<&WeftInsertion::on_close_angle>("on_close_angle", "closes the valve", required),
            operation<&WeftInsertion::on_window_opens>("on_window_opens", "arrivals count from now on",
                                                       required),
            operation<&WeftInsertion::on_window_closes>("on_window_closes", "judges the pick", required),
            operation<&WeftInsertion::on_rest>("on_rest", "the shaft stands or is lost", required),
            operation<&WeftInsertion::on_arrival>("on_arrival", "the detector saw the weft at this time",
                                                  required));
    }

private:
    // Carpet, face to face: two harness pairs alternate, every fourth pick binds the pile.
    static constexpr std::array<std::int64_t, 4> patterns{0x5A5A, 0xA5A5, 0x5A5A, 0xF0F0};

    static constexpr std::int64_t all_harnesses = 0xffff;

    void cut(bool on) noexcept TAPPET_REALTIME {
        if (on == cuts_) return;
        cuts_ = on;
        if (on)
            drive_cutter.emit();
        else
            rest_cutter.emit();
    }

    std::int64_t lifted_ = 0; // set by a behaviour; 0: the carpet's
    bool allowed_ = false;
    bool ready_ = false;
    bool released_ = false;
    bool arrived_ = false;
    bool early_ = false;
    bool turning_ = false;
    bool cuts_ = false;
};

} // namespace tappet::carpet
