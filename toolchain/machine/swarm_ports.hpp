// The values at a machine's ports, judged by rules that hold for every machine.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <vector>

namespace tappet {

/// Must live as long as the run. Not real-time.
class SwarmPorts {
public:
    explicit SwarmPorts(const AcceptedMachine& machine);
    /// Starts to judge a new machine.
    void begin(MachineInstance& instance);
    /// Returns the first rule that is broken at this moment; empty: none.
    [[nodiscard]] Sentence broken(Time now);

private:
    /// An output whose value at standstill its interface states.
    struct AtRest {
        End end{};
        bool says = false;
    };
    /// A port of real numbers.
    struct Real {
        End end{};
        bool is_input = false;
        bool is_judged = false;         ///< at a border, by a driver or by limits: it is always a number
        Time none_since = never;        ///< since when it is not a number
        std::uint64_t written_then = 0; ///< number of writes at that time
    };
    [[nodiscard]] Sentence misleads(const AtRest& each) const;
    [[nodiscard]] Sentence is_none(Real& each, Time now) const;
    [[nodiscard]] Sentence name_of(End end) const;

    const AcceptedMachine& machine_;
    MachineInstance* instance_ = nullptr;
    std::vector<AtRest> at_rest_{};
    std::vector<Real> reals_{};
    Time next_{}; ///< time of the next look
};

} // namespace tappet
