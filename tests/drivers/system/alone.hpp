// A machine of one component in one activity.
#pragma once

#include "kernel/machine/table/machine.hpp"

namespace tappet::test {

/// The component has the machine's name.
template <class Component, class... Options>
constexpr auto alone(std::string_view name, std::string_view activity_name, const Options&... options) {
    return machine(name, components(component<Component>(name)),
                   activities(activity(activity_name, runs(name), options...)), connections(), reactions(),
                   behaviours());
}

} // namespace tappet::test
