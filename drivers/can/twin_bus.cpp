// The bus of the host world, frame by frame: arbitration, delivery and faults.
#include "drivers/can/twin_bus.hpp"

namespace tappet::can {
namespace {

/// Returns the next shorter valid length; for 0 it returns 1.
std::uint8_t next_to(std::uint8_t length) noexcept TAPPET_REALTIME {
    if (length == 0) return 1;
    do --length;
    while (padded_length(length) != length);
    return length;
}

} // namespace

void TwinBus::deliver_until(Time now) noexcept TAPPET_REALTIME {
    now_ = now;
    if (is_silent()) return;
    for (Twin* end : ends_)
        if (end->muted_) swallow(*end);
    // Each end can send at most `outbox` frames before its owner runs again; so does the babbling node.
    for (std::size_t i = 0; acknowledged_ && i < 4 * most_ends * Twin::outbox; ++i) {
        const auto winner = arbitrate(now);
        if (!winner) break;
        const Time finish = winner->start + wire_time(*winner->frame);
        if (finish > now) break;
        if (strikes(faults.spoil, *winner->frame)) {
            free_at_ = finish + error_time();
            continue;
        }
        release_delayed(finish);
        transmit(*winner, finish);
    }
    release_delayed(now);
    for (Twin* end : ends_) {
        // A restart leaves frames that are discarded here; a new frame then starves again.
        const bool waits = !acknowledged_ && end->head() != nullptr;
        if (!acknowledged_ && !waits) end->starved_ = false;
        if (waits && !end->starved_) {
            end->starved_ = true;
            set_state(*end,
                      State::passive); // no further: missing acknowledgements alone never lead to bus-off
        }
        end->wake();
    }
}

std::optional<TwinBus::Contender> TwinBus::arbitrate(Time now) noexcept TAPPET_REALTIME {
    Time earliest = next_babble_;
    for (Twin* end : ends_)
        if (const auto* head = end->head()) earliest = std::min(earliest, head->handed_over);
    if (earliest > now) return std::nullopt;
    const Time start = std::max(free_at_, earliest);
    std::optional<Contender> best;
    if (next_babble_ <= start) best = Contender{nullptr, &babble_, start};
    for (Twin* end : ends_) {
        const auto* head = end->head();
        if (head == nullptr || head->handed_over > start) continue;
        if (!best || arbitration(head->frame) < arbitration(*best->frame))
            best = Contender{end, &head->frame, start};
    }
    return best;
}

void TwinBus::transmit(const Contender& winner, Time finish) noexcept TAPPET_REALTIME {
    free_at_ = finish;
    ++frames_on_wire_;
    Frame frame = *winner.frame;
    frame.stamp = finish;
    if (winner.end == nullptr) {
        next_babble_ += babble_every_;
    } else {
        winner.end->outbox_.drop();
        winner.end->arrive(Twin::Happened::confirmed, frame);
        if (winner.end->starved_) tell(*winner.end, {.state = State::active}, finish);
        winner.end->starved_ = false;
    }
    // One draw per fault in a fixed order, so that a seed always gives the same run.
    const bool lost = strikes(faults.lose, frame);
    const bool doubled = strikes(faults.duplicate, frame);
    const bool corrupted = strikes(faults.corrupt_length, frame);
    const bool late = strikes(faults.delay, frame);
    if (corrupted) frame.length = next_to(frame.length);
    tap(frame);
    if (doubled) tap(frame);
    if (lost) {
        ++frames_lost_;
        return;
    }
    const bool put_off = late && put_off_until(finish + faults.delay_by, frame, winner.end);
    if (!put_off) hand_out(frame, winner.end);
    if (doubled) hand_out(frame, winner.end);
}

void TwinBus::put(const Frame& frame, Time at) noexcept TAPPET_REALTIME {
    Frame sent = frame;
    sent.stamp = at;
    ++frames_on_wire_;
    tap(sent);
    hand_out(sent, nullptr);
}

void TwinBus::tap(const Frame& frame) noexcept TAPPET_REALTIME {
    if (tap_ != nullptr && !tap_->push(frame)) ++untapped_;
}

void TwinBus::swallow(Twin& muted) noexcept TAPPET_REALTIME {
    for (std::size_t i = 0; i < Twin::outbox; ++i) {
        const auto* head = muted.head();
        if (head == nullptr) return;
        Frame frame = head->frame;
        frame.stamp = now_;
        muted.outbox_.drop();
        muted.arrive(Twin::Happened::confirmed, frame);
    }
}

bool TwinBus::put_off_until(Time when, Frame frame, Twin* from) noexcept TAPPET_REALTIME {
    frame.stamp = when;
    return delayed_.push({frame, from});
}

void TwinBus::hand_out(const Frame& frame, const Twin* from) noexcept TAPPET_REALTIME {
    for (Twin* end : ends_)
        if (end != from && !end->off_bus_.load(std::memory_order_acquire) && end->wants(frame))
            end->arrive(Twin::Happened::frame, frame);
}

void TwinBus::release_delayed(Time now) noexcept TAPPET_REALTIME {
    for (std::size_t round = 0; round < delayed_.capacity() && !delayed_.empty(); ++round) {
        std::size_t first = 0;
        for (std::size_t i = 1; i < delayed_.size(); ++i)
            if (delayed_[i].frame.stamp < delayed_[first].frame.stamp) first = i;
        if (delayed_[first].frame.stamp > now) return;
        const Delayed due = delayed_[first];
        for (std::size_t i = first + 1; i < delayed_.size(); ++i) delayed_[i - 1] = delayed_[i];
        --delayed_.used;
        hand_out(due.frame, due.from);
    }
}

bool TwinBus::strikes(Chance& chance, const Frame& frame) noexcept TAPPET_REALTIME {
    const bool drawn = random_.one_in(chance.one_in);
    if (faults.only && *faults.only != Identifier{frame.id, frame.extended}) return false;
    if (chance.next == 0) return drawn;
    --chance.next;
    return true;
}

Duration TwinBus::wire_time(const Frame& frame) const noexcept TAPPET_REALTIME {
    return rates_.nominal == 0 ? 0ns : Duration{std::max<std::int64_t>(frame_time_ns(frame, rates_), 0)};
}

Duration TwinBus::error_time() const noexcept TAPPET_REALTIME {
    return rates_.nominal == 0 ? 0ns
                               : Duration{error_frame_bits * std::int64_t{1'000'000'000} / rates_.nominal};
}

void TwinBus::tell(Twin& end, const BusError& error, Time now) noexcept TAPPET_REALTIME {
    end.arrive(Twin::Happened::error, {.length = 8, .stamp = now, .error = error});
}

void TwinBus::bus_off(Twin& end) noexcept TAPPET_REALTIME {
    end.off_bus_.store(true, std::memory_order_release);
    tell(end, {.state = State::bus_off, .transmit_errors = 255}, now_);
}

void TwinBus::set_state(Twin& end, State state) noexcept TAPPET_REALTIME {
    if (state == State::bus_off) return bus_off(end);
    const std::uint8_t errors = state == State::active ? 0 : state == State::warning ? 96 : 128;
    tell(end, {.state = state, .transmit_errors = errors}, now_);
}

void TwinBus::babble(const Frame& frame, Duration period, Time from) noexcept TAPPET_REALTIME {
    babble_ = frame;
    babble_every_ = period;
    next_babble_ = period > 0ns ? from : never;
}

} // namespace tappet::can
