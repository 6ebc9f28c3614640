// An array whose elements are each made from their index.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

namespace tappet {

template <std::size_t N, class Make>
constexpr auto array_of(const Make& make) {
    std::array<std::invoke_result_t<const Make&, std::size_t>, N> all{};
    for (std::size_t i = 0; i < N; ++i) all[i] = make(i);
    return all;
}

} // namespace tappet
