// A vector of at most N elements, in place: usable in constant expressions and on real-time paths.
#pragma once

#include "kernel/base/realtime.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>

namespace tappet {

template <class T, std::size_t N>
struct Bounded {
    std::array<T, N> items{};
    std::size_t used = 0;

    /// Adds an element. Returns false, and stores nothing, when it is full. Real-time.
    [[nodiscard]] constexpr bool push(const T& item) noexcept TAPPET_REALTIME {
        if (used == N) return false;
        items[used++] = item;
        return true;
    }
    constexpr void clear() noexcept TAPPET_REALTIME { used = 0; }
    [[nodiscard]] constexpr std::size_t size() const noexcept TAPPET_REALTIME { return used; }
    [[nodiscard]] constexpr bool empty() const noexcept TAPPET_REALTIME { return used == 0; }
    [[nodiscard]] constexpr bool full() const noexcept TAPPET_REALTIME { return used == N; }
    [[nodiscard]] static constexpr std::size_t capacity() noexcept TAPPET_REALTIME { return N; }
    constexpr T& operator[](std::size_t i) noexcept TAPPET_REALTIME { return items[i]; }
    constexpr const T& operator[](std::size_t i) const noexcept TAPPET_REALTIME { return items[i]; }
    constexpr T* begin() noexcept TAPPET_REALTIME { return items.data(); }
    constexpr T* end() noexcept TAPPET_REALTIME { return items.data() + used; }
    constexpr const T* begin() const noexcept TAPPET_REALTIME { return items.data(); }
    constexpr const T* end() const noexcept TAPPET_REALTIME { return items.data() + used; }
    constexpr const T* data() const noexcept TAPPET_REALTIME { return items.data(); }
    friend constexpr bool operator==(const Bounded& a, const Bounded& b) noexcept
        requires std::equality_comparable<T>
    {
        return std::equal(a.begin(), a.end(), b.begin(), b.end());
    }
};

} // namespace tappet
