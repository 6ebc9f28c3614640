// Longest time of a frame on the wire: worst stuffing, and the gap after it.
#pragma once

#include "drivers/can/frame.hpp"

namespace tappet::can {

/// The bit rates of a bus: nominal, and in the data phase of a frame that switches.
struct BitRates {
    std::int64_t nominal = 0; ///< bit/s
    std::int64_t data = 0;    ///< bit/s; 0: classical CAN only
};

/// Bits of an error besides the destroyed frame, at the nominal rate: flag, its echo, delimiter and gap.
inline constexpr std::uint32_t error_frame_bits = 31;

/// Returns the longest time in nanoseconds, rounded up; -1: this bus has no such frame. Classical: Davis,
/// Burns, Bril and Lukkien 2007. CAN FD: 32 (55 with a 29-bit identifier) bits of arbitration and, after the
/// switch, 33 + 10 p, with 5 more of checksum above 16 bytes and one of stuffing at 48.
constexpr std::int64_t frame_time_ns(Format format, bool extended, unsigned bytes, BitRates rates) noexcept {
    const std::int64_t slow = rates.nominal;
    const std::int64_t fast = format == Format::flexible_faster ? rates.data : slow;
    if (slow <= 0 || fast <= 0 || padded_length(bytes) < 0) return -1;
    std::int64_t slow_bits = 0, fast_bits = 0;
    if (format == Format::classical) {
        if (bytes > 8) return -1;
        // Bits open to stuffing, and the 13 others: delimiters, acknowledge, end, gap.
        const std::int64_t stuffed = (extended ? 54 : 34) + 8 * static_cast<std::int64_t>(bytes);
        slow_bits = stuffed + 13 + (stuffed - 1) / 4;
    } else {
        const std::int64_t p = padded_length(bytes);
        slow_bits = extended ? 55 : 32;
        fast_bits = 33 + 10 * p + (p > 16 ? 5 : 0) + (p == 48 ? 1 : 0);
    }
    const auto time = [](std::int64_t bits, std::int64_t rate) {
        return (bits * 1'000'000'000 + rate - 1) / rate;
    };
    return time(slow_bits, slow) + time(fast_bits, fast);
}

/// Returns the shortest time of a frame from its longest: without any stuffing at least four fifths of its
/// bits remain.
constexpr std::int64_t least_time_ns(std::int64_t longest_ns) noexcept {
    return longest_ns - longest_ns / 5 - (longest_ns % 5 != 0 ? 1 : 0); // no overflow, also for the longest
}

/// Returns the longest time of one frame; a remote frame carries no data, whatever its length.
constexpr std::int64_t frame_time_ns(const Frame& frame, BitRates rates) noexcept {
    return frame_time_ns(format_of(frame), frame.extended, frame.remote ? 0u : frame.length, rates);
}

} // namespace tappet::can
