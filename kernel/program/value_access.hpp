// How primitives read and write values in a program's data: as bytes at any address, also while a script is
// compiled in a constant expression.
#pragma once

#include "kernel/program/context.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

namespace tappet {

/// The integer type of scripts.
using ScriptInt = std::int64_t;

/// Real-time. A bool is read as "not zero": its bytes may come from any source.
template <class T>
constexpr T load_value(const std::byte* from) noexcept TAPPET_REALTIME {
    if constexpr (std::is_same_v<T, bool>) {
        return *from != std::byte{0};
    } else if constexpr (std::is_same_v<T, Duration>) {
        return Duration{load_value<Duration::rep>(from)};
    } else {
        if (std::is_constant_evaluated()) {
            std::array<std::byte, sizeof(T)> bytes{};
            for (std::size_t i = 0; i < sizeof(T); ++i) bytes[i] = from[i];
            return std::bit_cast<T>(bytes);
        }
        T value{};
        std::memcpy(&value, from, sizeof(T));
        return value;
    }
}

template <class T>
constexpr void store_value(std::byte* into, const T& value) noexcept TAPPET_REALTIME {
    if constexpr (std::is_same_v<T, bool>) {
        *into = std::byte{value};
    } else if constexpr (std::is_same_v<T, Duration>) {
        store_value(into, value.count());
    } else {
        if (std::is_constant_evaluated()) {
            const auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
            for (std::size_t i = 0; i < sizeof(T); ++i) into[i] = bytes[i];
            return;
        }
        std::memcpy(into, &value, sizeof(T));
    }
}

/// Copies bytes; the ranges may overlap.
constexpr void copy_bytes(std::byte* into, const std::byte* from, std::size_t size) noexcept TAPPET_REALTIME {
    if (std::is_constant_evaluated()) {
        for (std::size_t i = 0; i < size; ++i) into[i] = from[i];
        return;
    }
    std::memmove(into, from, size);
}

} // namespace tappet
