// Detection of a fixed-size matrix of Eigen by its members: the kernel includes no header of Eigen for it.
#pragma once

#include "kernel/base/realtime.hpp"

#include <concepts>
#include <type_traits>

namespace tappet {

/// A fixed-size Eigen matrix or array. It consists of plain numbers, but Eigen 3.4 defines its copy
/// constructor, so that the language does not call it trivially copyable. Maps and blocks, which hold
/// pointers, are not their own PlainObject.
template <class T>
concept FixedSizeEigen = std::is_trivially_destructible_v<T> && (T::SizeAtCompileTime > 0) &&
                         std::same_as<typename T::PlainObject, T>;

/// True when a copy of the bytes is a copy of the value. A struct with fixed-size Eigen members must state
/// it:
///     template <> inline constexpr bool tappet::copied_as_bytes<Wrench> = true;
template <class T>
inline constexpr bool copied_as_bytes = std::is_trivially_copyable_v<T> || FixedSizeEigen<T>;

/// Returns the value before the first write: T{}, or zero where T{} would leave numbers uninitialised.
/// Real-time.
template <class T>
constexpr T default_value() noexcept TAPPET_REALTIME {
    if constexpr (FixedSizeEigen<T>)
        return T::Zero();
    else
        return T{};
}

} // namespace tappet
