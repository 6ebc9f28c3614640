// The only way in which a value crosses from one thread to another: word by word, each an atomic of its own.
// A copy torn by the other side is then not a data race but a value to be discarded.
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

/// Smallest distance of data that two threads write: a line is 64 bytes, but the hardware fetches lines in
/// pairs.
inline constexpr std::size_t line_pair_bytes = 128;

template <class T>
concept Exchangeable = copied_as_bytes<T> && std::is_trivially_destructible_v<T>;

// Two words at once where the processor keeps the order of such accesses. Nothing relies on such a move being
// whole: a copy is discarded unless the number after it shows that nobody wrote. So a torn pair is two words
// of the model, in which every word may be torn from the next. The thread sanitizer reports a non-atomic move
// as a race, so there the words are moved one by one. A test's Atomic may take part in pairs with
// before_pair().
#if defined(__SANITIZE_THREAD__)
#define TAPPET_MOVES_PAIRS 0
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TAPPET_MOVES_PAIRS 0
#endif
#endif
#if !defined(TAPPET_MOVES_PAIRS)
#if defined(__x86_64__)
#define TAPPET_MOVES_PAIRS 1
#else
#define TAPPET_MOVES_PAIRS 0
#endif
#endif

namespace detail {

/// Two words in one register.
using Pair [[gnu::vector_size(16)]] = std::uint64_t;
inline constexpr std::size_t pair_bytes = sizeof(Pair);
/// A pair in memory, at any address. g++ would treat a memcpy of sixteen bytes as an integer, and carry it in
/// two registers.
using PlacedPair [[gnu::vector_size(16), gnu::aligned(1), gnu::may_alias]] = std::uint64_t;

[[nodiscard]] inline PlacedPair& pair_at(std::byte* first, std::size_t i) noexcept TAPPET_REALTIME {
    return reinterpret_cast<PlacedPair*>(first)[i];
}
[[nodiscard]] inline const PlacedPair& pair_at(const std::byte* first, std::size_t i) noexcept
    TAPPET_REALTIME {
    return reinterpret_cast<const PlacedPair*>(first)[i];
}

// Written as instructions, because in the language a vector that two threads access at once is undefined. For
// the processor it is a move like that of a word, in the same order (Intel SDM 3A, 9.2.2: loads are not
// reordered with loads, nor stores with stores).
inline void store_pair(PlacedPair& to, Pair pair) noexcept TAPPET_REALTIME {
#if TAPPET_MOVES_PAIRS
    asm volatile("movups %1, %0" : "=m"(to) : "x"(pair));
#else
    to = pair;
#endif
}
inline Pair load_pair(const PlacedPair& from) noexcept TAPPET_REALTIME {
    Pair pair;
#if TAPPET_MOVES_PAIRS
    asm volatile("movups %1, %0" : "=x"(pair) : "m"(from));
#else
    pair = from;
#endif
    return pair;
}

// Values of up to so many pairs stay in registers between two copies.
inline constexpr std::size_t most_pairs_in_registers = 12;

} // namespace detail

/// Copies a value in place, sixteen bytes at once, so that the compiler can combine it with other copies of
/// the same value. Small and large values are left to the compiler's own copy.
template <Exchangeable T>
inline void copy_value(const T& from, T& into) noexcept TAPPET_REALTIME {
    constexpr std::size_t pairs = sizeof(T) / detail::pair_bytes;
    if constexpr (pairs < 4 || pairs > detail::most_pairs_in_registers) {
        into = from;
    } else {
        const auto* source = reinterpret_cast<const std::byte*>(std::addressof(from));
        auto* target = reinterpret_cast<std::byte*>(std::addressof(into));
        // All are loaded before the first is stored: the compiler cannot know that the two do not overlap.
        detail::Pair all[pairs];
#pragma GCC unroll 16
        for (std::size_t i = 0; i < pairs; ++i) all[i] = detail::pair_at(source, i);
#pragma GCC unroll 16
        for (std::size_t i = 0; i < pairs; ++i) detail::pair_at(target, i) = all[i];
        constexpr std::size_t done = pairs * detail::pair_bytes;
        if constexpr (done != sizeof(T)) __builtin_memcpy(target + done, source + done, sizeof(T) - done);
    }
}

