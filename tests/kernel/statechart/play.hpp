// A state machine written as a few lines of text, whose programs write down what they do: "+a" at once;
// "+a.." waits in two steps, "+a:" is its beginning and ":+a" its end; "+a!" fails. A condition is written
// down as "?g"; it holds while its name is in `yes`, and fails while it is in `broken`. Where the text has no
// final state, there is one by the name of "safe".
//
//     state a initial in x region r entry +a.. exit -a run !a handle ~a pre g       | state end final
//     from a to b on go takes if g then *go.. else *no otherwise c                  | to -: internal
//     from a to b after 10 shallow                                                  | milliseconds; or deep
#pragma once

#include "kernel/statechart/execution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace tappet {

class Play {
public:
    std::set<std::string, std::less<>> yes;
    std::set<std::string, std::less<>> broken;
    StateMachineExecution execution;
    StateMachinePolicy policy;
    Time now = at_ns(1000);

    explicit Play(const std::string& text) {
        std::istringstream lines{text};
        for (std::string line; std::getline(lines, line);) read(line);
        if (std::ranges::none_of(states_, &StateRow::final)) read("state safe final");
        for (std::size_t i = 0; i < programs_.size(); ++i)
            program_rows_.push_back(
                {programs_[i], static_cast<NodeIndex>(i * 16), static_cast<NodeIndex>(i * 16 + 16), true});
        tables_.programs = program_rows_;
        EXPECT_EQ(room_.load(table()).view(), "") << text;
        bind();
    }
    Play(const Play&) = delete;
    Play& operator=(const Play&) = delete;

    void bind(StateMachineExecution* parent = nullptr) {
        StateMachineBinding binding;
        binding.machine = room_.view();
        binding.component = this;
        binding.code = {&tables_, &run, &test, &wakes};
        binding.data = data_;
        binding.history = history_;
        binding.deferred = deferred_;
        binding.parent = parent;
        binding.policy = policy;
        EXPECT_TRUE(execution.bind(binding));
    }
    [[nodiscard]] StateMachineTable table() const {
        return {"play", states_, transitions_, nullptr, &tables_, captures_};
    }
    /// The notes since the last call.
    std::string heard() { return std::exchange(log_, {}); }
    std::string start() {
        execution.start(now);
        return heard();
    }
    std::string step(Duration later = 1ms) {
        now += later;
        execution.step(now);
        return heard();
    }
    std::string once() {
        execution.step_once(now);
        return heard();
    }
    StateOutcome dispatch(std::string_view event, int argument = 0) {
        const auto names = execution.machine().triggers;
        std::byte packed[sizeof argument];
        std::memcpy(packed, &argument, sizeof argument);
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == event) return execution.dispatch(i, now, packed);
        ADD_FAILURE() << "no trigger " << event;
        return StateOutcome::ignored;
    }
    std::string send(std::string_view event, int argument = 0) {
        outcome = dispatch(event, argument);
        return heard();
    }
    std::string request(std::string_view state, bool run_once = false) {
        outcome = execution.request_state(find_state(table(), state), now, run_once);
        return heard();
    }
    std::string stop() {
        outcome = execution.request_final(now, "stopped");
        return heard();
    }
    std::string deactivate() {
        outcome = execution.deactivate(now);
        return heard();
    }
    /// "x(a b)": the active states, those inside in brackets.
    [[nodiscard]] std::string active() const {
        std::string text;
        std::size_t depth = 0;
        for (const ActiveState& each : execution.states()) {
            const std::size_t level = execution.machine().plans[each.state].depth;
            for (; depth > level; --depth) text.append(")");
            if (!text.empty()) text.append(level > depth ? "(" : " ");
            text.append(execution.machine().table.states[each.state].name);
            depth = level;
        }
        for (; depth > 1; --depth) text.append(")");
        return text;
    }
    [[nodiscard]] std::string_view name(StateIndex state) const {
        return state == no_state ? "none" : states_[state].name;
    }
    [[nodiscard]] int argument() const {
        int value = 0;
        std::memcpy(&value, data_, sizeof value);
        return value;
    }
    void say(std::string_view what) {
        if (!log_.empty()) log_.push_back(' ');
        log_.append(what);
    }
    /// Called by each program with its text.
    std::function<void(std::string_view)> act;
    StateOutcome outcome = StateOutcome::ignored;

