// Values that reveal tearing, and threads that meet at random moments.
#pragma once

#include "kernel/base/random.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <thread>

namespace tappet {

/// Bytes / 8 words that all follow from the first, so that a mix of two values is detected.
template <std::size_t Bytes> struct Sealed {
    std::array<std::uint64_t, Bytes / 8> words{};

    static Sealed of(std::uint64_t number) {
        Sealed value;
        for (std::size_t i = 0; i < value.words.size(); ++i)
            value.words[i] = number + i * 0x9e3779b97f4a7c15u;
        return value;
    }
    [[nodiscard]] std::uint64_t number() const { return words[0]; }
    [[nodiscard]] bool whole() const { return *this == of(number()); }
    bool operator==(const Sealed&) const = default;
};

/// The seed from the environment, so that a failing seed can be repeated and many can be tried.
inline std::uint64_t stress_seed() {
    const char* const text = std::getenv("TAPPET_SEED");
    return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
}

/// Lets other threads run. A yield would last as long as all others want to run on a busy host.
inline void rest() { std::this_thread::sleep_for(std::chrono::microseconds{1}); }

/// Sleeps, waits briefly, or mostly does neither, at random.
inline void dither(Random& random) {
    if (random.one_in(64)) rest();
    if (!random.one_in(8)) return;
    const std::uint64_t spins = random.below(256);
    for (std::uint64_t i = 0; i < spins; ++i) asm volatile("" ::: "memory");
}

} // namespace tappet