/// Room for one T that one thread writes while others read it. Every word is stored with release and loaded
/// with acquire (on x86-64 the same plain moves as relaxed ones). So a reader that loads one word of a newer
/// value also sees everything that the writer stored before it began, and needs no fence, which the thread
/// sanitizer cannot follow. A larger value is moved two words at once. Atomic is std::atomic; tests replace
/// it by one that lets the other side run between any two accesses, also between two pairs.
template <Exchangeable T, template <class> class Atomic = std::atomic> class Words {
public:
    static constexpr std::size_t count = (sizeof(T) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);

private:
    // A small value was usually stored just now, field by field: a wider load would have to wait until those
    // stores have left the processor's buffer. The same holds for the last words of a large value, where its
    // stamp is.
    static constexpr std::size_t fewest_for_pairs = 12; // as often its loops are unrolled
    static constexpr bool is_told_of_pairs = requires { Atomic<std::uint64_t>::before_pair(); };
    static constexpr bool moves_pairs =
        TAPPET_MOVES_PAIRS != 0 && count >= fewest_for_pairs &&
        (is_told_of_pairs || std::is_same_v<Atomic<std::uint64_t>, std::atomic<std::uint64_t>>);
    static constexpr std::size_t pairs = moves_pairs ? (count - 1) / 2 : 0;
    static constexpr std::size_t singles = count - 2 * pairs;

public:
    /// A copy of all words, in registers while there are not too many.
    struct Copy {
        detail::Pair paired[pairs == 0 ? 1 : pairs];
        std::uint64_t single[singles];
    };

    static constexpr bool fits_registers = pairs != 0 && pairs <= detail::most_pairs_in_registers;

    static void pack(const T& from, Copy& into) noexcept TAPPET_REALTIME {
        const auto* bytes = reinterpret_cast<const std::byte*>(std::addressof(from));
#pragma GCC unroll 16
        for (std::size_t i = 0; i < pairs; ++i) into.paired[i] = detail::pair_at(bytes, i);
#pragma GCC unroll 12
        for (std::size_t i = 0; i < singles; ++i) into.single[i] = word_of(from, 2 * pairs + i);
    }
    void store(const Copy& from) noexcept TAPPET_REALTIME {
        if constexpr (pairs != 0) {
            std::atomic_signal_fence(std::memory_order_acq_rel);
#pragma GCC unroll 16
            for (std::size_t i = 0; i < pairs; ++i) put_pair(i, from.paired[i]);
            std::atomic_signal_fence(std::memory_order_acq_rel);
        }
#pragma GCC unroll 12
        for (std::size_t i = 0; i < singles; ++i)
            words_[2 * pairs + i].store(from.single[i], std::memory_order_release); // words.store
    }
    void store(const T& from) noexcept TAPPET_REALTIME {
        const auto* bytes = reinterpret_cast<const std::byte*>(std::addressof(from));
        if constexpr (pairs != 0) {
            std::atomic_signal_fence(std::memory_order_acq_rel);
#pragma GCC unroll 16
            for (std::size_t i = 0; i < pairs; ++i) put_pair(i, detail::pair_at(bytes, i));
            std::atomic_signal_fence(std::memory_order_acq_rel);
        }
#pragma GCC unroll 12
        for (std::size_t i = 2 * pairs; i < count; ++i)
            words_[i].store(word_of(from, i), std::memory_order_release); // words.store
    }
    void load(Copy& into) const noexcept TAPPET_REALTIME {
        if constexpr (pairs != 0) {
            std::atomic_signal_fence(std::memory_order_acq_rel);
#pragma GCC unroll 16
            for (std::size_t i = 0; i < pairs; ++i) into.paired[i] = take_pair(i);
            std::atomic_signal_fence(std::memory_order_acq_rel);
        }
#pragma GCC unroll 12
        for (std::size_t i = 0; i < singles; ++i)
            into.single[i] = words_[2 * pairs + i].load(std::memory_order_acquire); // words.load
    }
    /// Loads the value directly, for callers that know that nobody writes: without a copy to discard.
    void load(T& into) const noexcept TAPPET_REALTIME {
        auto* bytes = reinterpret_cast<std::byte*>(std::addressof(into));
        if constexpr (pairs != 0) {
            std::atomic_signal_fence(std::memory_order_acq_rel);
#pragma GCC unroll 16
            for (std::size_t i = 0; i < pairs; ++i) detail::pair_at(bytes, i) = take_pair(i);
            std::atomic_signal_fence(std::memory_order_acq_rel);
        }
#pragma GCC unroll 12
        for (std::size_t i = 2 * pairs; i < count; ++i)
            put(into, i, words_[i].load(std::memory_order_acquire)); // words.take
    }
    static void unpack(const Copy& from, T& into) noexcept TAPPET_REALTIME {
        auto* bytes = reinterpret_cast<std::byte*>(std::addressof(into));
#pragma GCC unroll 16
        for (std::size_t i = 0; i < pairs; ++i) detail::pair_at(bytes, i) = from.paired[i];
#pragma GCC unroll 12
        for (std::size_t i = 0; i < singles; ++i) put(into, 2 * pairs + i, from.single[i]);
    }

private:
    static constexpr std::size_t whole = sizeof(T) / sizeof(std::uint64_t);
    static constexpr std::size_t rest = sizeof(T) % sizeof(std::uint64_t);

    void put_pair(std::size_t i, detail::Pair from) noexcept TAPPET_REALTIME {
        if constexpr (is_told_of_pairs) Atomic<std::uint64_t>::before_pair();
        auto& place = reinterpret_cast<detail::PlacedPair&>(words_[2 * i]);
        detail::store_pair(place, from); // words.store
    }
    [[nodiscard]] detail::Pair take_pair(std::size_t i) const noexcept TAPPET_REALTIME {
        if constexpr (is_told_of_pairs) Atomic<std::uint64_t>::before_pair();
        const auto& place = reinterpret_cast<const detail::PlacedPair&>(words_[2 * i]);
        return detail::load_pair(place); // words.load
    }
    [[nodiscard]] static std::uint64_t word_of(const T& from, std::size_t i) noexcept TAPPET_REALTIME {
        const auto* bytes = reinterpret_cast<const std::byte*>(std::addressof(from));
        std::uint64_t word = 0;
        if (i < whole)
            __builtin_memcpy(&word, bytes + i * sizeof word, sizeof word);
        else
            __builtin_memcpy(&word, bytes + i * sizeof word, rest);
        return word;
    }
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
