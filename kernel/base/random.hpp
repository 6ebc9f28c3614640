// Random numbers that are the same with every compiler and library: integers by xoshiro256** (Blackman and
// Vigna, 2018), seeded by splitmix64; distributions of our own. Never write two draws in one expression:
// their order is unspecified.
#pragma once

#include "kernel/base/realtime.hpp"

#include <cstdint>

namespace tappet {

class Random {
public:
    explicit constexpr Random(std::uint64_t seed) noexcept TAPPET_REALTIME {
        for (auto& word : state_) {
            seed += 0x9e3779b97f4a7c15u;
            std::uint64_t z = seed;
            z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
            z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
            word = z ^ (z >> 31);
        }
    }
    constexpr std::uint64_t next() noexcept TAPPET_REALTIME {
        const std::uint64_t result = rotate(state_[1] * 5, 7) * 9;
        const std::uint64_t t = state_[1] << 17;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= t;
        state_[3] = rotate(state_[3], 45);
        return result;
    }
    /// Returns an integer in [0, bound); 0 for bound 0. The bias of the multiply-shift is below 2^-32 for
    /// bounds under 2^32.
    constexpr std::uint64_t below(std::uint64_t bound) noexcept TAPPET_REALTIME {
        __extension__ using Wide = unsigned __int128;
        return static_cast<std::uint64_t>((static_cast<Wide>(next()) * bound) >> 64);
    }
    /// Returns an integer in [low, high].
    constexpr std::int64_t between(std::int64_t low, std::int64_t high) noexcept TAPPET_REALTIME {
        return low + static_cast<std::int64_t>(below(static_cast<std::uint64_t>(high - low) + 1));
    }
    /// Returns true once in `n` draws on average; never for n = 0.
    constexpr bool one_in(std::uint64_t n) noexcept TAPPET_REALTIME { return n != 0 && below(n) == 0; }
    /// Returns a real number in [0, 1), a multiple of 2^-53: exact, so equal everywhere.
    constexpr double unit() noexcept TAPPET_REALTIME { return static_cast<double>(next() >> 11) * 0x1p-53; }

private:
    static constexpr std::uint64_t rotate(std::uint64_t x, int k) noexcept TAPPET_REALTIME {
        return (x << k) | (x >> (64 - k));
    }
    std::uint64_t state_[4] = {};
};

} // namespace tappet
