// Sends one request to the kernel over rtnetlink and reads its answer. Written by hand, because three
// requests do not justify a library in the firmware.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <linux/rtnetlink.h>

namespace tappet::can {

/// The meaning of a packet for the request with the number `sequence`.
struct NetlinkAnswer {
    bool ours = false; ///< from the kernel, and to this request; others are ignored
    int error = 0;     ///< an errno; 0: the answer, or an acknowledgement
};
/// Judges a packet. `sender`: its source port, 0 for the kernel; `cut`: the packet was longer than this.
NetlinkAnswer judge(std::span<const std::byte> packet, std::uint32_t sender, bool cut,
                    std::uint32_t sequence) noexcept;

/// Not real-time: waits for the answer, two seconds at most.
class Netlink {
public:
    Netlink() noexcept;
    Netlink(const Netlink&) = delete;
    Netlink& operator=(const Netlink&) = delete;
    ~Netlink();

    /// Sends a request. Returns 0 with the answer in data(), or an errno.
    int ask(const ifinfomsg& what, std::uint16_t type, std::uint16_t flags) noexcept;
    [[nodiscard]] std::span<const std::byte> data() const noexcept { return {buffer_.data(), length_}; }

private:
    int fd_;
    std::uint32_t sequence_ = 0;
    /// An answer about one interface has less than 2 KiB. The buffer is small because it is on the stack of
    /// the activity that restarts a bus.
    std::array<std::byte, 4096> buffer_{};
    std::size_t length_ = 0;
};

} // namespace tappet::can
