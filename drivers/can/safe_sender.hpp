// SPDX-License-Identifier: Apache-2.0
// Sends the frames that make a bus's receivers safe, from the process that remains when the machine's has
// ended.
#pragma once

#include "drivers/can/frame.hpp"
#include "kernel/base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string_view>

namespace tappet::can {

/// Uses a socket of its own, because the machine's has little room and may still be full. Not real-time.
class SafeSender {
public:
    /// When to repeat a lost frame: several wire times of the longest frame at 10 kbit/s.
    static constexpr Duration repeat_after = 50ms;
    static constexpr std::size_t most_frames = 64; // one bit each

    SafeSender() = default;
    SafeSender(const SafeSender&) = delete;
    SafeSender& operator=(const SafeSender&) = delete;
    ~SafeSender() { close(); }

    /// Opens the socket. `frames`, at most `most_frames`, must outlive this. The error names the cure.
    std::expected<void, Sentence> open(std::string_view interface, std::span<const Frame> frames);
    void close() noexcept;

    /// Resets the confirmations, so that send() sends all frames again, on a new socket: a confirmation
    /// identifies the socket, but not the frame, so earlier frames must not count. If the kernel has no
    /// socket left, frames are sent, and left() reports none as confirmed.
    void begin() noexcept;
    /// Hands over each frame once, in order, as far as the kernel has room; the next call continues.
    /// Unconfirmed frames are repeated when nothing else can send them: the kernel has accepted all, its
    /// queue is empty, and no confirmation came for `repeat_after`. A rehearsal hands over all frames in a
    /// form that the kernel refuses: nothing reaches the bus.
    enum class Purpose : std::uint8_t { rehearsal, earnest };
    void send(Purpose purpose) noexcept;
    /// Reads new confirmations; returns the number of unconfirmed frames.
    std::size_t left() noexcept;

private:
    [[nodiscard]] bool are_lost() const noexcept; // the unconfirmed ones

    std::span<const Frame> frames_{};
    std::uint64_t confirmed_ = 0, accepted_ = 0; // by the bus, by the kernel
    Time progress_{};                            // time of the last of either
    int interface_ = 0;
    int fd_ = -1;
    bool tells_ = true; // confirmations of this socket belong to frames sent since begin()
};

} // namespace tappet::can
