// SPDX-License-Identifier: Apache-2.0
// The frames that make a bus's receivers safe, sent by who is left when the machine's process is no more.
#pragma once

#include "drivers/can/frame.hpp"
#include "kernel/base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string_view>

namespace tappet::can {

/// A socket of its own: the machine's has little room, which may be full of what it sent last. Not real-time.
class SafeSender {
public:
    /// A frame that was lost. Several wire times of the longest frame at 10 kbit/s.
    static constexpr Duration repeat_after = 50ms;
    static constexpr std::size_t most_frames = 64; // a bit for each

    SafeSender() = default;
    SafeSender(const SafeSender&) = delete;
    SafeSender& operator=(const SafeSender&) = delete;
    ~SafeSender() { close(); }

    /// `frames`, `most_frames` at most, outlive it. The error names the cure.
    std::expected<void, Sentence> open(std::string_view interface, std::span<const Frame> frames);
    void close() noexcept;

    /// Forgets what was confirmed, so that send() sends all frames again. What was sent before confirms none
    /// of them: they have a socket of their own, because a confirmation says whose frame it is, but not
    /// which. Without one (the kernel has none left), frames are sent and left() says that none is confirmed.
    void begin() noexcept;
    /// Hands over each frame once, in order, as far as the kernel has room; the next call goes on. Frames
    /// that are not confirmed are repeated when nothing else can bring them out: the kernel has accepted all,
    /// none waits in its queue, and for `repeat_after` none was confirmed. A rehearsal hands over all frames
    /// in a form that the kernel refuses: nothing reaches the bus.
    enum class Purpose : std::uint8_t { rehearsal, earnest };
    void send(Purpose purpose) noexcept;
    /// Takes what was confirmed since; how many frames are not.
    std::size_t left() noexcept;

private:
    [[nodiscard]] bool are_lost() const noexcept; // those that are not confirmed

    std::span<const Frame> frames_{};
    std::uint64_t confirmed_ = 0, accepted_ = 0; // by the bus, by the kernel
    Time progress_{};                            // of the last of them
    int interface_ = 0;
    int fd_ = -1;
    bool tells_ = true; // what the socket confirms was sent since begin()
};

} // namespace tappet::can
