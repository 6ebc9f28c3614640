// SPDX-License-Identifier: Apache-2.0
// The loader's file, field by field, little-endian.
#include "board/init/boot_state.hpp"

#include <array>
#include <cstddef>

namespace tappet::init {

namespace {

constexpr std::size_t text_bytes = 255 * 2;
constexpr std::size_t user_bytes = 131'072;
constexpr std::size_t all_bytes = 2 * text_bytes + 1 + 1 + 2 + 4 + user_bytes + 4;
constexpr std::size_t at_state = 2 * text_bytes + 1;
constexpr std::size_t at_watchdog = at_state + 1;
constexpr std::size_t at_revision = at_watchdog + 2;
constexpr std::size_t at_sum = all_bytes - 4;

/// A table by byte, because a machine waits for two files of this size before it arms.
constexpr auto sums_of_bytes = [] {
    std::array<std::uint32_t, 256> sums{};
    for (std::uint32_t byte = 0; byte < sums.size(); ++byte) {
        sums[byte] = byte;
        for (int bit = 0; bit < 8; ++bit)
            sums[byte] = (sums[byte] >> 1) ^ ((sums[byte] & 1U) != 0 ? 0xedb88320U : 0U);
    }
    return sums;
}();

/// CRC-32 of ISO 3309, the same as in zlib.
std::uint32_t sum_of(std::string_view bytes) {
    std::uint32_t sum = ~0U;
    for (const char byte : bytes)
        sum = (sum >> 8) ^ sums_of_bytes[(sum ^ static_cast<unsigned char>(byte)) & 0xffU];
    return ~sum;
}

void put(std::string& bytes, std::size_t at, std::uint32_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<char>(value >> (8 * i) & 0xffU);
}

std::uint32_t get(std::string_view bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return value;
}

} // namespace

std::string encode(const BootState& state) {
    std::string bytes(all_bytes, '\0');
    for (std::size_t i = 0; i < state.kernel.size() && i < 254; ++i) bytes[2 * i] = state.kernel[i];
    bytes[at_state] = static_cast<char>(state.state);
    put(bytes, at_watchdog, state.watchdog_s, 2);
    put(bytes, at_revision, state.revision, 4);
    put(bytes, at_sum, sum_of(std::string_view{bytes}.substr(0, at_sum)), 4);
    return bytes;
}

std::expected<BootState, std::string> decode(std::string_view bytes) {
    if (bytes.size() != all_bytes)
        return std::unexpected("has " + std::to_string(bytes.size()) + " bytes instead of " +
                               std::to_string(all_bytes));
    if (get(bytes, at_sum, 4) != sum_of(bytes.substr(0, at_sum)))
        return std::unexpected("is torn: its check sum does not fit");
    BootState state;
    for (std::size_t i = 0; i < 255 && bytes[2 * i] != '\0'; ++i) state.kernel += bytes[2 * i];
    state.state = static_cast<SlotState>(bytes[at_state]);
    state.watchdog_s = static_cast<std::uint16_t>(get(bytes, at_watchdog, 2));
    state.revision = get(bytes, at_revision, 4);
    return state;
}

} // namespace tappet::init