private:
    std::string_view keep(const std::string& text) { return texts_.emplace_back(text); }
    ProgramRef program(const std::string& text) {
        programs_.push_back(keep(text));
        return ProgramRef{static_cast<ProgramIndex>(programs_.size() - 1)};
    }
    ConditionRef condition(const std::string& text) {
        conditions_.push_back(keep(text));
        return ConditionRef{static_cast<ConditionIndex>(conditions_.size() - 1)};
    }
    void read(const std::string& line) {
        std::istringstream words{line};
        std::string word, next;
        if (!(words >> word)) return;
        if (word == "state") {
            StateRow row;
            words >> next;
            row.name = keep(next);
            while (words >> word) {
                if (word == "initial" || word == "final") {
                    (word == "final" ? row.final : row.initial) = true;
                    continue;
                }
                words >> next;
                if (word == "in") row.parent = keep(next);
                if (word == "region") row.region = keep(next);
                if (word == "pre") row.precondition = condition(next);
                if (word == "entry") row.entry = program(next);
                if (word == "exit") row.exit = program(next);
                if (word == "run") row.run = program(next);
                if (word == "handle") row.handle = program(next);
            }
            states_.push_back(row);
            return;
        }
        TransitionRow row;
        std::string to;
        words >> next >> word >> to;
        row.from = keep(next);
        if (to != "-") row.to = keep(to);
        while (words >> word) {
            if (word == "takes") {
                row.first_capture = static_cast<std::uint16_t>(captures_.size());
                row.captures = 1;
                captures_.push_back({0, sizeof(int), 0, 0, 0});
                continue;
            }
            if (word == "shallow" || word == "deep") {
                row.enters = word == "deep" ? EntryKind::deep_history : EntryKind::shallow_history;
                continue;
            }
            words >> next;
            if (word == "on") row.on_event = true, row.event = keep(next);
            if (word == "after") row.timed = true, row.after = std::stoi(next) * 1ms;
            if (word == "if") row.guard = condition(next);
            if (word == "then") row.then = program(next);
            if (word == "because") row.because = keep(next);
            if (word == "else") row.has_otherwise = true, row.otherwise = program(next);
            if (word == "otherwise") row.has_otherwise = true, row.otherwise_to = keep(next);
        }
        transitions_.push_back(row);
    }

    ProgramReturn advance(ProgramContext& context, std::uint32_t& statements) {
        if (statements == 0) return ProgramReturn::left_over;
        const std::string_view text = programs_[context.position.node / 16u];
        const std::size_t stage = context.position.node % 16u,
                          waits = text.size() - text.find_last_not_of('.') - 1;
        const std::string word{text.substr(0, text.size() - waits)};
        if (stage == 0 || stage == waits) --statements;
        if (stage == 0) say(waits == 0 ? word : word + ":");
        if (stage == 0 && act) act(word);
        if (stage < waits) {
            ++context.position.node;
            return ProgramReturn::waits;
        }
        if (word.ends_with('!') && !yes.contains(word)) return ProgramReturn::failed;
        if (waits != 0) say(":" + word);
        context.position.node = end_node;
        return ProgramReturn::ended;
    }
    ConditionResult answer(ConditionIndex number) {
        const std::string_view text = conditions_[number];
        say("?" + std::string{text});
        if (broken.contains(text)) return ConditionResult::failed;
        return yes.contains(text) ? ConditionResult::yes : ConditionResult::no;
    }
    static ProgramReturn run(const ProgramTables&, ProgramContext& context,
                             std::uint32_t& statements) noexcept TAPPET_REALTIME {
        ProgramReturn result = ProgramReturn::failed;
        TAPPET_ESCAPE("a test's log grows",
                      result = static_cast<Play*>(context.component)->advance(context, statements));
        return result;
    }
    static ConditionResult test(const ProgramTables&, ProgramContext& context, ConditionIndex number) noexcept
        TAPPET_REALTIME {
        ConditionResult result = ConditionResult::failed;
        TAPPET_ESCAPE("a test's log grows", result = static_cast<Play*>(context.component)->answer(number));
        return result;
    }
    static Time wakes(const ProgramTables&, const ProgramContext& context) noexcept TAPPET_REALTIME {
        return at_ns(context.position.node);
    }

    std::deque<std::string> texts_;
    std::vector<std::string_view> programs_, conditions_;
    std::vector<StateRow> states_;
    std::vector<TransitionRow> transitions_;
    std::vector<CaptureRow> captures_;
    std::vector<ProgramRow> program_rows_;
    ProgramTables tables_;
    ResolvedMachine<ResolvedSizes{24, 8, 60, 400, 900, 24}> room_;
    alignas(data_alignment) std::byte data_[data_alignment]{};
    std::array<StateIndex, 24> history_{};
    std::array<std::byte, 8 * sizeof(int)> deferred_{};
    std::string log_;
};

struct Started : Play {
    explicit Started(const std::string& text) : Play{text} { start(); }
};

} // namespace tappet
