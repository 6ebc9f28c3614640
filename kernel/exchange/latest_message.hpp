// The newest of what one thread posts to one other: three places, of which each side owns one and both
// exchange the third, so that nobody waits and nothing is torn (thesis 4.6.2: save only the last event data).
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

    /// The sender's thread only, real-time: one copy, one exchange. True: the receiver took what was there
    /// before and is to be told of this one. False: it replaced one that nobody took, whose notice is still
    /// on its way.
    [[nodiscard]] bool put(const Message& message) noexcept TAPPET_REALTIME {
        places_[back_].message = message;
        const std::uint32_t was = middle_.exchange(back_ | fresh, std::memory_order_acq_rel); // latest.put
        back_ = was & ~fresh;
        return (was & fresh) == 0;
    }
    /// The receiver's thread only, real-time: one exchange. Null: nothing is new. What it points at stays as
    /// it is until the next call.
    [[nodiscard]] const Message* take() noexcept TAPPET_REALTIME {
        const std::uint32_t was = middle_.exchange(front_, std::memory_order_acq_rel); // latest.take
        front_ = was & ~fresh;
        return (was & fresh) != 0 ? &places_[front_].message : nullptr;
    }
    /// Numbers of places, below `places`, for who keeps something beside each message: the sender's next one;
    /// the receiver's, of what it took last. Real-time, each in its own thread.
    [[nodiscard]] std::uint32_t place_of_next() const noexcept TAPPET_REALTIME { return back_; }
    [[nodiscard]] std::uint32_t place_of_taken() const noexcept TAPPET_REALTIME { return front_; }

private:
    static constexpr std::uint32_t fresh = 4; ///< beside a place's number: nobody took it
    struct alignas(64) Place {
        Message message{};
    };
    std::array<Place, places> places_{};
    alignas(64) std::uint32_t back_ = 0;  // the sender's
    alignas(64) std::uint32_t front_ = 2; // the receiver's
    alignas(64) std::atomic<std::uint32_t> middle_{1};
};

} // namespace tappet
