// One request to the kernel over rtnetlink and the one answer to it, by hand: three requests do not justify a
// library in the firmware.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <linux/rtnetlink.h>

namespace tappet::can {

/// What a packet says to whoever asked with the number `sequence`.
struct NetlinkAnswer {
    bool ours = false; ///< from the kernel, and to this request; anything else is left unread
    int error = 0;     ///< an errno; 0: the answer, or an acknowledgement
};
/// `sender` is the port it came from, 0 for the kernel; `cut`: the packet was longer than these bytes.
NetlinkAnswer judge(std::span<const std::byte> packet, std::uint32_t sender, bool cut,
                    std::uint32_t sequence) noexcept;

/// Not real-time: it waits for the answer, two seconds at most.
class Netlink {
public:
    Netlink() noexcept;
    Netlink(const Netlink&) = delete;
    Netlink& operator=(const Netlink&) = delete;
    ~Netlink();

    /// 0 and the answer in data(), or an errno.
    int ask(const ifinfomsg& what, std::uint16_t type, std::uint16_t flags) noexcept;
    [[nodiscard]] std::span<const std::byte> data() const noexcept { return {buffer_.data(), length_}; }

private:
    int fd_;
    std::uint32_t sequence_ = 0;
    /// An answer about one interface has less than 2 KiB. Not more room, because it lies on the stack of the
    /// activity that restarts a bus.
    std::array<std::byte, 4096> buffer_{};
    std::size_t length_ = 0;
};

} // namespace tappet::can
