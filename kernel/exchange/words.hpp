// The one way a value crosses from one thread to another: word by word, each an atomic of its own, so that a
// copy torn by the other side is no data race but a value to be thrown away.
#pragma once

#include "kernel/base/fixed_matrix.hpp"
#include "kernel/base/realtime.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace tappet {

/// What two threads write must lie this far apart: a line is 64 bytes, but the hardware fetches them in
/// pairs.
inline constexpr std::size_t line_pair_bytes = 128;

/// True when a copy of the bytes is a copy of the value. A struct with fixed-size Eigen members says so
/// itself:
///     template <> inline constexpr bool tappet::copied_as_bytes<Wrench> = true;
template <class T>
inline constexpr bool copied_as_bytes = std::is_trivially_copyable_v<T> || FixedSizeEigen<T>;

template <class T>
concept Exchangeable = copied_as_bytes<T> && std::is_trivially_destructible_v<T>;

/// Room for one T that one thread writes while others read it. Every word is stored with release and loaded
/// with acquire (on x86-64 the same plain moves as relaxed ones): a reader that met one word of a newer value
/// therefore also sees whatever the writer stored before it began, and needs no fence, which the thread
/// sanitizer cannot follow. Atomic is std::atomic; tests put one in its place that lets the other side run
/// between any two accesses.
template <Exchangeable T, template <class> class Atomic = std::atomic> class Words {
public:
    static constexpr std::size_t count = (sizeof(T) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);
    using Copy = std::array<std::uint64_t, count>;

    void store(const T& from) noexcept TAPPET_REALTIME {
        const auto* bytes = reinterpret_cast<const std::byte*>(std::addressof(from));
        for (std::size_t i = 0; i < count; ++i) {
            std::uint64_t word = 0;
            if (i < whole)
                __builtin_memcpy(&word, bytes + i * sizeof word, sizeof word);
            else
                __builtin_memcpy(&word, bytes + i * sizeof word, rest);
            words_[i].store(word, std::memory_order_release); // words.store
        }
    }
    void load(Copy& into) const noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < count; ++i)
            into[i] = words_[i].load(std::memory_order_acquire); // words.load
    }
    /// For whoever knows that nobody is writing: without the copy in between that could be thrown away.
    void load(T& into) const noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < count; ++i)
            put(into, i, words_[i].load(std::memory_order_acquire)); // words.take
    }
    static void unpack(const Copy& from, T& into) noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < count; ++i) put(into, i, from[i]);
    }

private:
    static constexpr std::size_t whole = sizeof(T) / sizeof(std::uint64_t);
    static constexpr std::size_t rest = sizeof(T) % sizeof(std::uint64_t);

    static void put(T& into, std::size_t i, std::uint64_t word) noexcept TAPPET_REALTIME {
        auto* bytes = reinterpret_cast<std::byte*>(std::addressof(into));
        if (i < whole)
            __builtin_memcpy(bytes + i * sizeof word, &word, sizeof word);
        else
            __builtin_memcpy(bytes + i * sizeof word, &word, rest);
    }

    std::array<Atomic<std::uint64_t>, count> words_{};
};

} // namespace tappet
