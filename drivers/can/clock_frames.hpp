// The two frames by which one node of a bus sends its time, as in AUTOSAR (CanTSyn): SYNC, whose time on the
// bus both ends stamp, and FUP, which states that time by the sender's clock.
#pragma once

#include "drivers/can/services.hpp"
#include "kernel/base/crc.hpp"

#include <array>
#include <cstdint>

namespace tappet::can {

/// The clock of a bus and its frames; both ends use the same constant.
struct ClockRow {
    Identifier identifier{};                                  ///< of both frames
    Duration every{};                                         ///< from SYNC to SYNC
    Duration jitter{};                                        ///< by how much its sender may be late
    std::uint8_t domain = 0;                                  ///< 0..15: several may share an identifier
    std::array<std::uint8_t, 16> sync_ids{}, follow_up_ids{}; ///< by sequence number, in the checksum
};
/// clock(standard(0x090), every(100ms))
constexpr ClockRow clock(Identifier identifier, Rate rate, std::uint8_t domain = 0) noexcept {
    return {identifier, rate.every, rate.jitter, domain, {}, {}};
}

/// Latest time of a FUP after its SYNC; otherwise it is not sent.
constexpr Duration follow_up_within(const ClockRow& row) noexcept { return row.every / 4; }

/// Returns what is wrong with the row; empty: nothing.
constexpr Sentence clock_fault(const ClockRow& row) noexcept {
    if (!valid(row.identifier))
        return Sentence{"the clock's identifier ", row.identifier.id, " is out of range: give it another"};
    if (row.every < 10ms || row.every > 10s)
        return Sentence{"the clock is sent every ", row.every.count() / 1'000'000,
                        " ms: write every(..) from 10 ms to 10 s"};
    if (row.jitter < Duration::zero() || row.jitter > row.every / 4)
        return Sentence{"the clock's teller may be late by ", row.jitter.count() / 1'000'000,
                        " ms: write at most a quarter of its period"};
    if (row.domain > 15)
        return Sentence{"the clock's domain is ", unsigned{row.domain}, ": write one from 0 to 15"};
    return {};
}

/// Services for can::Bus<signals, clock_frames<row, transmit>>; the sender uses transmit, the others receive.
template <const auto& row, Direction direction>
inline constexpr auto clock_frames = [] {
    TAPPET_ACCEPTED(clock_fault(row));
    Services<2, 0> both{};
    both.sends_itself = true; // the sender; receivers send nothing
    // Not on the bus's own time grid. Two FUP can be closer together than two SYNC.
    const Rate sync{{}, row.every, direction == Direction::transmit ? Duration{} : row.jitter};
    const Rate follow_up{{}, row.every - row.jitter - follow_up_within(row), {}};
    both.frames = {FrameRow{{"clock.sync"}, sync, row.identifier, direction, 8},
                   FrameRow{{"clock.follow_up"}, follow_up, row.identifier, direction, 8}};
    return both;
}();

/// The contents of a frame.
struct ClockFrame {
    enum class Kind : std::uint8_t { sync, follow_up };
    Kind kind = Kind::sync;
    std::uint8_t sequence = 0; ///< 0..15
    /// SYNC: whole seconds of the sender's clock when the frame was made. FUP: ns from then until the SYNC
    /// was on the bus; whole seconds of that are in `seconds_more`.
    std::uint32_t number = 0;
    std::uint8_t seconds_more = 0; ///< 0..3

    constexpr bool operator==(const ClockFrame&) const = default;
};

namespace detail {

/// Returns the checksum over all bytes after it, with the id last.
constexpr std::uint8_t clock_checksum(const ClockRow& row, const Payload& data) noexcept TAPPET_REALTIME {
    const std::size_t sequence = data[2] & 15U;
    const bool is_sync = (data[0] & 8U) == 0;
    const std::array<std::uint8_t, 7> summed{data[2],
                                             data[3],
                                             data[4],
                                             data[5],
                                             data[6],
                                             data[7],
                                             is_sync ? row.sync_ids[sequence] : row.follow_up_ids[sequence]};
    return crc8_2f.of(summed);
}

inline constexpr std::uint8_t secured_sync = 0x20, secured_follow_up = 0x28;

} // namespace detail

constexpr Frame encode(const ClockRow& row, const ClockFrame& told) noexcept TAPPET_REALTIME {
    Frame frame{.id = row.identifier.id, .extended = row.identifier.extended, .length = 8};
    const bool is_sync = told.kind == ClockFrame::Kind::sync;
    frame.data[0] = is_sync ? detail::secured_sync : detail::secured_follow_up;
    frame.data[2] = static_cast<std::uint8_t>((row.domain & 15U) << 4 | (told.sequence & 15U));
    frame.data[3] = is_sync ? std::uint8_t{0} : static_cast<std::uint8_t>(told.seconds_more & 3U);
    for (std::size_t i = 0; i < 4; ++i)
        frame.data[4 + i] = static_cast<std::uint8_t>(told.number >> (24U - 8U * i));
    frame.data[1] = detail::clock_checksum(row, frame.data);
    return frame;
}

enum class ClockRead : std::uint8_t {
    told,    ///< a clock frame
    foreign, ///< another identifier, domain or kind of message
    wrong,   ///< damaged, or without a checksum
};
constexpr ClockRead decode(const ClockRow& row, const Frame& frame, ClockFrame& told) noexcept
    TAPPET_REALTIME {
    if (row.identifier != Identifier{frame.id, frame.extended} || frame.remote || frame.fd)
        return ClockRead::foreign;
    if (frame.length != 8) return ClockRead::wrong;
    if (frame.data[2] >> 4 != row.domain) return ClockRead::foreign;
    const std::uint8_t kind = frame.data[0];
    if (kind == 0x10 || kind == 0x18) return ClockRead::wrong; // SYNC and FUP without a checksum
    if (kind != detail::secured_sync && kind != detail::secured_follow_up) return ClockRead::foreign;
    if (frame.data[1] != detail::clock_checksum(row, frame.data)) return ClockRead::wrong;
    told = {};
    told.kind = kind == detail::secured_sync ? ClockFrame::Kind::sync : ClockFrame::Kind::follow_up;
    told.sequence = frame.data[2] & 15U;
    if (told.kind == ClockFrame::Kind::follow_up) told.seconds_more = frame.data[3] & 3U;
    for (std::size_t i = 0; i < 4; ++i) told.number = told.number << 8 | frame.data[4 + i];
    const bool too_much = told.kind == ClockFrame::Kind::follow_up && told.number >= 1'000'000'000;
    return too_much ? ClockRead::wrong : ClockRead::told;
}

} // namespace tappet::can
