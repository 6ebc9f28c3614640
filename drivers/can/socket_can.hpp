// The CAN controller behind a Linux network interface (SocketCAN): one raw socket for arrivals, and one for
// sending and confirmations, which wake only an activity that waits for them.
#pragma once

#include "drivers/can/arrival.hpp"
#include "drivers/can/controller.hpp"
#include "drivers/can/link.hpp"

#include <algorithm>
#include <array>
#include <expected>
#include <linux/can.h>
#include <sys/socket.h>

namespace tappet::can {

class SocketCan final : public ControlledDevice {
public:
    SocketCan() = default;
    ~SocketCan() override { close(); }

    /// Opens the device. Not real-time. The spans in `settings` must outlive the device. On failure nothing
    /// stays open, and the error states cause and cure.
    std::expected<void, Sentence> open(const Settings& settings);
    /// Opens the device on an interface that was already found.
    std::expected<void, Sentence> open(const Settings& settings, const Link& link);
    /// Returns the state of the interface and its bus at open(), for the arming report.
    [[nodiscard]] const Sentence& found() const noexcept { return found_; }
    /// Drops queued frames and leaves the bus. Not real-time.
    void close() noexcept;
    [[nodiscard]] bool is_open() const noexcept { return arrives_.fd >= 0; }

    Receive receive(Frame& frame) noexcept TAPPET_REALTIME override;
    void drop_arrivals() noexcept TAPPET_REALTIME override;
    void service(Time now) noexcept TAPPET_REALTIME override;
    /// Continues while frames are confirmed at least every 20 ms, and for 200 ms at most.
    bool finish(Time now) noexcept TAPPET_REALTIME override;
    [[nodiscard]] Time next_service() const noexcept TAPPET_REALTIME override {
        return std::min(controller_.next_timeout(), next_look_);
    }
    Restart restart() noexcept override;
    [[nodiscard]] bool wakes(os::Waiter& waiter) noexcept override;
    void wake_when_confirmed() noexcept override { wakes_when_confirmed_ = true; }

private:
    /// Checks for a confirmation this many times before it is late. At 1 Mbit/s at most 120 frames of other
    /// nodes arrive between two checks. They fit into the socket's buffer even if it could not be enlarged.
    static constexpr int looks_at_one = 4;

    /// Result of one system call, in order; receive() returns the frames one by one.
    struct Batch {
        static constexpr std::size_t size = 8;
        union Told { // the kernel's data of one frame
            cmsghdr aligned;
            char bytes[192];
        };
        std::array<canfd_frame, size> frames{};
        std::array<iovec, size> parts{};
        std::array<Told, size> told{};
        std::array<mmsghdr, size> messages{};
        std::size_t next = 0, filled = 0;
        int error = 0;
        bool is_last = false; ///< nothing was queued after it

        void read_from(int fd) noexcept;
        [[nodiscard]] bool is_empty() const noexcept TAPPET_REALTIME { return next == filled; }
    };
    struct Socket {
        int fd = -1;
        std::uint32_t drops_seen = 0;
        Arrivals arrivals{};
        Batch batch{};
    };
    struct Raw;
    /// Returns false when nothing is queued there.
    bool read(Socket& from) noexcept TAPPET_REALTIME;
    Receive judge(const Raw& raw, Socket& from, Frame& frame) noexcept TAPPET_REALTIME;
    void take_confirmations() noexcept TAPPET_REALTIME;
    void hand_over(Time now) noexcept TAPPET_REALTIME;
    std::expected<void, Sentence> open(Socket& socket, const Settings& settings,
                                       std::span<const Identifier> identifiers);

    Socket arrives_{}, sends_{};
    os::Waiter* waiter_ = nullptr;
    bool wakes_when_confirmed_ = false;
    bool nothing_arrives_ = false; ///< the wake-up came from a sent frame, or from an impostor
    bool more_confirmed_ = false;  ///< more are queued after those read
    std::uint32_t lost_there_ = 0; ///< not reported yet
    Time next_look_ = never;
    Link link_{};
    Sentence found_{};
};

} // namespace tappet::can
