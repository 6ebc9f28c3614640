// What a fixed-size matrix of Eigen is, known by its shape: the kernel names no header of Eigen for it.
#pragma once

#include "kernel/base/realtime.hpp"

#include <concepts>
#include <type_traits>

namespace tappet {

/// A fixed-size Eigen matrix or array: plain numbers, though Eigen 3.4 writes out its copy constructor, so
/// that the language does not call it trivially copyable. Maps and blocks, which hold pointers, are not their
/// own PlainObject.
template <class T>
concept FixedSizeEigen = std::is_trivially_destructible_v<T> && (T::SizeAtCompileTime > 0) &&
                         std::same_as<typename T::PlainObject, T>;

/// True when a copy of the bytes is a copy of the value. A struct with fixed-size Eigen members says so
/// itself:
///     template <> inline constexpr bool tappet::copied_as_bytes<Wrench> = true;
template <class T>
inline constexpr bool copied_as_bytes = std::is_trivially_copyable_v<T> || FixedSizeEigen<T>;

/// What nobody has written yet: T{}, and zero where that would leave the numbers as they are. Real-time.
template <class T>
constexpr T default_value() noexcept TAPPET_REALTIME {
    if constexpr (FixedSizeEigen<T>)
        return T::Zero();
    else
        return T{};
}

} // namespace tappet
