// The CAN controller behind a Linux network interface (SocketCAN, a raw socket).
#pragma once

#include "drivers/can/arrival.hpp"
#include "drivers/can/controller.hpp"
#include "drivers/can/link.hpp"

#include <array>
#include <expected>
#include <linux/can.h>
#include <sys/socket.h>

namespace tappet::can {

class SocketCan final : public ControlledDevice {
public:
    SocketCan() = default;
    ~SocketCan() override { close(); }

    /// Not real-time. The spans in `settings` must outlive the device. On failure nothing stays open, and the
    /// error says what is wrong and how to cure it.
    std::expected<void, Sentence> open(const Settings& settings);
    /// The same, on an interface that was found already.
    std::expected<void, Sentence> open(const Settings& settings, const Link& link);
    /// What open() saw of the interface and its bus, for the report of arming.
    [[nodiscard]] const Sentence& found() const noexcept { return found_; }
    /// Not real-time. Drops what waits and leaves the bus.
    void close() noexcept;

    Receive receive(Frame& frame) noexcept TAPPET_REALTIME override;
    void service(Time now) noexcept TAPPET_REALTIME override;
    /// While frames are confirmed at least every 20 ms, and for 200 ms at most.
    bool finish(Time now) noexcept TAPPET_REALTIME override;
    Restart restart() noexcept override;
    [[nodiscard]] int wait_handle() const noexcept TAPPET_REALTIME override { return fd_; }
    void set_listener(Listener, void*) noexcept override {} // the descriptor says it

private:
    /// What one system call brought, in its order; read by receive() one after the other.
    struct Batch {
        static constexpr std::size_t size = 8;
        union Told { // by the kernel, of one frame
            cmsghdr aligned;
            char bytes[192];
        };
        std::array<canfd_frame, size> frames{};
        std::array<iovec, size> parts{};
        std::array<Told, size> told{};
        std::array<mmsghdr, size> messages{};
        std::size_t next = 0, filled = 0;
        int error = 0;
        bool is_last = false; ///< nothing waited behind it

        void read_from(int fd) noexcept;
        [[nodiscard]] bool is_empty() const noexcept TAPPET_REALTIME { return next == filled; }
    };
    struct Raw;
    Receive judge(const Raw& raw, Frame& frame) noexcept TAPPET_REALTIME;
    void hand_over(Time now) noexcept TAPPET_REALTIME;
    std::expected<void, Sentence> set_options(const Settings& settings);

    int fd_ = -1;
    Link link_{};
    Sentence found_{};
    std::uint32_t drops_seen_ = 0;
    Arrivals arrivals_{};
    Batch batch_{};
};

} // namespace tappet::can
