// What components of tests are made of.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <array>

namespace tappet {

/// Knows the time, and can take some.
struct Clocked {
    os::Clock* clock = nullptr;
    Sentence configure(Setup& setup) {
        clock = setup.clock;
        return {};
    }
};

/// Sees the machine, whatever it does with it.
struct Onlooker {
    static constexpr bool sees_machine = true;
    MachineInstance* machine = nullptr;
    Sentence configure(Setup& setup) {
        machine = setup.machine;
        return {};
    }
    void work(const Cycle&) {}
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

} // namespace tappet
