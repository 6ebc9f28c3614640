// End-to-end protection of a payload between two machines: a checksum over the contents and the connection's
// id, and a counter, as in AUTOSAR (E2E profile 11 for classic CAN, profile 5 for CAN FD). The carrier of the
// payload need not be trusted.
#pragma once

#include "kernel/base/crc.hpp"
#include "kernel/base/text.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tappet {

/// The protection of one connection's payloads; both ends use the same.
struct Protection {
    enum class Form : std::uint8_t {
        id_both,   ///< profile 11: a byte of checksum, four bits of counter; both bytes of the id in the sum
        id_low,    ///< profile 1: only the low byte of the id in the sum
        id_nibble, ///< profile 11: the low byte in the sum, the next four bits beside the counter
        wide,      ///< profile 5: two bytes of checksum, the lower first, and one of counter
    };
    Form form = Form::id_both;
    std::uint16_t id = 0; ///< unique for each connection of the system
    std::size_t at = 0;   ///< the byte where the header begins
    /// The most counter steps between two payloads that count as losses; more steps are out of order.
    std::uint8_t most_steps = 3;

    [[nodiscard]] constexpr bool is_wide() const noexcept TAPPET_REALTIME { return form == Form::wide; }
    [[nodiscard]] constexpr unsigned counters() const noexcept TAPPET_REALTIME {
        return is_wide() ? 256 : 15;
    }
    [[nodiscard]] constexpr std::size_t checksum_bytes() const noexcept TAPPET_REALTIME {
        return is_wide() ? 2 : 1;
    }
    /// Bits from bit 8 * `at` on; the four bits above the 12 of id_both and id_low belong to the payload.
    [[nodiscard]] constexpr unsigned header_bits() const noexcept {
        return is_wide() ? 24 : form == Form::id_nibble ? 16 : 12;
    }
    [[nodiscard]] constexpr bool fits(std::size_t bytes) const noexcept TAPPET_REALTIME {
        return bytes > checksum_bytes() && at < bytes - checksum_bytes();
    }
};

/// Says why payloads of that many bytes cannot be protected like this; empty: they can.
constexpr Sentence protection_fault(const Protection& by, std::size_t bytes) {
    if (!by.fits(bytes))
        return Sentence{"a header of ",
                        by.checksum_bytes() + 1,
                        " bytes at byte ",
                        by.at,
                        " does not fit into a payload of ",
                        bytes,
                        bytes == 1 ? " byte" : " bytes",
                        ": move the header or lengthen the payload"};
    if (by.form == Protection::Form::id_nibble && by.id > 0x0FFF)
        return Sentence{"the id ", unsigned{by.id},
                        " has more than the 12 bits that are sent and summed: "
                        "give one up to 4095, or take id_both"};
    if (by.form == Protection::Form::id_low && by.id > 0x00FF)
        return Sentence{"the id ", unsigned{by.id},
                        " has more than the 8 bits that are summed: "
                        "give one up to 255, or take id_both"};
    if (by.most_steps == 0 || by.most_steps >= by.counters())
        return Sentence{"most_steps is ", unsigned{by.most_steps}, ": write one from 1 to ",
                        by.counters() - 1};
    return {};
}

namespace detail {

/// Returns the sum over everything but the checksum itself. The payload must fit.
constexpr std::uint16_t protection_sum(std::span<const std::uint8_t> bytes, const Protection& by) noexcept
    TAPPET_REALTIME {
    const auto low = static_cast<std::uint8_t>(by.id & 0xFF);
    const auto high = static_cast<std::uint8_t>(by.id >> 8);
    const auto before = bytes.first(by.at);
    const auto behind = bytes.subspan(by.at + by.checksum_bytes());
    if (by.is_wide()) {
        const std::uint16_t sum = crc16_ccitt.steps(crc16_ccitt.steps(crc16_ccitt.first(), before), behind);
        return crc16_ccitt.step(crc16_ccitt.step(sum, low), high);
    }
    // The standard's initial value and its final XOR cancel out: it begins with 0.
    std::uint8_t sum = crc8_j1850.step(0, low);
    if (by.form == Protection::Form::id_both) sum = crc8_j1850.step(sum, high);
    if (by.form == Protection::Form::id_nibble) sum = crc8_j1850.step(sum, 0);
    return crc8_j1850.steps(crc8_j1850.steps(sum, before), behind);
}
constexpr std::uint16_t checksum_in(std::span<const std::uint8_t> bytes, const Protection& by) noexcept
    TAPPET_REALTIME {
    const unsigned high = by.is_wide() ? bytes[by.at + 1] : 0U;
    return static_cast<std::uint16_t>(bytes[by.at] | high << 8);
}

} // namespace detail

