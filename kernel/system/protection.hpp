#pragma once
#include "kernel/base/realtime.hpp"
#include <array>
#include <cstdint>
#include <span>
namespace tappet {
namespace temp {
constexpr std::uint8_t crc(std::uint8_t c, std::uint8_t byte) noexcept TAPPET_REALTIME {
    c ^= byte;
    for (int i = 0; i < 8; ++i) c = static_cast<std::uint8_t>((c & 0x80) ? (c << 1) ^ 0x1D : c << 1);
    return c;
}
constexpr std::uint8_t of(std::span<const std::uint8_t> d, std::uint16_t id) noexcept TAPPET_REALTIME {
    std::uint8_t c = crc(crc(0, static_cast<std::uint8_t>(id)), static_cast<std::uint8_t>(id >> 8));
    for (std::size_t i = 1; i < d.size(); ++i) c = crc(c, d[i]);
    return c;
}
} // namespace temp
class Protector {
public:
    void protect(std::span<std::uint8_t> d, std::uint16_t id) noexcept TAPPET_REALTIME {
        d[1] = static_cast<std::uint8_t>((d[1] & 0xF0) | counter_);
        counter_ = static_cast<std::uint8_t>(counter_ == 14 ? 0 : counter_ + 1);
        d[0] = temp::of(d, id);
    }

private:
    std::uint8_t counter_ = 0;
};
class ProtectionCheck {
public:
    bool check(std::span<const std::uint8_t> d, std::uint16_t id) noexcept TAPPET_REALTIME {
        return d[0] == temp::of(d, id);
    }
};
} // namespace tappet
