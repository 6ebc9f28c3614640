// One time for the nodes of a bus: one node sends its clock, the others know how far it is ahead of theirs,
// and with what error.
#pragma once

#include "drivers/can/clock_frames.hpp"
#include "drivers/can/device.hpp"
#include "kernel/base/clock_bounds.hpp"
#include "kernel/component/component.hpp"

namespace tappet::can {

/// Sends the machine's time to its bus. Rows of the table:
///     component<can::Bus<signals, can::clock_frames<row, can::Direction::transmit>>>("can", device("can")),
///     component<can::ClockTeller<row>>("clock", device("can")),
///     activity("can", on_device("can"), ..., runs("can", "clock"), ...)
/// Runs in the activity of its bus, after it, so that the FUP follows the confirmation of a SYNC at once.
/// Real-time.
///
/// The first SYNC comes one period after its start, when no receiver waits for a FUP of its last start any
/// more.
template <const auto& row> struct ClockTeller {
    TAPPET_ACCEPTED(clock_fault(row));
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr bool shares_device = true;

    Output<std::int64_t> told{}, given_up{};
    Timer next{};

    Sentence configure(Setup& setup) {
        device_ = setup.device<Device>();
        waiter_ = setup.waiter;
        if (device_ == nullptr) return setup.no_device();
        device_->wake_when_confirmed();
        return {};
    }
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        told.write(0);
        given_up.write(0);
        is_open_ = false;
        next_sync_ = cycle.now + row.every;
        next.arm(next_sync_);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (is_open_) follow_up(cycle.now);
        if (cycle.now >= next_sync_) synchronise(cycle.now);
        const State before = device_->state();
        device_->service(cycle.now);
        if (device_->state() != before) waiter_->wake(); // the bus reports it
        next.arm(std::min(next_sync_, device_->next_service()));
    }
    void fire(const Cycle& cycle) noexcept TAPPET_REALTIME { step(cycle); }

