// What components of tests are made of.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <array>
#include <vector>

namespace tappet {

/// Knows the time, and can take some.
struct Clocked {
    os::Clock* clock = nullptr;
    Sentence configure(Setup& setup) {
        clock = setup.clock;
        return {};
    }
};

/// What a component remembers for its test.
template <class T> struct Notes : std::vector<T> {
    void add(T each) noexcept TAPPET_REALTIME { TAPPET_ESCAPE("a test's memory", this->push_back(each)); }
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
