// Thousands of random machines under random events, steps and requests: the resolved form and an interpreter
// that walks the states by name do the same, program by program and guard by guard: machines of C++
// functions, and machines with everything of thesis 5.2: programs that wait and fail, regions, history, else
// branches, preconditions, handle programs, arguments. TAPPET_SEED chooses other machines.
#include "tests/kernel/statechart/reference.hpp"

#include "kernel/base/random.hpp"
#include "kernel/statechart/execution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
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
enum class Act : std::uint8_t { nothing, raise, give_up, request };

/// The component of either side: what ran, and how its programs reach their machine.
struct Log {
    std::vector<int> calls;
    std::uint32_t yes = 0;    // answers of the guards
    std::uint32_t broken = 0; // guards and programs that fail
    const std::array<Act, program_count>* acts = nullptr;
    void* machine = nullptr;
    void (*raise)(void* machine, std::string_view event, Time now) = nullptr;
    void (*give_up)(void* machine, Time now) = nullptr;
    void (*request)(void* machine, std::string_view state, Time now) = nullptr;
    Time now{};
    alignas(data_alignment) std::array<std::byte, data_alignment> data{}; // the argument of the last event

    void run(std::size_t program) {
        calls.push_back(static_cast<int>(program));
        if ((*acts)[program] == Act::raise)
            raise(machine, event_names[program % std::size(event_names)], now);
        if ((*acts)[program] == Act::give_up) give_up(machine, now);
        if ((*acts)[program] == Act::request) request(machine, state_names[program % 7], now);
    }
    bool ask(std::size_t guard) {
        int argument = 0;
        std::memcpy(&argument, data.data(), sizeof argument);
        calls.push_back(-1 - static_cast<int>(guard) - 100 * argument);
        return (yes >> guard & 1u) != 0;
    }
    /// A program of the table, one statement at a time: how long it waits is in its number.
    ReferenceMachine::Answer advance(std::size_t program, int& stage) {
        using Answer = ReferenceMachine::Answer;
        const int waits = program % 3 == 0 ? static_cast<int>(program % 4) : 0;
        if (stage == 0) run(program);
        if (stage < waits) {
            ++stage;
            return Answer::waits;
        }
        if (program % 11 == 0 && (broken >> program % 32 & 1u) != 0) return Answer::failed;
        calls.push_back(1000 + static_cast<int>(program));
        return Answer::yes;
    }
    ReferenceMachine::Answer test(std::size_t guard) {
        const bool holds = ask(guard);
        if (guard % 5 == 0 && (broken >> guard & 1u) != 0) return ReferenceMachine::Answer::failed;
        return holds ? ReferenceMachine::Answer::yes : ReferenceMachine::Answer::no;
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

constexpr int stages = 8; // of a program: its nodes

struct RandomMachine {
    bool rich; // everything, and programs of the table; otherwise C++ functions and what they can do
    std::vector<StateRow> states;
    std::vector<TransitionRow> transitions;
    std::array<Act, program_count> acts{};
    std::array<ProgramRow, program_count> program_rows{};
    std::array<CaptureRow, 1> captures{{{0, sizeof(int), 0, 0, 0}}};
    ProgramTables tables{};

    RandomMachine(const RandomMachine&) = delete;
    RandomMachine& operator=(const RandomMachine&) = delete;
    [[nodiscard]] StateMachineTable view() const {
        return {"random", states, transitions, nullptr, rich ? &tables : nullptr, captures};
    }

    RandomMachine(Random& random, bool is_rich) : rich{is_rich} {
        for (std::size_t i = 0; i < program_count; ++i)
            program_rows[i].first = static_cast<NodeIndex>(i * stages);
        tables.programs = program_rows;
        const auto count = static_cast<std::size_t>(random.between(2, std::size(state_names)));
        for (std::size_t i = 0; i < count; ++i) {
            StateRow row{.name = state_names[i]};
            row.final = i == 0;
            if (i > 1 && !random.one_in(3))
                row.parent = state_names[static_cast<std::size_t>(
                    random.between(1, static_cast<std::int64_t>(i) - 1))];
            if (!random.one_in(4)) row.entry = program_of(random, 3 * i);
            if (!random.one_in(4)) row.exit = program_of(random, 3 * i + 1);
            if (!random.one_in(3)) row.run = program_of(random, 3 * i + 2);
            if (random.one_in(4)) row.handle = program_of(random, 3 * i);
            if (rich && random.one_in(8)) row.precondition = guard_ref(random.below(guard_count));
            // Every third state has regions.
            if (rich && !row.parent.empty() && std::stoi(std::string{row.parent.substr(1)}) % 3 == 1)
                row.region = random.one_in(2) ? "left" : "right";
            // One initial state in each region: the first, or the one that draws it later.
            StateRow* first = nullptr;
            for (StateRow& other : states)
                if (other.parent == row.parent && other.region == row.region && other.initial) first = &other;
            row.initial = i > 0 && (first == nullptr || random.one_in(3));
            if (row.initial && first != nullptr) first->initial = false;
            states.push_back(row);
        }
        for (std::size_t i = count; i > 1; --i) std::swap(states[i - 1], states[random.below(i)]);
        for (std::size_t i = 0; i < count; ++i)
            add(random, states[i].name); // each has a way out, most of the time
        while (transitions.size() < 48 && !random.one_in(20)) add(random, states[random.below(count)].name);
        for (Act& act : acts) {
            if (random.one_in(12)) act = Act::raise;
            if (random.one_in(60)) act = Act::give_up;
            if (rich && random.one_in(40)) act = Act::request;
        }
    }

private:
    [[nodiscard]] ProgramRef program_of(Random& random, std::size_t number) const {
        if (!rich || random.one_in(4)) return programs[number];
        return ProgramRef{static_cast<ProgramIndex>(number)};
    }
    [[nodiscard]] ConditionRef guard_ref(std::size_t number) const {
        if (!rich) return guards[number];
        return ConditionRef{static_cast<ConditionIndex>(number)};
    }
    void add(Random& random, std::string_view from) {
        TransitionRow row{.from = from, .to = states[random.below(states.size())].name};
        const std::uint64_t kind = random.below(8);
        const bool has_guard = !random.one_in(3);
        if (has_guard) row.guard = guard_ref(random.below(guard_count));
        if (kind < 5) {
            row.on_event = true;
            row.event = event_names[random.below(std::size(event_names))];
        } else if (kind < 7) {
            row.timed = true;
            row.after = Duration{random.between(1, 60)};
        } else if (!has_guard)
            row.guard = guard_ref(0);
        const bool has_program = !random.one_in(3);
        if (has_program) row.then = program_of(random, 3 * std::size(state_names) + transitions.size());
        if (row.on_event && has_program && random.one_in(8)) row.to = {};
        if (random.one_in(4)) row.because = reasons[random.below(std::size(reasons))];
        if (rich) enrich(random, row, has_guard);
        transitions.push_back(row);
    }
    void enrich(Random& random, TransitionRow& row, bool has_guard) const {
        if (row.on_event && random.one_in(3)) row.captures = 1;
        const bool is_composite =
            std::ranges::any_of(states, [&row](const StateRow& state) { return state.parent == row.to; });
        if (!row.to.empty() && is_composite && random.one_in(2))
            row.enters = random.one_in(2) ? EntryKind::shallow_history : EntryKind::deep_history;
        if (!row.on_event || !has_guard || !random.one_in(4)) return;
        row.has_otherwise = true;
        row.otherwise = program_of(random, transitions.size());
        if (random.one_in(2)) row.otherwise_to = states[random.below(states.size())].name;
    }
};

using Slot = ResolvedMachine<ResolvedSizes{20, 5, 256, 2048, 16384, 20}>;

ProgramReturn run_program(const ProgramTables&, ProgramContext& context, std::uint32_t& statements) noexcept
    TAPPET_REALTIME {
    --statements;
    const auto program = static_cast<std::size_t>(context.position.node / stages);
    int stage = context.position.node % stages;
    auto answer = ReferenceMachine::Answer::failed;
    TAPPET_ESCAPE("a test's log grows",
                  answer = static_cast<Log*>(context.component)->advance(program, stage));
    context.position.node = static_cast<NodeIndex>(program * stages + static_cast<std::size_t>(stage));
    if (answer == ReferenceMachine::Answer::failed) return ProgramReturn::failed;
    return answer == ReferenceMachine::Answer::yes ? ProgramReturn::ended : ProgramReturn::waits;
}
ConditionResult test_condition(const ProgramTables&, ProgramContext& context,
                               ConditionIndex condition) noexcept TAPPET_REALTIME {
    auto answer = ReferenceMachine::Answer::failed;
    TAPPET_ESCAPE("a test's log grows", answer = static_cast<Log*>(context.component)->test(condition));
    if (answer == ReferenceMachine::Answer::failed) return ConditionResult::failed;
    return answer == ReferenceMachine::Answer::yes ? ConditionResult::yes : ConditionResult::no;
}

struct Pair {
    Log real_log;
    Log reference_log;
    StateMachineExecution real;
    ReferenceMachine reference;

    std::array<StateIndex, 20> history{};
    std::array<std::byte, sizeof(int) * StateMachineExecution::max_raised_events> deferred{};

    Pair(const RandomMachine& machine, const Slot& slot)
        : reference{machine.view(),
                    &reference_log,
                    {.run = [this](ProgramIndex program,
                                   int& stage) { return reference_log.advance(program, stage); },
                     .test = [this](ConditionIndex condition) { return reference_log.test(condition); },
                     .data = reference_log.data.data()}} {
        StateMachineBinding binding;
        binding.machine = slot.view();
        binding.component = &real_log;
        binding.code = {&machine.tables, &run_program, &test_condition, nullptr};
        binding.data = real_log.data.data();
        binding.history = history;
        binding.deferred = deferred;
        EXPECT_TRUE(real.bind(binding));
        real_log.acts = reference_log.acts = &machine.acts;
        real_log.machine = &real;
        reference_log.machine = &reference;
        real_log.raise = [](void* m, std::string_view event, Time now) {
            auto& execution = *static_cast<StateMachineExecution*>(m);
            const auto argument = std::bit_cast<std::array<std::byte, 4>>(3);
            execution.dispatch(trigger(execution, event), now, argument.data());
        };
        real_log.give_up = [](void* m, Time now) {
            static_cast<StateMachineExecution*>(m)->request_final(now, "gave up");
        };
        reference_log.raise = [](void* m, std::string_view event, Time now) {
            static_cast<ReferenceMachine*>(m)->dispatch(event, now, 3);
        };
        reference_log.give_up = [](void* m, Time now) {
            static_cast<ReferenceMachine*>(m)->request_final(now, "gave up");
        };
        real_log.request = [](void* m, std::string_view state, Time now) {
            auto& execution = *static_cast<StateMachineExecution*>(m);
            execution.request_state(find_state(execution.machine().table, state), now, true);
        };
        reference_log.request = [](void* m, std::string_view state, Time now) {
            auto& other = *static_cast<ReferenceMachine*>(m);
            if (other.has(state)) other.request_state(state, now, true);
        };
    }
    static std::size_t trigger(const StateMachineExecution& execution, std::string_view event) {
        const auto names = execution.machine().triggers;
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), event) - names.begin());
    }
};

