// One end of an in-process CAN bus: replaces a controller for the machine or its plant in the host world.
#pragma once

#include "drivers/can/controller.hpp"
#include "drivers/twin/ring.hpp"
#include "kernel/base/text.hpp"

#include <atomic>
#include <expected>

namespace tappet::can {

/// Its owner uses it from one thread; the bus may run in another. Both sides share only two rings.
class Twin final : public ControlledDevice {
public:
    static constexpr std::size_t inbox = 256; // similar to Linux's default socket buffer: 278 frames
    static constexpr std::size_t outbox = 256;
    static_assert(outbox >= most_in_flight + 3 * TransmitQueue::capacity,
                  "what may be in flight fits, and the last words");

    /// Opens the end. Not real-time, before the bus runs. `interface` is a name for messages only.
    std::expected<void, Sentence> open(const Settings& settings) noexcept;

    Receive receive(Frame& frame) noexcept TAPPET_REALTIME override;
    void service(Time now) noexcept TAPPET_REALTIME override;
    /// Sends everything at once, beyond the limit in flight: in virtual time a stop gets no confirmations.
    bool finish(Time now) noexcept TAPPET_REALTIME override;
    Restart restart() noexcept override;
    /// Called by the bus's thread.
    [[nodiscard]] bool wakes(os::Waiter& waiter) noexcept override {
        waiter_ = &waiter;
        return true;
    }

    /// Returns whether an arrival waits for the owner; a confirmation counts, as it permits more sending.
    [[nodiscard]] bool has_arrivals() const noexcept TAPPET_REALTIME { return inbox_.front() != nullptr; }
    /// Fault injection: restart() fails from now on (or works again).
    void make_restarts_fail(bool fail) noexcept { restart_fails_.store(fail, std::memory_order_relaxed); }

private:
    friend class TwinBus;
    enum class Happened : std::uint8_t { frame, confirmed, error };
    struct Arrival {
        Happened what = Happened::frame;
        Frame frame{};
        std::uint32_t lost = 0; // cumulative, as SO_RXQ_OVFL counts
    };
    struct Departure {
        Frame frame{};
        Time handed_over{};
        std::uint32_t generation = 0;
    };

    Receive judge(const Arrival& arrival, Frame& frame) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool wants(const Frame& frame) const noexcept TAPPET_REALTIME;
    void hand_over(Time now) noexcept TAPPET_REALTIME;
    bool put_out(const Frame& frame, Time now) noexcept TAPPET_REALTIME;
    // Called by the bus.
    void arrive(Happened what, const Frame& frame) noexcept TAPPET_REALTIME;
    const Departure* head() noexcept TAPPET_REALTIME;
    void wake() noexcept TAPPET_REALTIME;

    Settings settings_{};
    std::uint32_t lost_seen_ = 0;
    twin::Ring<Arrival, inbox> inbox_{};
    twin::Ring<Departure, outbox> outbox_{};
    std::atomic<std::uint32_t> generation_{
        0}; // rises with each restart: frames handed over before are forgotten
    std::atomic<bool> off_bus_{false};
    std::atomic<bool> restart_fails_{false};
    std::uint32_t lost_ = 0; // the bus's: arrivals that found the inbox full
    bool arrived_ = false;   // the bus's: the listener is to be called
    bool starved_ = false;   // the bus's: this end knows that nobody acknowledges
    bool muted_ = false;     // the bus's: what it sends reaches no other end
    os::Waiter* waiter_ = nullptr;
};

} // namespace tappet::can
