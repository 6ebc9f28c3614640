// An in-process CAN bus: arbitration and bit times between twins, deterministic, with injection of every bus
// fault.
#pragma once

#include "drivers/can/frame_time.hpp"
#include "drivers/can/twin.hpp"
#include "kernel/base/random.hpp"

#include <optional>

namespace tappet::can {

/// Probability of a fault: the next `next` frames, and one in `one_in` of the others (0: none).
struct Chance {
    std::uint32_t next = 0;
    std::uint32_t one_in = 0;
};

struct BusFaults {
    Chance spoil{};          ///< an error on the wire: sent again after an error frame
    Chance lose{};           ///< acknowledged by another node, but never delivered to this end
    Chance duplicate{};      ///< delivered twice: a sender that missed the last bit repeats
    Chance corrupt_length{}; ///< arrives with the next shorter length, or one byte long when empty
    Chance delay{};
    Duration delay_by = 5ms;
    std::optional<Identifier> only{}; ///< only frames with this identifier are affected
};

/// Only the bus's thread calls deliver_until and the faults. Real-time.
class TwinBus {
public:
    /// Nominal rate 0: frames take no time on the wire. Data rate 0: the same as the nominal one.
    explicit TwinBus(std::uint64_t seed, BitRates rates = {}) noexcept : random_{seed} {
        set_bit_rates(rates);
    }
    void set_bit_rates(BitRates rates) noexcept TAPPET_REALTIME {
        rates_ = {rates.nominal, rates.data != 0 ? rates.data : rates.nominal};
    }
    /// Returns when the next frame is completely on the wire; never: none is queued, or frames take no time.
    [[nodiscard]] Time next() noexcept TAPPET_REALTIME {
        const auto winner = rates_.nominal == 0 || !acknowledged_ ? std::nullopt : arbitrate(never - 1ns);
        return winner ? winner->start + wire_time(*winner->frame) : never;
    }

    static constexpr std::size_t most_ends = 8;
    /// Frames from the wire as they arrived; the owner empties it after each call that advances the bus.
    using Tap = twin::Ring<Frame, 2 * 4 * most_ends * Twin::outbox>;
    /// Sets the tap. Not real-time, before the bus runs. Null: no tap.
    void set_tap(Tap* tap) noexcept { tap_ = tap; }
    /// Confirms what this end sends, but delivers it to nobody. Not real-time, before the bus runs.
    void mute(Twin& end) noexcept { end.muted_ = true; }
    /// Delivers a frame of a node without an end at that moment, independent of arbitration and of faults.
    void put(const Frame& frame, Time at) noexcept TAPPET_REALTIME;
    /// Returns the number of frames that found the tap full.
    [[nodiscard]] std::uint64_t frames_untapped() const noexcept TAPPET_REALTIME { return untapped_; }

    /// Connects an end. Not real-time, before the bus runs. Returns false when there are already eight.
    [[nodiscard]] bool attach(Twin& end) noexcept { return ends_.push(&end); }

    /// Delivers every frame that is on the wire by `now`, in the order of arbitration; then calls the
    /// listeners.
    void deliver_until(Time now) noexcept TAPPET_REALTIME;

    BusFaults faults{};
    /// Stops acknowledgement: frames stay in the controllers, which become error passive.
    void set_acknowledged(bool acknowledged) noexcept TAPPET_REALTIME { acknowledged_ = acknowledged; }
    /// Puts the end's controller bus-off; `restart()` brings it back.
    void bus_off(Twin& end) noexcept TAPPET_REALTIME;
    void set_state(Twin& end, State state) noexcept TAPPET_REALTIME;
    /// Lets the next `frames` frames to this end find its buffer full.
    void overflow(Twin& end, std::uint32_t frames) noexcept TAPPET_REALTIME { end.lost_ += frames; }
    /// Simulates a babbling node: sends this frame every `period` from `from` on; period 0 silences it.
    void babble(const Frame& frame, Duration period, Time from) noexcept TAPPET_REALTIME;

    /// Returns true when nothing is queued at any end and no event is pending.
    [[nodiscard]] bool is_silent() const noexcept TAPPET_REALTIME {
        for (const Twin* end : ends_)
            if (end->arrived_ || end->starved_ || end->outbox_.front() != nullptr) return false;
        return next_babble_ == never && delayed_.empty();
    }
    /// Returns true when the next deliver_until() cannot deliver anything by time alone.
    [[nodiscard]] bool is_still() const noexcept TAPPET_REALTIME {
        return acknowledged_ && rates_.nominal == 0 && next_babble_ == never && delayed_.empty();
    }
    [[nodiscard]] std::uint64_t frames_on_wire() const noexcept TAPPET_REALTIME { return frames_on_wire_; }
    [[nodiscard]] std::uint64_t frames_lost() const noexcept TAPPET_REALTIME { return frames_lost_; }

private:
    struct Delayed {
        Frame frame{};
        Twin* from = nullptr;
        bool operator==(const Delayed&) const = default;
    };
    struct Contender {
        Twin* end = nullptr; // null: the babbling node
        const Frame* frame = nullptr;
        Time start{};
    };
    [[nodiscard]] std::optional<Contender> arbitrate(Time now) noexcept TAPPET_REALTIME;
    void transmit(const Contender& winner, Time finish) noexcept TAPPET_REALTIME;
    bool put_off_until(Time when, Frame frame, Twin* from) noexcept TAPPET_REALTIME;
    void hand_out(const Frame& frame, const Twin* from) noexcept TAPPET_REALTIME;
    void tap(const Frame& frame) noexcept TAPPET_REALTIME;
    void swallow(Twin& muted) noexcept TAPPET_REALTIME;
    void release_delayed(Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool strikes(Chance& chance, const Frame& frame) noexcept TAPPET_REALTIME;
    [[nodiscard]] Duration wire_time(const Frame& frame) const noexcept TAPPET_REALTIME;
    [[nodiscard]] Duration error_time() const noexcept TAPPET_REALTIME;
    void tell(Twin& end, const BusError& error, Time now) noexcept TAPPET_REALTIME;

    Random random_;
    BitRates rates_{};
    Bounded<Twin*, most_ends> ends_{};
    Bounded<Delayed, 64> delayed_{};
    bool acknowledged_ = true;
    Time free_at_ = Time::min();
    Time now_{};
    Frame babble_{};
    Duration babble_every_{};
    Time next_babble_ = never;
    std::uint64_t frames_on_wire_ = 0;
    std::uint64_t frames_lost_ = 0;
    Tap* tap_ = nullptr;
    std::uint64_t untapped_ = 0;
};

} // namespace tappet::can
