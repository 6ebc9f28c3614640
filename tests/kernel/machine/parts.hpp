// Parts of test components.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <array>
#include <vector>

namespace tappet {

/// Knows the time and can use some of it.
struct Clocked {
    os::Clock* clock = nullptr;
    Sentence configure(Setup& setup) {
        clock = setup.clock;
        return {};
    }
};

/// The record that a component keeps for its test.
template <class T> struct Notes : std::vector<T> {
    void add(T each) noexcept TAPPET_REALTIME { TAPPET_ESCAPE("a test's memory", this->push_back(each)); }
};

/// Sees the machine; the test decides what it does with it.
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
