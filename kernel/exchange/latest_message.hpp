// The newest message of one thread to one other: three places. Each side owns one place and both exchange the
// third, so that nobody waits and nothing is torn (thesis 4.6.2: save only the last event data).
#pragma once

#include "kernel/exchange/mailbox.hpp"

#include <array>
#include <atomic>
#include <cstdint>

namespace tappet {

class LatestMessage {
public:
    static constexpr std::uint32_t places = 3;

    LatestMessage() = default;
    LatestMessage(const LatestMessage&) = delete;
    LatestMessage& operator=(const LatestMessage&) = delete;

    /// Puts a message: one copy, one exchange. The sender's thread only, real-time. True: the receiver has
    /// taken the message before, and must be notified of this one. False: it replaced a message that was not
    /// taken, whose notice is still waiting.
    [[nodiscard]] bool put(const Message& message) noexcept TAPPET_REALTIME {
        places_[back_].message = message;
        const std::uint32_t was = middle_.exchange(back_ | fresh, std::memory_order_acq_rel); // latest.put
        back_ = was & ~fresh;
        return (was & fresh) == 0;
    }
    /// Takes the newest message: one exchange. The receiver's thread only, real-time. Null: nothing new. The
    /// message stays unchanged until the next call.
    [[nodiscard]] const Message* take() noexcept TAPPET_REALTIME {
        const std::uint32_t was = middle_.exchange(front_, std::memory_order_acq_rel); // latest.take
        front_ = was & ~fresh;
        return (was & fresh) != 0 ? &places_[front_].message : nullptr;
    }
    /// Return numbers of places, below `places`, for data kept beside each message: the sender's next place,
    /// and the receiver's place of the message taken last. Real-time, each in its own thread.
    [[nodiscard]] std::uint32_t place_of_next() const noexcept TAPPET_REALTIME { return back_; }
    [[nodiscard]] std::uint32_t place_of_taken() const noexcept TAPPET_REALTIME { return front_; }

private:
    static constexpr std::uint32_t fresh = 4; ///< added to a place's number: the message was not taken
    struct alignas(64) Place {
        Message message{};
    };
    std::array<Place, places> places_{};
    alignas(64) std::uint32_t back_ = 0;  // the sender's
    alignas(64) std::uint32_t front_ = 2; // the receiver's
    alignas(64) std::atomic<std::uint32_t> middle_{1};
};

} // namespace tappet
