// The swarm of the loom finds faults: each row that keeps the loom safe is removed in turn, and some seed
// then breaks a rule.
#include "apps/carpet_loom/swarm.hpp"
#include "toolchain/machine/swarm.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <vector>

namespace tappet::carpet {

AcceptedMachine on_host();

namespace {

SwarmOf swarm_of(const AcceptedMachine& machine) {
    return {
        machine,
        [](std::uint64_t seed) -> std::unique_ptr<tappet::Plant> { return std::make_unique<Plant>(seed); },
        [](MachineInstance& instance, tappet::Plant& plant,
           const Struck& struck) -> std::unique_ptr<SwarmRules> {
            return std::make_unique<Swarm>(instance, static_cast<Plant&>(plant), struck);
        }};
}

/// A missing row of the table's reactions.
struct Hazard {
    const char* event;
    const char* operation;
    std::uint64_t seed; ///< start of the search: most earlier seeds do not find it
};
void PrintTo(const Hazard& hazard, std::ostream* out) { *out << hazard.event << " -> " << hazard.operation; }

std::string name_of(const AcceptedMachine& machine, End end) {
    const ComponentRow& row = machine.table.components[end.component];
    return std::string{row.name} + "." + std::string{row.type->facets[end.facet].name};
}

class Planted : public testing::TestWithParam<Hazard> {};
INSTANTIATE_TEST_SUITE_P(hazard, Planted,
                         testing::Values(Hazard{"loom.inhibit_weft", "weft.inhibit", 2},
                                         Hazard{"loom.set_brake", "io.brake.set", 1},
                                         Hazard{"loom.quick_stop", "main.quick_stop", 2},
                                         Hazard{"shaft.rests", "weft.on_rest", 1},
                                         Hazard{"logic_dog.silent", "last_resort.act", 7},
                                         Hazard{"loom.release_brake", "io.brake.clear", 1},
                                         Hazard{"shaft.brake_now", "weft.hold", 30}));

TEST_P(Planted, is_found_by_a_seed) {
    AcceptedMachine machine = on_host();
    std::vector<Subscription> rows(machine.plan.subscriptions.begin(), machine.plan.subscriptions.end());
    std::size_t taken_out = 0;
    for (Subscription& row : rows)
        if (row.kind == SubscriberKind::operation && name_of(machine, row.event) == GetParam().event &&
            name_of(machine, row.target) == GetParam().operation) {
            row.is_connected = false;
            ++taken_out;
        }
    ASSERT_EQ(taken_out, 1u);
    machine.plan.subscriptions = rows;
    const SwarmOf of = swarm_of(machine);
    Sentence broken;
    std::uint64_t seed = GetParam().seed - 1;
    while (broken.empty() && seed < GetParam().seed + 60) broken = SwarmRun{of, ++seed}.go().broken;
    EXPECT_FALSE(broken.empty());
    std::cout << "seed " << seed << ": " << broken.view() << "\n";
}

TEST(Swarm, repeats_its_run_for_the_same_seed) {
    const SwarmOf of = swarm_of(on_host());
    std::vector<std::string> told[2];
    for (auto& each : told)
        static_cast<void>(SwarmRun{
            of, 3, [&each](Time at, std::string_view text) {
                each.push_back(std::to_string(to_ns(at)) + " " + std::string{text});
            }}.go());
    EXPECT_EQ(told[0], told[1]);
    EXPECT_GT(told[0].size(), 20u);
}

} // namespace
} // namespace tappet::carpet