struct Coverage {
    std::size_t machines = 0, refused = 0, transitions = 0, internal = 0, deepest = 0, left_over = 0,
                lost = 0, timed = 0, histories = 0, otherwise = 0, in_regions = 0, waited = 0, errors = 0,
                deferred = 0, widest = 0;
};

void act(Pair& pair, const RandomMachine& machine, Random& random, Time now) {
    StateMachineExecution& real = pair.real;
    ReferenceMachine& reference = pair.reference;
    const std::uint64_t kind = random.below(machine.rich ? 50 : 40);
    if (kind < 20) {
        const std::string_view event = event_names[random.below(std::size(event_names))];
        const int argument = static_cast<int>(random.below(9));
        const auto packed = std::bit_cast<std::array<std::byte, 4>>(argument);
        real.dispatch(Pair::trigger(real, event), now, packed.data());
        reference.dispatch(event, now, argument);
    } else if (kind < 34 || kind >= 44) {
        real.step(now);
        reference.step(now);
    } else if (kind == 34) {
        real.request_final(now, reasons[0]);
        reference.request_final(now, reasons[0]);
    } else if (kind < 37) {
        real.request_initial(now);
        reference.request_initial(now);
    } else if (kind == 37 && (real.in_error() || random.one_in(4))) {
        real.deactivate(now);
        reference.deactivate(now);
    } else if (kind < 40) {
        real.start(now);
        reference.start(now);
    } else if (kind == 40) {
        real.reactive();
        reference.reactive();
    } else {
        const std::size_t state = random.below(machine.states.size());
        const bool run_once = random.one_in(2);
        real.request_state(static_cast<StateIndex>(state), now, run_once);
        reference.request_state(machine.states[state].name, now, run_once);
    }
}

