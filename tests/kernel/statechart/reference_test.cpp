// Thousands of random machines under random events, steps and requests: the resolved
// form and an interpreter that walks the hierarchy by names do the same, program by
// program and guard by guard. TAPPET_SEED chooses other machines.
#include "tests/kernel/statechart/reference.hpp"

#include "kernel/base/random.hpp"
#include "kernel/statechart/execution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace tappet {
namespace {

constexpr std::size_t program_count = 160;
constexpr std::size_t guard_count = 12;
constexpr std::string_view state_names[] = {"s0",  "s1",  "s2",  "s3",  "s4",  "s5",  "s6",
                                            "s7",  "s8",  "s9",  "s10", "s11", "s12", "s13",
                                            "s14", "s15", "s16", "s17", "s18", "s19"};
constexpr std::string_view event_names[] = {"go", "stop", "panel.start", "panel.emergency", "weft.break"};
constexpr std::string_view reasons[] = {"weft break", "warp break", "operator"};
static_assert(std::size(state_names) * 3 + 48 <= program_count,
              "each program of a machine has its own number");

/// What a program does besides being written down.
enum class Deed : std::uint8_t { nothing, raise, give_up };

/// The component of either side: what ran, and how its programs reach their machine.
struct Log {
    std::vector<int> calls;
    std::uint32_t yes = 0; // answers of the guards
    const std::array<Deed, program_count>* deeds = nullptr;
    void* machine = nullptr;
    void (*raise)(void* machine, std::string_view event, Time now) = nullptr;
    void (*give_up)(void* machine, Time now) = nullptr;
    Time now{};

    void run(std::size_t program) {
        calls.push_back(static_cast<int>(program));
        if ((*deeds)[program] == Deed::raise)
            raise(machine, event_names[program % std::size(event_names)], now);
        if ((*deeds)[program] == Deed::give_up) give_up(machine, now);
    }
    bool ask(std::size_t guard) {
        calls.push_back(-1 - static_cast<int>(guard));
        return (yes >> guard & 1u) != 0;
    }
};

template <std::size_t i> void program(void* log) noexcept TAPPET_REALTIME {
    TAPPET_ESCAPE("a test's log grows", static_cast<Log*>(log)->run(i));
}
template <std::size_t i> bool guard_of(void* log) noexcept TAPPET_REALTIME {
    bool answer = false;
    TAPPET_ESCAPE("a test's log grows", answer = static_cast<Log*>(log)->ask(i));
    return answer;
}
template <std::size_t... i>
constexpr std::array<StateProgram, sizeof...(i)> all_programs(std::index_sequence<i...>) {
    return {&program<i>...};
}
template <std::size_t... i>
constexpr std::array<StateGuard, sizeof...(i)> all_guards(std::index_sequence<i...>) {
    return {&guard_of<i>...};
}
constexpr auto programs = all_programs(std::make_index_sequence<program_count>{});
constexpr auto guards = all_guards(std::make_index_sequence<guard_count>{});

struct RandomMachine {
    std::vector<StateRow> states;
    std::vector<TransitionRow> transitions;
    std::array<Deed, program_count> deeds{};

    [[nodiscard]] StateMachineTable view() const { return {"random", states, transitions, nullptr}; }

    explicit RandomMachine(Random& random) {
        const auto count = static_cast<std::size_t>(random.between(2, std::size(state_names)));
        for (std::size_t i = 0; i < count; ++i) {
            StateRow row{.name = state_names[i]};
            row.final = i == 0;
            if (i > 1 && !random.one_in(3))
                row.parent = state_names[static_cast<std::size_t>(
                    random.between(1, static_cast<std::int64_t>(i) - 1))];
            if (!random.one_in(4)) row.entry = programs[3 * i];
            if (!random.one_in(4)) row.exit = programs[3 * i + 1];
            if (!random.one_in(3)) row.run = programs[3 * i + 2];
            // One initial state in each composite: the first, or the one that draws it later.
            StateRow* first = nullptr;
            for (StateRow& other : states)
                if (other.parent == row.parent && other.initial) first = &other;
            row.initial = i > 0 && (first == nullptr || random.one_in(3));
            if (row.initial && first != nullptr) first->initial = false;
            states.push_back(row);
        }
        for (std::size_t i = count; i > 1; --i) std::swap(states[i - 1], states[random.below(i)]);
        for (std::size_t i = 0; i < count; ++i)
            add(random, states[i].name); // each has a way out, most of the time
        while (transitions.size() < 48 && !random.one_in(20)) add(random, states[random.below(count)].name);
        for (Deed& deed : deeds) {
            if (random.one_in(12)) deed = Deed::raise;
            if (random.one_in(60)) deed = Deed::give_up;
        }
    }

private:
    void add(Random& random, std::string_view from) {
        TransitionRow row{.from = from, .to = states[random.below(states.size())].name};
        const std::uint64_t kind = random.below(8);
        const bool has_guard = !random.one_in(3);
        if (has_guard) row.guard = guards[random.below(guard_count)];
        if (kind < 5) {
            row.on_event = true;
            row.event = event_names[random.below(std::size(event_names))];
        } else if (kind < 7) {
            row.timed = true;
            row.after = Duration{random.between(1, 60)};
        } else if (!has_guard)
            row.guard = guards[0];
        const bool has_program = !random.one_in(3);
        if (has_program) row.then = programs[3 * std::size(state_names) + transitions.size()];
        if (row.on_event && has_program && random.one_in(8)) row.to = {};
        if (random.one_in(4)) row.because = reasons[random.below(std::size(reasons))];
        transitions.push_back(row);
    }
};

using Slot = ResolvedMachine<ResolvedSizes{20, 5, 2048, 16384, 20}>;

struct Pair {
    Log real_log;
    Log reference_log;
    StateMachineExecution real;
    ReferenceMachine reference;

