// The compiled form of a state machine equals its interpreted table (thesis 5.2.1 - 5.2.3): the same calls
// drive random machines whose programs wait, fail and raise events in both forms.
#include "kernel/program/interpreter.hpp"
#include "tests/kernel/statechart/random_constant_machine.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace tappet {
namespace {

using namespace random_machines;

void trace(void* context, StateIndex from, StateIndex to, TransitionIndex transition, Time) noexcept
    TAPPET_REALTIME {
    witness_of(context).note(1000u + from * 100u + to * 10u + transition);
}

/// One machine in one of its forms.
struct Instance {
    Witness witness{};
    alignas(data_alignment) std::array<std::byte, data_bytes> data{};
    std::array<std::byte, 64 * StateMachineExecution::max_raised_events> deferred{};
    StateMachineExecution machine{};

    Instance(const ResolvedView& view, const ProgramTables& tables, const ProgramCode& code,
             const StateMachineFast& fast, std::uint32_t statements) {
        std::ranges::copy(tables.image, data.begin());
        store_value(data.data() + limit, std::int64_t{12});
        StateMachineBinding binding;
        binding.machine = view;
        binding.component = &witness;
        binding.code = code;
        binding.data = data.data();
        binding.deferred = deferred;
        binding.fast = fast;
        binding.policy.statements = statements;
        witness.machine = &machine;
        EXPECT_TRUE(machine.bind(binding));
        machine.trace(&trace, &witness);
    }
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    int call(std::uint64_t what, std::uint64_t detail, Time now) {
        witness.now = now;
        std::array<std::byte, 8> packed{};
        const auto argument = static_cast<std::int64_t>(detail);
        std::memcpy(packed.data(), &argument, sizeof argument);
        if (what < 12) return machine.step(now), 0;
        if (what < 22) return static_cast<int>(machine.dispatch(detail % 3, now, packed.data()));
        switch (what) {
        case 22: return static_cast<int>(machine.request_final(now, "wanted"));
        case 23: return static_cast<int>(machine.request_initial(now));
        case 24:
            return static_cast<int>(
                machine.request_state(static_cast<StateIndex>(detail % state_count), now));
        case 25: return static_cast<int>(machine.pause());
        case 26: return static_cast<int>(machine.step_once(now));
        case 27: return static_cast<int>(machine.reactive());
        default:
            if (machine.in_error()) static_cast<void>(machine.deactivate(now));
            return static_cast<int>(machine.start(now));
        }
    }
    [[nodiscard]] std::vector<StateIndex> active() const {
        std::vector<StateIndex> states;
        for (const ActiveState& each : machine.states()) states.push_back(each.state);
        return states;
    }
    [[nodiscard]] std::vector<std::byte> kept_data() const { return {data.begin(), data.begin() + scratch}; }
};

struct Coverage {
    std::set<MachineStatus> statuses;
    std::set<StatePart> faults;
    std::uint64_t transitions = 0, under_way = 0, left_over = 0, deferred = 0;
};

bool same(const Instance& one, const Instance& other) {
    const StateMachineStatus& a = one.machine.status();
    const StateMachineStatus& b = other.machine.status();
    EXPECT_EQ(one.witness.sum, other.witness.sum);
    EXPECT_EQ(one.witness.calls, other.witness.calls);
    EXPECT_EQ(one.machine.machine_status(), other.machine.machine_status());
    EXPECT_EQ(one.active(), other.active());
    EXPECT_EQ(one.machine.active(), other.machine.active());
    EXPECT_EQ(one.kept_data(), other.kept_data());
    EXPECT_EQ(one.machine.under_way(), other.machine.under_way());
    EXPECT_EQ(one.machine.left_over(), other.machine.left_over());
    EXPECT_EQ(one.machine.waiting_events(), other.machine.waiting_events());
    EXPECT_EQ(one.machine.node_in_hand(), other.machine.node_in_hand());
    EXPECT_EQ(one.machine.next_timeout(), other.machine.next_timeout());
    EXPECT_EQ(one.machine.entered_at(), other.machine.entered_at());
    EXPECT_EQ(one.machine.reason(), other.machine.reason());
    EXPECT_EQ(one.machine.news(), other.machine.news());
    EXPECT_EQ(a.transitions, b.transitions);
    EXPECT_EQ(a.last_transition, b.last_transition);
    EXPECT_EQ(a.lost_events, b.lost_events);
    EXPECT_EQ(a.deferred_events, b.deferred_events);
    EXPECT_EQ(a.fault.part, b.fault.part);
    EXPECT_EQ(a.fault.node, b.fault.node);
    EXPECT_EQ(a.fault.state, b.fault.state);
    EXPECT_EQ(a.fault.transition, b.fault.transition);
    EXPECT_EQ(a.fault.number, b.fault.number);
    return !testing::Test::HasFatalFailure() && !testing::Test::HasNonfatalFailure();
}

template <std::uint64_t seed, bool folded> void both_ways(Coverage& coverage) {
    static_assert(check(machine<seed, folded>.table).empty());
    constexpr const auto& room = native::resolved_type<machine<seed, folded>, 0>;
    static_assert(room.view().plain);
    constexpr const ProgramTables& rows = tables<seed, folded>;
    for (std::uint64_t run = 0; run < 60; ++run) {
        Random random{seed * 1000 + run};
        const std::uint64_t most = random(2) == 0 ? 12 : 60; // with very few it stays in memory
        const auto statements =
            static_cast<std::uint32_t>(folded || random(2) == 0 ? 1000 : 1 + random(most));
        Instance one{room.view(), rows, native_code<machine<seed, folded>>,
                     native_machine<machine<seed, folded>>, statements};
        Instance other{room.view(), rows, interpreted(rows), {}, statements};
        std::int64_t now = 100;
        for (int i = 0; i < 150; ++i) {
            now += static_cast<std::int64_t>(random(15));
            const std::uint64_t what = i == 0 ? 40 : random(31), detail = random(9);
            const int said = one.call(what, detail, at_ns(now));
            EXPECT_EQ(said, other.call(what, detail, at_ns(now)));
            if (!same(one, other)) {
                FAIL() << "machine " << seed << ", run " << run << ", call " << i << " (" << what << ")";
            }
            coverage.statuses.insert(one.machine.machine_status());
            coverage.faults.insert(one.machine.fault().part);
            coverage.under_way += one.machine.under_way();
            coverage.left_over += one.machine.left_over();
        }
        coverage.transitions += one.machine.status().transitions;
        coverage.deferred += one.machine.status().deferred_events;
    }
}

TEST(NativeMachine, equals_the_interpreted_table_call_by_call) {
    Coverage coverage;
    const auto all = [&coverage]<bool folded, std::uint64_t... seed>() {
        (both_ways<seed, folded>(coverage), ...);
    };
    all.template operator()<false, 1, 2, 5>(); // check() finds no fault in it
    all.template operator()<true, 101>();
    EXPECT_EQ(coverage.statuses.size(), 6u) << "inactive to error";
    EXPECT_GT(coverage.faults.size(), 5u) << "entries, exits, runs, transition programs, guards failed";
    EXPECT_GT(coverage.transitions, 3000u);
    EXPECT_GT(coverage.under_way, 500u);
    EXPECT_GT(coverage.left_over, 500u);
    EXPECT_GT(coverage.deferred, 500u);
}

} // namespace
} // namespace tappet
