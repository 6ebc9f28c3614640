// Facets of ports and events that are elements of an array, one for each row of a map:
//     std::array<Output<bool>, count> level{};
//     nth_output<&LinePort::level>(i, name_of(i), "", "the line's level", as_it_was)
#pragma once

#include "kernel/component/interface.hpp"

namespace tappet {

namespace detail {
template <class Each>
struct OneOf {
    Each each;
};
template <auto Members>
struct Several;
template <class C, class M, M C::* Members>
struct Several<Members> {
    using One = OneOf<typename M::value_type>;
    static constexpr Facet nth(Facet of_one, std::size_t index) noexcept {
        of_one.index = index;
        of_one.at = [](void* component, std::size_t i) noexcept -> void* {
            return &(static_cast<C*>(component)->*Members)[i];
        };
        return of_one;
    }
};
} // namespace detail

template <auto Members, class... Said>
constexpr Facet nth_input(std::size_t index, const Said&... said) {
    using All = detail::Several<Members>;
    return All::nth(input<&All::One::each>(said...), index);
}
template <auto Members, class... Said>
constexpr Facet nth_output(std::size_t index, const Said&... said) {
    using All = detail::Several<Members>;
    return All::nth(output<&All::One::each>(said...), index);
}
template <auto Members, class... Said>
constexpr Facet nth_event(std::size_t index, const Said&... said) {
    using All = detail::Several<Members>;
    return All::nth(event<&All::One::each>(said...), index);
}

} // namespace tappet
