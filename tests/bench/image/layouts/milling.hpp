// A machine of one component whose newer version has other properties than the older: one of them is common.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/machine/table/machine.hpp"

namespace tappet::layouts {

struct OlderMill {
    Property<std::int64_t> depth{1};
    Property<std::int64_t> flutes{2};
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(
            property<&OlderMill::depth>("depth", "mm", "of a cut", range(0, 100)),
            property<&OlderMill::flutes>("flutes", "", "what the newer one does not know", range(1, 8)));
    }
};

struct NewerMill {
    Property<std::int64_t> depth{1};
    Property<std::int64_t> coolant{50};
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(
            property<&NewerMill::depth>("depth", "mm", "of a cut", range(0, 100)),
            property<&NewerMill::coolant>("coolant", "", "what the older one does not know", range(0, 100)));
    }
};

template <class Mill>
constexpr auto milling() {
    return machine("milling", components(component<Mill>("mill", properties_file("mill.cpf", optional))),
                   activities(activity("work", every(10ms), runs("mill"), budget(50us))), connections(),
                   reactions(), behaviours());
}

} // namespace tappet::layouts
