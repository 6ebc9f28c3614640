// Unloads and reloads the states of a robot while it runs, as a browser does.
#pragma once

#include "kernel/machine/instance/instance.hpp"
#include "toolchain/machine/host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

namespace two_robots {

class LoadedStates {
public:
    explicit LoadedStates(tappet::VirtualRun& run) : run_{run}, slot_{*run.instance().slot_of("robot")} {}

    /// Loads a file of the application's folder; returns the refusal, empty: loaded.
    std::string load(const std::string& file) {
        std::ifstream in{SCRIPTS "/" + file};
        const std::string script{std::istreambuf_iterator<char>{in}, {}};
        EXPECT_FALSE(script.empty()) << file;
        std::ranges::copy(script, slot_.text().begin());
        const tappet::Sentence fault = slot_.compile(script.size(), file);
        if (!fault.empty()) return std::string{fault.view()};
        return change(tappet::BehaviourSlot::Change::take_over);
    }
    std::string unload() { return change(tappet::BehaviourSlot::Change::unload); }
    std::string roll_back() { return change(tappet::BehaviourSlot::Change::roll_back); }
    [[nodiscard]] const tappet::BehaviourSlot& slot() const { return slot_; }

private:
    std::string change(tappet::BehaviourSlot::Change how) {
        if (const tappet::Sentence fault = slot_.may(how); !fault.empty()) return std::string{fault.view()};
        EXPECT_TRUE(slot_.ask(how));
        EXPECT_TRUE(run_.instance().requests().post_change(slot_));
        const auto rests = [&] {
            using enum tappet::SlotPhase;
            return slot_.phase() != waiting && slot_.phase() != handing_over;
        };
        run_.run_for(tappet::Duration{std::chrono::milliseconds{4}});
        EXPECT_TRUE(run_.run_until(rests, tappet::Duration{std::chrono::seconds{1}}));
        return {};
    }

    tappet::VirtualRun& run_;
    tappet::BehaviourSlot& slot_;
};

} // namespace two_robots
