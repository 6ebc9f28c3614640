// The identity and the name of a type, as plain data: two ends of a row fit when their tags are the same
// object.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>

namespace tappet {

struct TypeTag;
using TypeId = const TypeTag*;
struct TypeTag {
    std::string_view name{};
    std::size_t size = 0;
    std::size_t align = 0;
    bool arithmetic = false;
    std::span<const TypeId> elements{}; ///< of an argument list
};

/// The argument list of an event or an operation, as a type.
template <class... Types>
struct Arguments {};

namespace detail {

// Both compilers print the template argument after "T = "; what stands around it is cut off here.
template <class T>
consteval std::string_view printed_name() {
    constexpr std::string_view whole = __PRETTY_FUNCTION__;
    constexpr std::size_t begin = whole.find("T = ") + 4;
    constexpr std::size_t end = whole.find_first_of(";]", begin);
    return whole.substr(begin, end - begin);
}

template <class... T>
consteval std::string_view printed_list() {
    constexpr std::string_view whole = __PRETTY_FUNCTION__;
    constexpr std::size_t begin = whole.find("T = ") + 5;
#if defined(__clang__)
    constexpr std::size_t end = whole.rfind('>'); // "<double, int>"
#else
    constexpr std::size_t end = whole.find('}', begin); // "{double, int}"
#endif
    return whole.substr(begin, end - begin);
}

template <class T>
struct TagOf {
    static constexpr TypeTag tag{printed_name<T>(), sizeof(T), alignof(T), std::is_arithmetic_v<T>};
};
template <class... T>
struct TagOf<Arguments<T...>> {
    static constexpr std::array<TypeId, sizeof...(T)> elements{&TagOf<T>::tag...};
    static constexpr TypeTag tag{printed_list<T...>(), (std::size_t{0} + ... + sizeof(T)), 1, false,
                                 elements};
};
template <>
struct TagOf<Arguments<>> {
    static constexpr TypeTag tag{"", 0, 1, false};
};

} // namespace detail

template <class T>
inline constexpr TypeId type_id = &detail::TagOf<T>::tag;

} // namespace tappet