void compare(const RandomMachine& machine, const Slot& slot, Random& random, Coverage& coverage) {
    Pair pair{machine, slot};
    StateMachineExecution& real = pair.real;
    ReferenceMachine& reference = pair.reference;
    Time now = at_ns(1000);
    for (int action = 0; action < 120; ++action) {
        now += Duration{random.between(0, 20)};
        pair.real_log.now = pair.reference_log.now = now;
        pair.real_log.yes = pair.reference_log.yes = static_cast<std::uint32_t>(random.next());
        const bool breaks = machine.rich && random.one_in(8);
        pair.real_log.broken = pair.reference_log.broken =
            breaks ? static_cast<std::uint32_t>(random.next()) : 0u;
        const bool was_in_error = real.in_error();
        act(pair, machine, random, now);
        ASSERT_EQ(pair.real_log.calls, pair.reference_log.calls) << "action " << action;
        std::string path;
        for (const ActiveState& each : real.states())
            path.append("/").append(machine.states[each.state].name);
        ASSERT_EQ(path, reference.path()) << "action " << action;
        ASSERT_EQ(real.is_active(), reference.is_active()) << "action " << action;
        ASSERT_EQ(real.in_error(), reference.in_error()) << "action " << action;
        ASSERT_EQ(real.under_way() && !real.in_error(), reference.under_way() && !reference.in_error());
        ASSERT_EQ(real.status().transitions, reference.transitions) << "action " << action;
        ASSERT_EQ(real.status().lost_events, reference.lost);
        ASSERT_EQ(real.reason(), reference.reason);
        ASSERT_EQ(real.left_over(), reference.left_over());
        ASSERT_EQ(real.next_timeout(), reference.next_timeout()) << "action " << action;
        coverage.left_over += real.left_over() ? 1u : 0u;
        coverage.deepest = std::max(coverage.deepest, real.path().size());
        coverage.widest = std::max(coverage.widest, real.states().size() - real.path().size());
        coverage.waited += real.under_way() ? 1u : 0u;
        coverage.errors += real.in_error() && !was_in_error ? 1u : 0u;
    }
    coverage.transitions += reference.transitions;
    coverage.lost += reference.lost;
    coverage.deferred += real.status().deferred_events;
    for (const TransitionRow& row : machine.transitions) {
        coverage.internal += row.to.empty() ? 1u : 0u;
        coverage.timed += row.timed ? 1u : 0u;
        coverage.histories += row.enters != EntryKind::initial ? 1u : 0u;
        coverage.otherwise += row.has_otherwise ? 1u : 0u;
    }
    for (const StateRow& row : machine.states) coverage.in_regions += row.region.empty() ? 0u : 1u;
}

