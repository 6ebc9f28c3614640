// A machine's own part of its swarm: its SWARM header passes to tappet_machine() of CMake what must never
// happen, when the machine works, and the faults of its plant.
#pragma once

#include "drivers/plant/plant.hpp"
#include "kernel/base/random.hpp"
#include "kernel/machine/instance/instance.hpp"

#include <span>
#include <vector>

namespace tappet {

/// A script for a slot of the machine.
struct SwarmScript {
    std::string_view slot{}, name{}, text{};
    bool compiles = true; ///< else its load must be refused
};
/// Actions of people at browsers under which every rule must still hold; beside reading, saving, and the
/// operations that the interfaces offer to operators.
struct SwarmPeople {
    std::span<const std::string_view> properties{}; ///< may be set to anything in their ranges
    std::span<const std::string_view> ports{};      ///< may be forced to anything
    std::span<const SwarmScript> scripts{};
};

/// Knows what the swarm has struck, so that a rule demands only what intact parts can do.
class Struck {
public:
    explicit Struck(std::size_t components) : faults_(components), whole_since_(components) {}
    /// Returns how long a component, its activity and its device have been intact. Negative: a fault is
    /// present, or it does not run. The component is a number: see find_component().
    [[nodiscard]] Duration whole_for(std::size_t component, Time now) const {
        return faults_[component] != 0 ? Duration{-1} : now - whole_since_[component];
    }
    /// Records that a fault begins, or ends.
    void begin(std::size_t component) { ++faults_[component]; }
    void end(std::size_t component, Time now) {
        --faults_[component];
        whole_since_[component] = now;
    }

private:
    std::vector<unsigned> faults_;
    std::vector<Time> whole_since_;
};

/// The rules of one life of a machine: created after its start, destroyed after its stop. Not real-time.
///     struct Swarm final : SwarmRules {
///         Swarm(MachineInstance& machine, Plant& plant, const Struck& struck);
///         std::string_view broken(Time) override {
///             return valve() && !bottle() ? "the valve is open without a bottle" : "";
///         }
///         bool works() override { return plant.filled() > filled_before; }
///     };
class SwarmRules {
public:
    SwarmRules() = default;
    SwarmRules(const SwarmRules&) = delete;
    SwarmRules& operator=(const SwarmRules&) = delete;
    virtual ~SwarmRules() = default;

    /// Called at every moment at which machine or plant have moved. Returns the broken rule; empty: none.
    [[nodiscard]] virtual std::string_view broken(Time now) = 0;
    /// Returns whether the machine fulfils its purpose.
    [[nodiscard]] virtual bool works() = 0;
    /// After this time without faults the machine must work again, or say why not.
    [[nodiscard]] virtual Duration works_within() const { return 30s; }
    /// Returns what the machine itself says it waits for; empty: it says nothing.
    [[nodiscard]] virtual std::string_view waits_for() { return {}; }
    /// Injects a fault of the plant for at most `lasts`. Returns its description; empty: there is none.
    virtual Sentence trouble(Random&, Duration /*lasts*/) { return {}; }
    [[nodiscard]] virtual SwarmPeople people() const { return {}; }
};

} // namespace tappet
