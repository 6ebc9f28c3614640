// The measuring wheel: one length of web is one turn of an imagined shaft, and the knife a cam of it that is
// fired its dead time before the length is reached.
#pragma once

#include "apps/cut_to_length/maps.hpp"
#include "drivers/instruments/encoder.hpp"
#include "kernel/cam/estimator.hpp"
#include "kernel/cam/schedule.hpp"
#include "kernel/component/component.hpp"

namespace cut_to_length {

inline constexpr Duration knife_dead_time = 15ms; // from its line's edge to the blade in the web

inline constexpr auto cams = cam_table(600_rpm, cam("cut", at(0_deg), dead_time(knife_dead_time)));
static_assert(check(cams.view()).empty(), "the cam table is refused: check(cams.view()) is the sentence");

/// Real-time, in an activity that each sample of the wheel wakes, and its silence.
struct Measuring {
    Input<std::int64_t> position;
    Input<bool> knife_allowed;
    Output<std::int64_t> cuts;
    Event<> cut_now, knife_turned, wheel_lost;
    Timer cam_timer, knife_timer;
    Property<double> length_mm{500.0};

    Sentence configure(Setup&) {
        codes_ = static_cast<std::int64_t>(length_mm.get() * codes_per_mm + 0.5);
        const ShaftProperties wheel{.codes_per_turn = static_cast<std::uint32_t>(codes_)};
        estimator_ = ShaftEstimator{wheel};
        return check(wheel);
    }
    /// A length that was begun before is not known any more: the first piece is scrap.
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        wheel_.lose();
        cuts.write(0);
        knife_turned.emit();
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { knife_turned.emit(); }

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        std::int64_t code = 0;
        const Flow flow = position.read(code);
        if (flow == Flow::stale && wheel_.is_known()) {
            wheel_.lose();
            cam_timer.cancel();
            wheel_lost.emit();
        }
        if (flow != Flow::fresh) return;
        const bool begins = !wheel_.is_known(); // after a gap the length does, and the estimator
        const std::int64_t way = wheel_.take(code);
        if (begins) begun_at_ = way;
        estimator_.sample(static_cast<std::uint32_t>(((way - begun_at_) % codes_ + codes_) % codes_),
                          position.stamp());
        schedule_.update(estimator_, cycle.now);
        cam_timer.arm(schedule_.next_due());
    }
    void fire(const Cycle& cycle) noexcept TAPPET_REALTIME {
        schedule_.advance(cycle.now, [this, &cycle](const CamEvent&) noexcept TAPPET_REALTIME {
            if (!knife_allowed.get()) return; // the web is moved by hand
            cut_now.emit();
            cuts.write(cuts.last() + 1);
            knife_timer.arm(cycle.now + 2 * knife_dead_time);
        });
        cam_timer.arm(schedule_.next_due());
    }
    void release(const Cycle&) noexcept TAPPET_REALTIME { knife_turned.emit(); }
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        if (codes_ == 0 || !proposal.changes(length_mm)) return {};
        return Sentence{"the length is taken over at a start; write it into the table"};
    }

    static constexpr auto interface() {
        return facets(
            input<&Measuring::position>("position", "", "of the wheel, in codes"),
            input<&Measuring::knife_allowed>("knife_allowed", "", "the line moves the web itself"),
            output<&Measuring::cuts>("cuts", "", "since start"),
            event<&Measuring::cut_now>("cut_now", "drive the knife now to cut at the length", heard_by(1)),
            event<&Measuring::knife_turned>("knife_turned", "the knife has cut and may rest", heard_by(1)),
            event<&Measuring::wheel_lost>("wheel_lost", "nobody knows where the web is"),
            timer<&Measuring::cam_timer, &Measuring::fire>("cam_timer", "the next cut"),
            timer<&Measuring::knife_timer, &Measuring::release>("knife_timer", "the end of the knife's turn"),
            property<&Measuring::length_mm>("length_mm", "mm", "from cut to cut", range(100, 2000)));
    }

private:
    ShaftEstimator estimator_{ShaftProperties{}};
    CamSchedule<cams.size()> schedule_{cams};
    instruments::EncoderCounts<wheel_bits> wheel_;
    std::int64_t codes_ = 0, begun_at_ = 0;
};

} // namespace cut_to_length
