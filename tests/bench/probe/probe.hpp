// A component that does one forbidden thing, once, some time after its machine has started.
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/component/component.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tappet::probe {

enum class Fault : std::uint8_t { nothing, allocate, map, touch, overrun, break_contract, crash, hang };
inline constexpr std::array<std::string_view, 8> fault_names{"nothing", "allocate",       "map",   "touch",
                                                             "overrun", "break-contract", "crash", "hang"};

/// Forbidden actions need the operating system, or calls that the compiler would refuse: they are in
/// faults.cpp.
void commit(Fault fault) noexcept;

/// Reports that it left its safe value, so that a test sees it.
struct Culprit {
    Property<std::int64_t> after_cycles{100};
    Output<std::int64_t> cycles;
    Fault fault = Fault::nothing; ///< before the machine is armed
    bool left_safe = false;

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        cycles.write(cycles.last() + 1);
        if (cycles.last() != after_cycles.get()) return;
        TAPPET_ESCAPE("the probe's purpose is to do what must not be done", commit(fault));
        TAPPET_CONTRACT(fault != Fault::break_contract, Contract::index_out_of_range, 7, 3);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { left_safe = true; }

    static constexpr auto interface() {
        return facets(output<&Culprit::cycles>("cycles", "", "so far"),
                      property<&Culprit::after_cycles>("after_cycles", "", "cycles before the fault",
                                                       range(1, 1'000'000)));
    }
};

/// Runs in the same activity and must never be blamed.
struct Bystander {
    Property<std::int64_t> unused{0};
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(property<&Bystander::unused>("unused", "", "a component has a facet", range(0, 0)));
    }
};

} // namespace tappet::probe
