// A component whose state programs record their runs: "+a" entry, "-a" exit, "!a" run, "*a" transition
// program; and an executing machine of it.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/text.hpp"
#include "kernel/statechart/execution.hpp"
#include "kernel/statechart/rows.hpp"

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>
#include <string>
#include <string_view>

namespace tappet {

struct Recorder {
    Bounded<char, 4096> characters;
    bool yes = false;

    template <text what> void say() noexcept TAPPET_REALTIME {
        if (!characters.empty()) static_cast<void>(characters.push(' '));
        for (char character : what.view()) static_cast<void>(characters.push(character));
    }
    bool if_yes() const noexcept TAPPET_REALTIME { return yes; }

    /// The notes since the last call.
    std::string heard() {
        const std::string text{characters.begin(), characters.end()};
        characters.clear();
        return text;
    }
};

/// A machine that is not started yet.
template <const auto& machine> struct Bound {
    Recorder component;
    StateMachineExecution execution;
    std::array<StateIndex, 8> history{};
    Time now = at_ns(1000);
    StateOutcome outcome = StateOutcome::ignored; ///< outcome of the last send

    Bound() {
        StateMachineBinding binding;
        binding.machine = resolved<machine>.view();
        binding.component = &component;
        binding.history = history;
        EXPECT_TRUE(execution.bind(binding));
    }
    StateOutcome dispatch(std::string_view event) {
        const auto names = execution.machine().triggers;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == event) return execution.dispatch(i, now);
        ADD_FAILURE() << "no trigger " << event;
        return StateOutcome::ignored;
    }
    std::string send(std::string_view event) {
        outcome = dispatch(event);
        return component.heard();
    }
    std::string step(Duration later = 1ms) {
        now += later;
        execution.step(now);
        return component.heard();
    }
    std::string once() {
        execution.step_once(now);
        return component.heard();
    }
    std::string path() {
        std::string text;
        for (std::string_view name : execution.path()) text.append(text.empty() ? "" : "/").append(name);
        return text;
    }
};

/// A machine that was started and received the events.
template <const auto& machine> struct Running : Bound<machine> {
    explicit Running(std::initializer_list<std::string_view> events = {}) {
        this->execution.start(this->now);
        for (const std::string_view event : events) this->dispatch(event);
        this->component.heard();
    }
};

} // namespace tappet
