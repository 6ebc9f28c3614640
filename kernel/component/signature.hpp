// The parameters of methods and commands as plain data: arguments, results, and how both are packed one after
// the other.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/type_tag.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace tappet {

/// A result in a signature's name: the T of a parameter `T&`.
template <class T>
struct Result {
    T value;
};

namespace detail {

/// A parameter by value or by const reference is an argument, one by reference is a result.
template <class P>
struct Parameter {
    using Value = std::remove_cvref_t<P>;
    static constexpr bool is_result =
        std::is_lvalue_reference_v<P> && !std::is_const_v<std::remove_reference_t<P>>;
    static_assert(!std::is_rvalue_reference_v<P>,
                  "a parameter is taken by value or by const reference; T& is a result");
    static_assert(std::is_trivially_copyable_v<Value>,
                  "what is handed to another component is copied byte by byte");
    using InName = std::conditional_t<is_result, Result<Value>, Value>;
};

template <class List, class... P>
struct PackList {
    using Type = List;
};
template <class... L, class First, class... Rest>
struct PackList<Arguments<L...>, First, Rest...> : PackList<Arguments<L..., First>, Rest...> {};

template <bool results, class List, class... P>
struct Select {
    using Type = List;
};
template <bool results, class... L, class First, class... Rest>
struct Select<results, Arguments<L...>, First, Rest...>
    : Select<results,
             std::conditional_t<Parameter<First>::is_result == results,
                                Arguments<L..., typename Parameter<First>::Value>, Arguments<L...>>,
             Rest...> {};

template <class>
inline constexpr std::size_t list_bytes = 0;
template <class... T>
inline constexpr std::size_t list_bytes<Arguments<T...>> = (std::size_t{0} + ... + sizeof(T));

/// The offsets of a parameter list in packed bytes: arguments first, results after them.
template <class... P>
struct Packing {
    using Inputs = typename Select<false, Arguments<>, P...>::Type;
    using Results = typename Select<true, Arguments<>, P...>::Type;
    static constexpr std::size_t count = sizeof...(P);
    static constexpr std::size_t input_bytes = list_bytes<Inputs>;
    static constexpr std::size_t result_bytes = list_bytes<Results>;
    static constexpr std::size_t bytes = input_bytes + result_bytes;

    /// Offset of each parameter.
    static constexpr std::array<std::size_t, sizeof...(P) + 1> offsets = [] {
        std::array<std::size_t, sizeof...(P) + 1> at{};
        const std::array<std::size_t, sizeof...(P) + 1> sizes{sizeof(typename Parameter<P>::Value)..., 0};
        const std::array<bool, sizeof...(P) + 1> out{Parameter<P>::is_result..., false};
        std::size_t input = 0;
        std::size_t result = input_bytes;
        for (std::size_t i = 0; i < sizeof...(P); ++i) {
            at[i] = out[i] ? result : input;
            (out[i] ? result : input) += sizes[i];
        }
        return at;
    }();
};

template <class T>
T load_packed(const std::byte* from) noexcept TAPPET_REALTIME {
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
}
template <class T>
void store_packed(std::byte* into, const T& value) noexcept TAPPET_REALTIME {
    std::memcpy(into, &value, sizeof(T));
}

/// A parameter read from packed bytes, and written back if it is a result.
template <class P>
struct Unpacked {
    using Value = typename Parameter<P>::Value;
    Value value;
    std::byte* at;
    explicit Unpacked(std::byte* from) noexcept TAPPET_REALTIME : value{load_packed<Value>(from)}, at{from} {}
    void put_back() const noexcept TAPPET_REALTIME {
        if constexpr (Parameter<P>::is_result) store_packed(at, value);
    }
};

} // namespace detail

} // namespace tappet
