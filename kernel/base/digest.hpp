// A running digest of a machine's actions, FNV-1a over 64-bit words: equal for two runs that did the same.
#pragma once

#include "kernel/base/realtime.hpp"

#include <cstdint>

namespace tappet {

class Digest {
public:
    constexpr void add(std::uint64_t word) noexcept TAPPET_REALTIME {
        value_ = (value_ ^ word) * 0x100000001b3u;
        value_ ^= value_ >> 29; // a multiplication alone never carries high bits down
    }
    constexpr void add(std::int64_t word) noexcept TAPPET_REALTIME { add(static_cast<std::uint64_t>(word)); }
    [[nodiscard]] constexpr std::uint64_t value() const noexcept TAPPET_REALTIME { return value_; }
    constexpr bool operator==(const Digest&) const = default;

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

} // namespace tappet
