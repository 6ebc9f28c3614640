// Cyclic redundancy checks, highest bit first, with a table of one byte made by the compiler.
#pragma once

#include "kernel/base/realtime.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tappet {

/// A check with this polynomial, without its highest power. Real-time; one look-up a byte.
template <class Word> class Crc {
public:
    constexpr Crc(Word polynomial, Word first, Word last) noexcept : first_{first}, last_{last} {
        constexpr Word highest = static_cast<Word>(Word{1} << (8 * sizeof(Word) - 1));
        for (std::size_t byte = 0; byte < table_.size(); ++byte) {
            auto rest = static_cast<Word>(byte << (8 * (sizeof(Word) - 1)));
            for (int bit = 0; bit < 8; ++bit)
                rest = static_cast<Word>((rest & highest) != 0 ? (rest << 1) ^ polynomial : rest << 1);
            table_[byte] = rest;
        }
    }
    /// Adds one byte: for checks that begin with another value than `first`, or do not end yet.
    [[nodiscard]] constexpr Word step(Word rest, std::uint8_t byte) const noexcept TAPPET_REALTIME {
        const std::size_t at = (rest >> (8 * (sizeof(Word) - 1))) ^ byte;
        if constexpr (sizeof(Word) == 1) return table_[at];
        return static_cast<Word>((rest << 8) ^ table_[at]);
    }
    [[nodiscard]] constexpr Word steps(Word rest, std::span<const std::uint8_t> bytes) const noexcept
        TAPPET_REALTIME {
        for (const std::uint8_t byte : bytes) rest = step(rest, byte);
        return rest;
    }
    [[nodiscard]] constexpr Word of(std::span<const std::uint8_t> bytes) const noexcept TAPPET_REALTIME {
        return steps(first_, bytes) ^ last_;
    }
    [[nodiscard]] constexpr Word first() const noexcept TAPPET_REALTIME { return first_; }

private:
    Word first_, last_;
    std::array<Word, 256> table_{};
};

inline constexpr Crc<std::uint8_t> crc8_j1850{0x1D, 0xFF, 0xFF};    ///< SAE J1850
inline constexpr Crc<std::uint8_t> crc8_2f{0x2F, 0xFF, 0xFF};       ///< AUTOSAR's CRC8H2F
inline constexpr Crc<std::uint16_t> crc16_ccitt{0x1021, 0xFFFF, 0}; ///< AUTOSAR's CRC16, CCITT-FALSE

/// Returns the checksum of disks and files, lowest bit first: with zlib's polynomial, or Castagnoli's. Not
/// for large amounts: bit by bit.
constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes,
                              std::uint32_t polynomial = 0xEDB88320u) noexcept TAPPET_REALTIME {
    std::uint32_t rest = ~std::uint32_t{0};
    for (const std::uint8_t byte : bytes) {
        rest ^= byte;
        for (int bit = 0; bit < 8; ++bit) rest = (rest & 1) != 0 ? rest >> 1 ^ polynomial : rest >> 1;
    }
    return ~rest;
}
inline constexpr std::uint32_t castagnoli = 0x82F63B78u;

} // namespace tappet
