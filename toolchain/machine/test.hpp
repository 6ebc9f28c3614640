// A test case about a machine with its plant under virtual time; tappet_machine(.. TESTS ..) of CMake names
// the cases.
#pragma once

#include TAPPET_PLANT_HEADER

#include "toolchain/machine/host.hpp"
#include "toolchain/machine/on_host.hpp"
#include "toolchain/machine/raw_wires.hpp"
#include "toolchain/machine/test_names.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

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
        raw_.look_at(run.devices());
    }
    void TearDown() override {
        run.judge_by({}); // its captures lived in the test's body
        run.stop();
    }

    /// Returns the component; a name or a type that the table lacks ends the case with the reason.
    template <class Component>
    Component& of(std::string_view component) {
        if (auto* const found = run.instance().template find<Component>(component)) return *found;
        const tappet::Sentence fault = tappet::check_component(run.instance(), component);
        const std::string why = fault.empty()
                                    ? "component \"" + std::string{component} + "\" has another type"
                                    : std::string{fault.view()};
        throw std::invalid_argument(why);
    }
    /// Returns the outermost active state of the state machine that drives the component.
    [[nodiscard]] std::string_view state_of(std::string_view component) {
        if (const auto fault = tappet::check_component(run.instance(), component); !fault.empty())
            ADD_FAILURE() << fault.view();
        return tappet::state_of(run.instance(), component);
    }
    /// Returns whether the state is active: the innermost one, or one that encloses it.
    [[nodiscard]] bool is_in(std::string_view component, std::string_view state) {
        if (const auto fault = tappet::check_state(run.instance(), component, state); !fault.empty())
            ADD_FAILURE() << fault.view();
        return tappet::is_in_state(run.instance(), component, state);
    }
    /// Runs until the state is active, at any level. Returns false after `within`, and at once when the name
    /// is wrong, which also fails the case.
    bool comes_to(std::string_view component, std::string_view state, tappet::Duration within) {
        const auto is_there = [&] { return tappet::is_in_state(run.instance(), component, state); };
        if (const auto fault = tappet::check_state(run.instance(), component, state); !fault.empty()) {
            ADD_FAILURE() << fault.view();
            return false;
        }
        return run.run_until(is_there, within);
    }

    /// Returns the data bytes of the last frame on the bus, whoever sent it, for a comparison with the
    /// device's manual: EXPECT_EQ(frame_on("press-can", can::standard(0x201)), "98 3A"). A bus that the
    /// machine lacks fails the case.
    [[nodiscard]] std::string frame_on(std::string_view bus, tappet::can::Identifier id) {
        const auto fault = tappet::check_device(run.instance(), bus, "can");
        if (!fault.empty()) ADD_FAILURE() << fault.view();
        return raw_.frame_on(bus, id);
    }
    /// Returns the words or bits of a Modbus server, written by the plant or by the machine:
    /// EXPECT_EQ(words_at("press-unit", modbus::input_registers(0, 1)), "01A4"). A server that the machine
    /// lacks fails the case.
    [[nodiscard]] std::string words_at(std::string_view server, const tappet::modbus::Run& run_of_words) {
        const auto fault = tappet::check_device(run.instance(), server, "modbus");
        if (!fault.empty()) ADD_FAILURE() << fault.view();
        return fault.empty() ? raw_.words_at(server, run_of_words) : std::string{};
    }

    Plant plant;
    tappet::VirtualRun run;

private:
    tappet::RawWires raw_;
};

} // namespace TAPPET_NAMESPACE