    static constexpr auto interface() {
        return facets(output<&ClockTeller::told>("told", "", "times that the clock was sent"),
                      output<&ClockTeller::given_up>(
                          "given_up", "", "SYNC frames that were confirmed too late for their follow-up"),
                      timer<&ClockTeller::next, &ClockTeller::fire>("next", "the next SYNC"));
    }

private:
    void synchronise(Time now) noexcept TAPPET_REALTIME {
        if (is_open_) give_up();
        next_sync_ += ((now - next_sync_) / row.every + 1) * row.every;
        sequence_ = static_cast<std::uint8_t>((sequence_ + 1U) & 15U);
        seconds_ = static_cast<std::uint32_t>(to_ns(now) / 1'000'000'000);
        sent_ = now;
        is_open_ = send({.kind = ClockFrame::Kind::sync, .sequence = sequence_, .number = seconds_}, now);
        if (!is_open_) give_up();
    }
    void follow_up(Time now) noexcept TAPPET_REALTIME {
        const Confirmation through = device_->last_confirmed(row.identifier);
        if (through.at == Time{} || through.made < sent_) return;
        is_open_ = false;
        const std::int64_t ns = to_ns(through.at) - std::int64_t{seconds_} * 1'000'000'000;
        const bool late = now - sent_ > follow_up_within(row) || ns < 0 || ns >= 4'000'000'000;
        if (late || !send({.kind = ClockFrame::Kind::follow_up,
                           .sequence = sequence_,
                           .number = static_cast<std::uint32_t>(ns % 1'000'000'000),
                           .seconds_more = static_cast<std::uint8_t>(ns / 1'000'000'000)},
                          now))
            return give_up();
        told.write(told.last() + 1);
    }
    bool send(const ClockFrame& content, Time now) noexcept TAPPET_REALTIME {
        Frame frame = encode(row, content);
        frame.stamp = now;
        return device_->send(frame, Keep::every) == Send::queued;
    }
    void give_up() noexcept TAPPET_REALTIME { given_up.write(given_up.last() + 1); }

    Device* device_ = nullptr;
    os::Waiter* waiter_ = nullptr;
    Time next_sync_{}, sent_{};
    std::uint32_t seconds_ = 0;
    std::uint8_t sequence_ = 0;
    bool is_open_ = false; ///< SYNC is not confirmed yet
};

/// Knows how far the sender's clock is ahead. In a periodic activity; rows of the table:
///     component<can::Bus<signals, can::clock_frames<row, can::Direction::receive>>>("can", device("can")),
///     component<can::ToldClock<row>>("clock"),
///     buffer<8>("can.services", "clock.received")
/// Real-time.
///
/// `error` is guaranteed if no stamp is later than stated and none is too early; stamps can be early by up to
/// 1 ms while a wall clock is set. It is half of both stamps' lateness, plus the possible drift of the clocks
/// since the last exchange, P at most in normal operation. Only the last exchange counts, because a restarted
/// sender has another clock, and a small jump of it shows nowhere else. Frames that are damaged, duplicated,
/// out of order or incomplete are not used. Between a restart and its first exchange, the output is still the
/// previous clock. `rate` is measured over one start of the sender and includes jumps too small to detect.
template <const auto& row> struct ToldClock {
    TAPPET_ACCEPTED(clock_fault(row));
    static constexpr int max_frames_per_cycle = 64;
    /// Largest step of the sequence that counts as losses; a larger one is out of order.
    static constexpr unsigned most_steps = 4;

    BufferInput<Frame> received{};
    Output<Duration> ahead{}, error{};
    Output<bool> is_known{};
    Output<double> rate{}, rate_error{};
    Output<std::int64_t> exchanges{}, discarded{}, invalid{}, jumps{};
    Property<Duration> teller_late{100us}, own_late{100us};
    Property<double> drift{210e-6};
    Property<Duration> silent_after{std::max<Duration>(1s, 5 * row.every)}, within{1s}, rate_over{10s};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        Frame forgotten;
        for (int n = 0; n < max_frames_per_cycle && received.pop(forgotten);) ++n;
        bounds_ = {};
        is_open_ = has_sequence_ = has_anchor_ = false;
        last_ = cycle.now;
        for (auto* const count : {&exchanges, &discarded, &invalid, &jumps}) count->write(0);
        is_known.write(false);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        Frame frame;
        for (int n = 0; n < max_frames_per_cycle && received.pop(frame); ++n) take(frame, cycle.now);
        bounds_.age(cycle.now, drift.get());
        const bool known =
            bounds_.known() && cycle.now - last_ <= silent_after.get() && bounds_.error() <= within.get();
        if (known != is_known.last()) is_known.write(known);
        if (!bounds_.known()) return;
        ahead.write(bounds_.ahead());
        error.write(bounds_.error());
    }

    static constexpr auto interface() {
        return facets(
            input<&ToldClock::received>("received", "", "frames of the bus"),
            output<&ToldClock::ahead>("ahead", "s",
                                      "how far the teller's clock is ahead of the own one, within the error"),
            output<&ToldClock::error>("error", "s",
                                      "the most by which `ahead` may be wrong; it grows between exchanges"),
            output<&ToldClock::is_known>(
                "known", "",
                "the clock was received recently, and its error is small enough; written on "
                "change",
                while_stopped(false)),
            output<&ToldClock::rate>("rate", "",
                                     "how much faster the teller's clock runs, s per s, averaged over the "
                                     "last time of at least `rate_over`"),
            output<&ToldClock::rate_error>("rate_error", "", "the most by which `rate` may be wrong"),
            output<&ToldClock::exchanges>("exchanges", "", "times that the clock was received"),
            output<&ToldClock::discarded>("discarded", "",
                                          "frames that came twice, out of order or without their other half"),
            output<&ToldClock::invalid>("invalid", "", "frames that are corrupt or unprotected"),
            output<&ToldClock::jumps>("jumps", "", "times that the teller's clock jumped"),
            property<&ToldClock::teller_late>(
                "teller_late", "s", "the longest from a frame's end to the teller's stamp", range(0.0, 0.1)),
            property<&ToldClock::own_late>(
                "own_late", "s", "the longest from a frame's end to its stamp here", range(0.0, 0.1)),
            property<&ToldClock::drift>(
                "drift", "", "largest drift of the two clocks against each other, s per s", range(0.0, 1e-2)),
            property<&ToldClock::silent_after>("silent_after", "s", "after this silence `known` is false",
                                               range(0.01, 3600.0)),
            property<&ToldClock::within>("within", "s", "an error above it makes `known` false",
                                         range(0.0, 1.0)),
            property<&ToldClock::rate_over>("rate_over", "s", "the rate is taken over at least this time",
                                            range(0.01, 3600.0)));
    }

private:
    void take(const Frame& frame, Time now) noexcept TAPPET_REALTIME {
        ClockFrame told;
        switch (decode(row, frame, told)) {
        case ClockRead::foreign: return;
        case ClockRead::wrong: invalid.write(invalid.last() + 1); return;
        case ClockRead::told: break;
        }
        if (told.kind == ClockFrame::Kind::sync)
            take_sync(told, frame.stamp);
        else
            take_follow_up(told, frame.stamp, now);
    }
    void take_sync(const ClockFrame& told, Time stamp) noexcept TAPPET_REALTIME {
        const unsigned steps = (told.sequence + 16U - sequence_) & 15U;
        // A duplicated SYNC does not show which time the sender means: the exchange is abandoned.
        const bool usable = !has_sequence_ || (steps != 0 && steps <= most_steps);
        if (is_open_ || !usable) discard();
        is_open_ = usable;
        has_sequence_ = true;
        sequence_ = told.sequence;
        seconds_ = told.number;
        through_ = stamp;
    }
    void take_follow_up(const ClockFrame& told, Time stamp, Time now) noexcept TAPPET_REALTIME {
        const bool usable =
            is_open_ && told.sequence == sequence_ && stamp - through_ < row.every && now >= through_;
        is_open_ = false;
        if (!usable) return discard();
        const std::int64_t seconds = std::int64_t{seconds_} + told.seconds_more;
        exchange(Time{Duration{seconds * 1'000'000'000 + told.number}}, now);
    }
    /// Processes an exchange: `theirs` is the sender's stamp of the SYNC, `through_` the own; both can be
    /// late.
    void exchange(Time theirs, Time now) noexcept TAPPET_REALTIME {
        const Duration ahead_now = theirs - through_;
        const Duration parted = ClockBounds::parted(now - through_ + own_late.get(), drift.get());
        bounds_.age(now, drift.get());
        bounds_.replace(ahead_now - teller_late.get() - parted, ahead_now + own_late.get() + parted);
        last_ = through_;
        exchanges.write(exchanges.last() + 1);
        const bool is_another = jumps.last() != bounds_.jumps();
        if (is_another) jumps.write(bounds_.jumps());
        if (has_anchor_ && !is_another) {
            const Duration over = through_ - anchor_;
            if (over < rate_over.get() + own_late.get()) return;
            rate.write(to_seconds(ahead_now - ahead_then_) / to_seconds(over));
            // The length of time is itself only known to the lateness of a stamp.
            rate_error.write((to_seconds(teller_late.get() + own_late.get()) +
                              drift.get() * to_seconds(own_late.get()) + 2e-9) /
                             to_seconds(over - own_late.get()));
        }
        has_anchor_ = true;
        anchor_ = through_;
        ahead_then_ = ahead_now;
    }
    void discard() noexcept TAPPET_REALTIME { discarded.write(discarded.last() + 1); }

    ClockBounds bounds_{};
    bool is_open_ = false; ///< SYNC waits for its FUP
    bool has_sequence_ = false, has_anchor_ = false;
    std::uint8_t sequence_ = 0;
    std::uint32_t seconds_ = 0;
    Time through_{}, last_{}, anchor_{};
    Duration ahead_then_{};
};

} // namespace tappet::can