    Pair(const RandomMachine& machine, const Slot& slot) : reference{machine.view(), &reference_log} {
        real.bind(slot.view(), &real_log);
        real_log.deeds = reference_log.deeds = &machine.deeds;
        real_log.machine = &real;
        reference_log.machine = &reference;
        real_log.raise = [](void* m, std::string_view event, Time now) {
            auto& execution = *static_cast<StateMachineExecution*>(m);
            execution.dispatch(trigger(execution, event), now);
        };
        real_log.give_up = [](void* m, Time now) {
            static_cast<StateMachineExecution*>(m)->request_final(now, "gave up");
        };
        reference_log.raise = [](void* m, std::string_view event, Time now) {
            static_cast<ReferenceMachine*>(m)->dispatch(event, now);
        };
        reference_log.give_up = [](void* m, Time now) {
            static_cast<ReferenceMachine*>(m)->request_final(now, "gave up");
        };
    }
    static std::size_t trigger(const StateMachineExecution& execution, std::string_view event) {
        const auto names = execution.machine().triggers;
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), event) - names.begin());
    }
};

struct Coverage {
    std::size_t machines = 0, refused = 0, transitions = 0, internal = 0, deepest = 0, left_over = 0,
                lost = 0, timed = 0;
};

void compare(const RandomMachine& machine, const Slot& slot, Random& random, Coverage& coverage) {
    Pair pair{machine, slot};
    StateMachineExecution& real = pair.real;
    ReferenceMachine& reference = pair.reference;
    Time now = at_ns(1000);
    for (int action = 0; action < 120; ++action) {
        now += Duration{random.between(0, 20)};
        const auto answers = static_cast<std::uint32_t>(random.next());
        pair.real_log.now = pair.reference_log.now = now;
        pair.real_log.yes = pair.reference_log.yes = answers;
        const std::uint64_t kind = random.below(40);
        if (kind < 20) {
            const std::string_view event = event_names[random.below(std::size(event_names))];
            real.dispatch(Pair::trigger(real, event), now);
            reference.dispatch(event, now);
        } else if (kind < 34) {
            real.step(now);
            reference.step(now);
        } else if (kind == 34) {
            real.request_final(now, reasons[0]);
            reference.request_final(now, reasons[0]);
        } else if (kind < 37) {
            real.request_initial(now);
            reference.request_initial(now);
        } else if (kind == 37 && random.one_in(4)) {
            real.deactivate(now);
            reference.deactivate();
        } else {
            real.start(now);
            reference.start(now);
        }
        ASSERT_EQ(pair.real_log.calls, pair.reference_log.calls) << "action " << action;
        std::string path;
        for (std::string_view name : real.path()) path.append("/").append(name);
        ASSERT_EQ(path, reference.path()) << "action " << action;
        ASSERT_EQ(real.status().transitions, reference.transitions);
        ASSERT_EQ(real.status().lost_events, reference.lost);
        ASSERT_EQ(real.reason(), reference.reason);
        ASSERT_EQ(real.left_over(), reference.left_over());
        ASSERT_EQ(real.next_timeout(), reference.next_timeout()) << "action " << action;
        coverage.left_over += real.left_over() ? 1u : 0u;
        coverage.deepest = std::max(coverage.deepest, real.path().size());
    }
    coverage.transitions += reference.transitions;
    coverage.lost += reference.lost;
    for (const TransitionRow& row : machine.transitions) {
        coverage.internal += row.to.empty() ? 1u : 0u;
        coverage.timed += row.timed ? 1u : 0u;
    }
}

TEST(StateMachineReference, does_what_an_interpreter_of_the_hierarchy_does) {
    const char* chosen = std::getenv("TAPPET_SEED");
    const std::uint64_t seed = chosen == nullptr ? 1 : std::strtoull(chosen, nullptr, 10);
    static Slot slot;
    Coverage coverage;
    Random random{seed};
    while (coverage.machines < 3000) {
        const RandomMachine machine{random};
        if (const Sentence fault = slot.load(machine.view()); !fault.empty()) {
            ASSERT_EQ(fault.view().find("there is room for"), std::string_view::npos) << fault.view();
            ASSERT_LT(++coverage.refused, 1000000u)
                << "the generator makes no good machines: " << fault.view();
            continue;
        }
        ++coverage.machines;
        compare(machine, slot, random, coverage);
        if (HasFatalFailure()) {
            ADD_FAILURE() << "seed " << seed << ", machine " << coverage.machines;
            return;
        }
    }
    std::cout << coverage.machines << " machines (" << coverage.refused << " faulty ones refused), "
              << coverage.transitions << " transitions, " << coverage.internal << " internal and "
              << coverage.timed << " timed rows, depth up to " << coverage.deepest << ", "
              << coverage.left_over << " calls with work left over, " << coverage.lost
              << " events lost for want of room\n";
    EXPECT_GT(coverage.transitions, coverage.machines * 10);
    EXPECT_GE(coverage.deepest, 5u);
    EXPECT_GT(coverage.left_over, 0u);
    EXPECT_GT(coverage.lost, 0u);
    EXPECT_GT(coverage.internal, 0u);
    EXPECT_GT(coverage.timed, 0u);
}

} // namespace
} // namespace tappet
