// What the ports of a machine say, judged by rules that hold of every machine.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <vector>

namespace tappet {

/// Not real-time. Lives as long as the run.
class SwarmPorts {
public:
    explicit SwarmPorts(const AcceptedMachine& machine);
    /// A new machine.
    void begin(MachineInstance& instance);
    /// The first rule that is broken at this moment; empty: none.
    [[nodiscard]] Sentence broken(Time now);

private:
    /// An output of which its interface says what it says while its component stands.
    struct AtRest {
        End end{};
        bool says = false;
    };
    /// A port of real numbers.
    struct Real {
        End end{};
        bool is_input = false;
        bool is_judged = false;  ///< at a border, by a driver or by limits: it is a number at every moment
        Time none_since = never; ///< it is no number
        std::uint64_t written_then = 0; ///< so often
    };
    [[nodiscard]] Sentence misleads(const AtRest& each) const;
    [[nodiscard]] Sentence is_none(Real& each, Time now) const;
    [[nodiscard]] Sentence name_of(End end) const;

    const AcceptedMachine& machine_;
    MachineInstance* instance_ = nullptr;
    std::vector<AtRest> at_rest_{};
    std::vector<Real> reals_{};
    Time next_{}; ///< look
};

} // namespace tappet
