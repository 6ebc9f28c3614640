// Checksums against the catalogue's check values and a bit-by-bit computation.
#include "kernel/base/crc.hpp"
#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tappet {
namespace {

constexpr std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
static_assert(crc8_j1850.of(digits) == 0x4B);
static_assert(crc8_2f.of(digits) == 0xDF);
static_assert(crc16_ccitt.of(digits) == 0x29B1);
static_assert(crc16_ccitt.of({}) == 0xFFFF);

/// The shift register itself.
unsigned by_bits(unsigned polynomial, unsigned width, unsigned rest, std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes)
        for (int bit = 7; bit >= 0; --bit) {
            const bool out = (rest >> (width - 1) & 1U) != (byte >> bit & 1U);
            rest = (rest << 1 & ((1U << width) - 1U)) ^ (out ? polynomial : 0U);
        }
    return rest;
}

TEST(Crc, equals_the_result_of_the_shift_register) {
    Random random{1};
    for (int i = 0; i < 1000; ++i) {
        std::vector<std::uint8_t> bytes(random.below(70));
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
        ASSERT_EQ(crc8_j1850.of(bytes), by_bits(0x1D, 8, 0xFF, bytes) ^ 0xFF);
        ASSERT_EQ(crc8_2f.of(bytes), by_bits(0x2F, 8, 0xFF, bytes) ^ 0xFF);
        ASSERT_EQ(crc16_ccitt.of(bytes), by_bits(0x1021, 16, 0xFFFF, bytes));
    }
}

TEST(Crc, gives_the_same_value_in_parts_and_at_once) {
    for (std::size_t cut = 0; cut <= digits.size(); ++cut) {
        const auto all = std::span{digits};
        EXPECT_EQ(crc16_ccitt.steps(crc16_ccitt.steps(crc16_ccitt.first(), all.first(cut)), all.subspan(cut)),
                  0x29B1);
    }
}

} // namespace
} // namespace tappet
