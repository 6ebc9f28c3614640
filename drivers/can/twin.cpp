// The two sides of an end: the owner's calls, and the bus's.
#include "drivers/can/twin.hpp"

namespace tappet::can {

std::expected<void, Sentence> Twin::open(const Settings& settings) noexcept {
    for (const auto list : {settings.receive, settings.transmit})
        for (const Identifier& one : list)
            if (!valid(one))
                return std::unexpected{Sentence{"CAN twin \"", settings.interface, "\": identifier ", one.id,
                                                " is out of range; correct the signal map"}};
    settings_ = settings;
    // On a new open by a new process, what its predecessor left is discarded.
    generation_.fetch_add(1, std::memory_order_acq_rel);
    for (Arrival left; inbox_.pop(left);) lost_seen_ = left.lost;
    off_bus_.store(false, std::memory_order_release);
    controller_.configure(settings);
    return {};
}

bool Twin::wants(const Frame& frame) const noexcept TAPPET_REALTIME {
    if (frame.remote || (frame.fd && !settings_.takes_fd)) return false;
    for (const auto list : {settings_.receive, settings_.transmit})
        for (const Identifier& one : list)
            if (one.id == frame.id && one.extended == frame.extended) return true;
    return false;
}

Receive Twin::receive(Frame& frame) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    for (std::size_t i = 0; i < inbox; ++i) { // confirmations and frames for others are not returned
        const Arrival* arrival = inbox_.front();
        if (arrival == nullptr) return {};
        const Receive answer = judge(*arrival, frame);
        inbox_.drop();
        if (answer.what != Received::none || answer.lost != 0) return answer;
    }
    return {};
}

Receive Twin::judge(const Arrival& arrival, Frame& frame) noexcept TAPPET_REALTIME {
    Receive answer;
    answer.lost = arrival.lost - lost_seen_;
    lost_seen_ = arrival.lost;
    controller_.count.lost_in_kernel += answer.lost;
    switch (arrival.what) {
    case Happened::confirmed:
        controller_.confirmed(arrival.frame.stamp);
        hand_over(arrival.frame.stamp);
        return answer;
    case Happened::error:
        controller_.report(arrival.frame.error);
        answer.what = Received::error_frame;
        break;
    case Happened::frame:
        if (!valid(arrival.frame)) {
            ++controller_.count.malformed;
            return answer;
        }
        if (controller_.ours(arrival.frame)) {
            ++controller_.count.impostors;
            return answer;
        }
        ++controller_.count.received;
        answer.what = Received::frame;
        break;
    }
    frame = arrival.frame;
    return answer;
}

void Twin::service(Time now) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    controller_.tick(now);
    hand_over(now);
}

void Twin::hand_over(Time now) noexcept TAPPET_REALTIME {
    for (std::uint32_t i = 0; i < most_in_flight; ++i) {
        const Frame* frame = controller_.next(now);
        if (frame == nullptr) return;
        if (!put_out(*frame, now)) return;
        controller_.handed_over(now);
    }
}

bool Twin::put_out(const Frame& frame, Time now) noexcept TAPPET_REALTIME {
    Departure* const leaving = outbox_.room();
    if (leaving == nullptr) {
        ++controller_.count.back_pressure;
        return false;
    }
    leaving->frame = frame;
    leaving->handed_over = now;
    leaving->generation = generation_.load(std::memory_order_acquire);
    outbox_.add();
    return true;
}

bool Twin::finish(Time now) noexcept TAPPET_REALTIME {
    Frame frame;
    // The owner first receives the faults since its last call.
    for (std::size_t n = 0; n < inbox && inbox_.front() != nullptr; ++n) static_cast<void>(receive(frame));
    service(now);
    while (controller_.take_waiting(frame))
        if (!put_out(frame, now)) return false;
    return !faulted(controller_.state());
}

Restart Twin::restart() noexcept {
    const Restart begun = controller_.recovery.begin();
    if (begun != Restart::done) return begun;
    if (restart_fails_.load(std::memory_order_relaxed)) return controller_.recovery.end(false);
    generation_.fetch_add(1, std::memory_order_acq_rel);
    off_bus_.store(false, std::memory_order_release);
    return controller_.recovery.end(true);
}

void Twin::arrive(Happened what, const Frame& frame) noexcept TAPPET_REALTIME {
    Arrival* const arriving = inbox_.room();
    if (arriving == nullptr) {
        ++lost_;
        return;
    }
    arriving->what = what;
    arriving->frame = frame;
    arriving->lost = lost_;
    inbox_.add();
    arrived_ = true;
}

const Twin::Departure* Twin::head() noexcept TAPPET_REALTIME {
    const std::uint32_t generation = generation_.load(std::memory_order_acquire);
    const bool off = off_bus_.load(std::memory_order_acquire);
    for (std::size_t i = 0; i <= outbox; ++i) {
        const Departure* first = outbox_.front();
        if (first == nullptr) return nullptr;
        if (!off && first->generation == generation) return first;
        outbox_.drop();
    }
    return nullptr;
}

void Twin::wake() noexcept TAPPET_REALTIME {
    if (arrived_ && waiter_ != nullptr) waiter_->wake();
    arrived_ = false;
}

} // namespace tappet::can