/// Writes the header; everything else of the payload must be there already. `counter` must be below
/// by.counters(). False, and nothing is written: the payload is too short, or there is no such counter.
/// Wait-free: one step for each byte.
[[nodiscard]] constexpr bool protect(std::span<std::uint8_t> bytes, const Protection& by,
                                     std::uint8_t counter) noexcept TAPPET_REALTIME {
    if (!by.fits(bytes.size()) || counter >= by.counters()) return false;
    std::uint8_t& beside = bytes[by.at + by.checksum_bytes()];
    if (by.is_wide())
        beside = counter;
    else if (by.form == Protection::Form::id_nibble)
        beside = static_cast<std::uint8_t>((by.id >> 8 & 0x0F) << 4 | counter);
    else
        beside = static_cast<std::uint8_t>((beside & 0xF0) | counter);
    const std::uint16_t sum = detail::protection_sum(bytes, by);
    bytes[by.at] = static_cast<std::uint8_t>(sum & 0xFF);
    if (by.is_wide()) bytes[by.at + 1] = static_cast<std::uint8_t>(sum >> 8);
    return true;
}

/// The sender's end, with its own counter. Real-time, for one activity.
class Protector {
public:
    explicit constexpr Protector(const Protection& by) noexcept : by_{by} {}
    /// Protects a payload. False: like protect(); the counter stays.
    [[nodiscard]] constexpr bool protect(std::span<std::uint8_t> bytes) noexcept TAPPET_REALTIME {
        if (!tappet::protect(bytes, by_, next_)) return false;
        next_ = static_cast<std::uint8_t>((next_ + 1U) % by_.counters());
        return true;
    }

private:
    Protection by_;
    std::uint8_t next_ = 0;
};

/// The receiver's judgement of a payload.
struct ProtectionVerdict {
    enum class Kind : std::uint8_t {
        ok,          ///< the next one after the last
        some_lost,   ///< usable; the `lost` payloads before it never arrived
        initial,     ///< correct, and the first one: earlier losses are unknown
        repeated,    ///< the last one again
        wrong_order, ///< an old one, or more than most_steps were lost, or its sender restarted
        wrong_crc,   ///< corrupted, cut, or of another connection
        no_new_data, ///< nothing arrived
    };
    Kind kind = Kind::no_new_data;
    std::uint8_t lost = 0;

    /// Whether its contents may be used.
    [[nodiscard]] constexpr bool usable() const noexcept TAPPET_REALTIME { return kind <= Kind::initial; }
    constexpr bool operator==(const ProtectionVerdict&) const = default;
};

/// The receiver's end. It cannot detect the loss of a whole turn of the counter; only the age of the last
/// usable payload shows that. Real-time, for one activity.
class ProtectionCheck {
public:
    explicit constexpr ProtectionCheck(const Protection& by) noexcept : by_{by} {}

    /// Judges the payload of a cycle; call it once a cycle, with empty bytes when nothing arrived. As in the
    /// standard, a payload that is out of order becomes the last one: its successor is ok again.
    [[nodiscard]] constexpr ProtectionVerdict check(std::span<const std::uint8_t> bytes) noexcept
        TAPPET_REALTIME {
        using enum ProtectionVerdict::Kind;
        if (bytes.empty()) return {no_new_data};
        if (!by_.fits(bytes.size()) || detail::checksum_in(bytes, by_) != detail::protection_sum(bytes, by_))
            return {wrong_crc};
        const std::uint8_t beside = bytes[by_.at + by_.checksum_bytes()];
        const unsigned counter = by_.is_wide() ? beside : beside & 0x0FU;
        const bool other_id = by_.form == Protection::Form::id_nibble && beside >> 4 != (by_.id >> 8 & 0x0F);
        if (counter >= by_.counters() || other_id) return {wrong_crc};
        const unsigned steps = (counter + by_.counters() - last_) % by_.counters();
        last_ = counter;
        if (!known_) {
            known_ = true;
            return {initial};
        }
        if (steps == 0) return {repeated};
        if (steps > by_.most_steps) return {wrong_order};
        return {steps == 1 ? ok : some_lost, static_cast<std::uint8_t>(steps - 1)};
    }
    /// Restarts the connection.
    constexpr void reset() noexcept TAPPET_REALTIME { known_ = false; }

private:
    Protection by_;
    unsigned last_ = 0;
    bool known_ = false;
};

} // namespace tappet