Coverage compare_machines(std::size_t wanted, bool rich) {
    const char* chosen = std::getenv("TAPPET_SEED");
    const std::uint64_t seed = chosen == nullptr ? 1 : std::strtoull(chosen, nullptr, 10);
    static Slot slot;
    Coverage coverage;
    Random random{seed};
    while (coverage.machines < wanted && !testing::Test::HasFatalFailure()) {
        const RandomMachine machine{random, rich};
        if (const Sentence fault = slot.load(machine.view()); !fault.empty()) {
            EXPECT_EQ(fault.view().find("there is room for"), std::string_view::npos) << fault.view();
            if (++coverage.refused < 1000000u) continue;
            ADD_FAILURE() << "the generator makes no good machines: " << fault.view();
            break;
        }
        ++coverage.machines;
        compare(machine, slot, random, coverage);
        if (testing::Test::HasFatalFailure())
            ADD_FAILURE() << "seed " << seed << ", machine " << coverage.machines;
    }
    std::cout << coverage.machines << " machines (" << coverage.refused << " faulty ones refused), "
              << coverage.transitions << " transitions, " << coverage.internal << " internal, "
              << coverage.timed << " timed, " << coverage.histories << " by history and "
              << coverage.otherwise << " with an else branch; depth up to " << coverage.deepest << ", "
              << coverage.widest << " states beside, " << coverage.in_regions << " in regions; "
              << coverage.waited << " calls that left a program in hand, " << coverage.left_over
              << " with work left over, " << coverage.errors << " errors, " << coverage.deferred
              << " events deferred and " << coverage.lost << " lost\n";
    return coverage;
}

TEST(StateMachineReference, agrees_on_machines_of_functions) {
    const Coverage coverage = compare_machines(2000, false);
    EXPECT_GT(coverage.transitions, coverage.machines * 10);
    EXPECT_GE(coverage.deepest, 5u);
    EXPECT_GT(coverage.left_over, 0u);
    EXPECT_GT(coverage.lost, 0u);
    EXPECT_GT(coverage.internal, 0u);
    EXPECT_GT(coverage.timed, 0u);
}

TEST(StateMachineReference, agrees_on_machines_with_everything) {
    const Coverage coverage = compare_machines(2000, true);
    EXPECT_GT(coverage.transitions, coverage.machines * 10);
    EXPECT_GT(coverage.waited, coverage.machines);
    EXPECT_GT(coverage.errors, 0u);
    EXPECT_GT(coverage.histories, 0u);
    EXPECT_GT(coverage.otherwise, 0u);
    EXPECT_GT(coverage.in_regions, 0u);
    EXPECT_GT(coverage.widest, 0u);
    EXPECT_GT(coverage.deferred, 0u);
}

} // namespace
} // namespace tappet
