// A test case about a machine with its plant under virtual time; tappet_machine(.. TESTS ..) of CMake names
// the cases.
#pragma once

#include TAPPET_PLANT_HEADER

#include "toolchain/machine/host.hpp"
#include "toolchain/machine/on_host.hpp"

#include <gtest/gtest.h>

namespace TAPPET_NAMESPACE {

/// Starts the machine for each case, and stops it afterwards:
///     TEST_F(MachineTest, fills_ten_bottles) {
///         run.run_for(10s);
///         EXPECT_EQ(plant.bottles, 10);
///     }
struct MachineTest : testing::Test {
    explicit MachineTest(std::uint64_t seed = 1) : plant{seed}, run{on_host(), plant, seed} {}
    void SetUp() override {
        const auto started = run.start();
        ASSERT_TRUE(started) << started.error().view();
    }
    void TearDown() override {
        run.judge_by({}); // its captures lived in the test's body
        run.stop();
    }

    template <class Component>
    Component& of(std::string_view component) {
        return *run.instance().template find<Component>(component);
    }
    [[nodiscard]] std::string_view state_of(std::string_view component) {
        return tappet::state_of(run.instance(), component);
    }
    bool comes_to(std::string_view component, std::string_view state, tappet::Duration within) {
        return run.run_until([&] { return state_of(component) == state; }, within);
    }

    Plant plant;
    tappet::VirtualRun run;
};

} // namespace TAPPET_NAMESPACE
