// What only one machine's swarm knows, as its SWARM header gives it to tappet_machine() of CMake: what must
// never be so, when the machine works, and what goes wrong with its plant.
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
    bool compiles = true; ///< else its load is to be refused
};
/// What people at browsers may do to the machine though every rule holds: beside reading, saving and what its
/// interfaces have for operators.
struct SwarmPeople {
    std::span<const std::string_view> properties{}; ///< are set to anything in their ranges
    std::span<const std::string_view> ports{};      ///< are forced to anything
    std::span<const SwarmScript> scripts{};
};

/// What the swarm has struck, so that a rule asks for no more than whole parts can do.
class Struck {
public:
    explicit Struck(std::size_t components) : faults_(components), whole_since_(components) {}
    /// How long nothing has been wrong with a component, its activity and its device. Negative: something is,
    /// or it does not run. The component by its number: find_component().
    [[nodiscard]] Duration whole_for(std::size_t component, Time now) const {
        return faults_[component] != 0 ? Duration{-1} : now - whole_since_[component];
    }
    /// A fault begins, or ends.
    void begin(std::size_t component) { ++faults_[component]; }
    void end(std::size_t component, Time now) {
        --faults_[component];
        whole_since_[component] = now;
    }

private:
    std::vector<unsigned> faults_;
    std::vector<Time> whole_since_;
};

/// Of one life of a machine: made when it has started, gone when it stands. Not real-time.
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

    /// Asked at every moment at which machine or plant have moved: what is so and must not be; empty:
    /// nothing.
    [[nodiscard]] virtual std::string_view broken(Time now) = 0;
    /// It does what it is for.
    [[nodiscard]] virtual bool works() = 0;
    /// So long after the last fault it works again, or says why not.
    [[nodiscard]] virtual Duration works_within() const { return 30s; }
    /// What the machine itself says that it waits for; empty: it says nothing.
    [[nodiscard]] virtual std::string_view waits_for() { return {}; }
    /// Something goes wrong with the plant for `lasts` at most: what; empty: it has no faults of its own.
    virtual Sentence trouble(Random&, Duration /*lasts*/) { return {}; }
    [[nodiscard]] virtual SwarmPeople people() const { return {}; }
};

} // namespace tappet
