// The measuring wheel: one length of web is one turn of an imagined shaft, and the knife a cam of it that is
// fired its dead time before the length is reached.
#pragma once

#include "apps/cut_to_length/maps.hpp"
#include "kernel/cam/estimator.hpp"
#include "kernel/cam/schedule.hpp"
#include "kernel/component/component.hpp"

namespace cut_to_length {

inline constexpr Duration knife_dead_time = 15ms; // from its line's edge to the blade in the web

inline constexpr auto cams = cam_table(600_rpm, cam("cut", at(0_deg), dead_time(knife_dead_time)));
static_assert(check(cams.view()).empty(), "the cam table is refused: check(cams.view()) is the sentence");

/// Real-time, in an activity that each sample of the wheel wakes.
struct Measuring {
    Input<std::int64_t> position;
    Output<std::int64_t> cuts;
    Event<> cut_now, knife_turned;
    Timer cam_timer, knife_timer;
    Property<double> length_mm{500.0};

    Sentence configure(Setup&) {
        ShaftProperties wheel;
        codes_ = static_cast<std::int64_t>(length_mm.get() * codes_per_mm + 0.5);
        wheel.codes_per_turn = static_cast<std::uint32_t>(codes_);
        estimator_ = ShaftEstimator{wheel};
        return check(wheel);
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME { cuts.write(0); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        std::int64_t code = 0;
        if (position.read(code) == Flow::fresh) {
            // The wheel counts in 16 bits, whatever the length is.
            travelled_ += static_cast<std::int16_t>(code - (travelled_ + offset_));
            if (!known_) offset_ = code - travelled_;
            known_ = true;
            const std::int64_t of_length = (travelled_ % codes_ + codes_) % codes_;
            estimator_.sample(static_cast<std::uint32_t>(of_length), position.stamp());
        }
        schedule_.update(estimator_, cycle.now);
        cam_timer.arm(schedule_.next_due());
    }
    void fire(const Cycle& cycle) noexcept TAPPET_REALTIME {
        schedule_.advance(cycle.now, [this, &cycle](const CamEvent&) noexcept TAPPET_REALTIME {
            cut_now.emit();
            cuts.write(cuts.last() + 1);
            knife_timer.arm(cycle.now + 2 * knife_dead_time);
        });
        cam_timer.arm(schedule_.next_due());
    }
    void release(const Cycle&) noexcept TAPPET_REALTIME { knife_turned.emit(); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { known_ = false; }

    static constexpr auto interface() {
        return facets(
            input<&Measuring::position>("position", "", "of the wheel, in codes"),
            output<&Measuring::cuts>("cuts", "", "since start"),
            event<&Measuring::cut_now>("cut_now", "the knife must be driven now to cut at the length",
                                       heard_by(1)),
            event<&Measuring::knife_turned>("knife_turned", "the knife has cut and may rest", heard_by(1)),
            timer<&Measuring::cam_timer, &Measuring::fire>("cam_timer", "the next cut"),
            timer<&Measuring::knife_timer, &Measuring::release>("knife_timer", "the end of the knife's turn"),
            property<&Measuring::length_mm>("length_mm", "mm", "from cut to cut", range(100, 2000)));
    }

private:
    ShaftEstimator estimator_{ShaftProperties{}};
    CamSchedule<cams.size()> schedule_{cams};
    std::int64_t codes_ = 0, travelled_ = 0, offset_ = 0;
    bool known_ = false;
};

} // namespace cut_to_length
