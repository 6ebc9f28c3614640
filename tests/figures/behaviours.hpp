// One behaviour in four forms, on the same component: a switch written by hand, a script as native code, the
// same script walked in memory, and a C++ table as native code. All count, so that each can be checked.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/program/interpreter.hpp"
#include "kernel/script/compiled.hpp"
#include "kernel/script/native.hpp"

#include <array>

namespace tappet::figures {

struct Swing {
    Event<> beat;
    std::int64_t exits = 0;
    std::int64_t entries = 0;
    std::int64_t runs = 0;

    void left() noexcept TAPPET_REALTIME { exits += 1; }
    void entered() noexcept TAPPET_REALTIME { entries += 1; }
    void turned() noexcept TAPPET_REALTIME { runs += 2; }
    void ran() noexcept TAPPET_REALTIME { runs += 1; }
    bool may() const noexcept TAPPET_REALTIME { return runs >= 0; }
    bool tired() const noexcept TAPPET_REALTIME { return runs < 0; }

    static constexpr auto interface() { return facets(event<&Swing::beat>("beat", "to the other side")); }
};

inline constexpr ScriptSource script_source{"swing.osd", R"(
StateMachine Swing {
    var int exits = 0;
    var int entries = 0;
    var int runs = 0;

    initial state Left {
        entry { set entries = entries + 1; }
        run { set runs = runs + 1; }
        exit { set exits = exits + 1; }
        transition beat if runs >= 0 then { set runs = runs + 2; } select Right
        transitions { if runs < 0 then select Safe }
    }
    state Right {
        entry { set entries = entries + 1; }
        run { set runs = runs + 1; }
        exit { set exits = exits + 1; }
        transition beat if runs >= 0 then { set runs = runs + 2; } select Left
        transitions { if runs < 0 then select Safe }
    }
    final state Safe { }
}
RootStateMachine Swing swing
)"};
inline constexpr auto script_reach_of_swing = script_reach(reachable<Swing>("swing"));
inline constexpr ScriptUnit swing_script = compiled_script<script_source, script_reach_of_swing>;

/// A loop of statements: per turn one comparison and eight statements.
inline constexpr ScriptSource program_source{"sums.osd", R"(
program sums {
    var int i = 0;
    var int a = 0;
    var int b = 1;
    var double x = 0.0;
    while (i < 1000) {
        set i = i + 1;
        set a = a + i;
        set b = a - b;
        if (b > 100000) then { set b = 1; }
        set x = x + 0.5;
        set x = x * 0.75;
        set a = a - b;
    }
}
)"};
inline constexpr ScriptReach<1> program_reach{{reachable<Swing>("swing")}, 20'000};
inline constexpr ScriptUnit sums_script = compiled_script<program_source, program_reach>;

inline constexpr auto swing_table = state_machine<Swing>(
    "swing",
    states(state("left", initial, entry<&Swing::entered>, run<&Swing::ran>, exit<&Swing::left>),
           state("right", entry<&Swing::entered>, run<&Swing::ran>, exit<&Swing::left>),
           state("safe", final)),
    transitions(transition("left", "right", on("beat"), guard<&Swing::may>, then<&Swing::turned>),
                transition("right", "left", on("beat"), guard<&Swing::may>, then<&Swing::turned>),
                transition("left", "safe", guard<&Swing::tired>),
                transition("right", "safe", guard<&Swing::tired>)));
static_assert(check(swing_table.view()).empty());

/// A state machine bound by hand, in one of its forms.
template <std::size_t bytes>
struct Bound {
    Swing component{};
    alignas(data_alignment) std::array<std::byte, bytes> data{};
    StateMachineExecution machine{};

    void bind(const ResolvedView& view, const ProgramTables& tables, const ProgramCode& code,
              const StateMachineFast& fast) {
        std::ranges::copy(tables.image, data.begin());
        StateMachineBinding binding;
        binding.machine = view;
        binding.component = &component;
        binding.code = code;
        binding.data = data.data();
        binding.fast = fast;
        static_cast<void>(machine.bind(binding));
        static_cast<void>(machine.start(at_ns(0)));
    }
};
inline constexpr std::size_t swing_bytes = tables_of(swing_script, 0).layout.size;
inline constexpr std::size_t sums_bytes = tables_of(sums_script, 0).layout.size;

inline void bind_compiled(Bound<swing_bytes>& bound) {
    bound.bind(native::resolved_type<swing_script, 0>.view(), tables_of(swing_script, 0),
               native_code<swing_script>, native_machine<swing_script>);
}
inline void bind_loaded(Bound<swing_bytes>& bound) {
    bound.bind(native::resolved_type<swing_script, 0>.view(), tables_of(swing_script, 0),
               interpreted(tables_of(swing_script, 0)), {});
}
inline void bind_table(Bound<16>& bound) {
    bound.bind(native::resolved_type<swing_table, 0>.view(), no_programs, {}, native_machine<swing_table>);
}
inline void bind_walked_table(Bound<16>& bound) {
    bound.bind(native::resolved_type<swing_table, 0>.view(), no_programs, {}, {});
}

/// What an engineer writes who owes his machine the same: checked sums, times of entry, a record of what was
/// taken, an observer, and one event at a time.
class HandWritten {
public:
    using Trace = void (*)(void*, int from, int to, Time now) noexcept TAPPET_REALTIME;
    enum State : std::uint16_t { left, right, safe };
    enum Fault : std::uint8_t { none, overflow };

    [[gnu::noinline]] bool dispatch(std::size_t event, Time now) noexcept TAPPET_REALTIME;
    [[gnu::noinline]] void step(Time now) noexcept TAPPET_REALTIME;

    std::int64_t exits = 0, entries = 1, runs = 0;
    State state = left;

private:
    bool beat(State to, Time now) noexcept TAPPET_REALTIME;
    bool fails() noexcept TAPPET_REALTIME {
        fault_ = overflow;
        busy_ = false;
        return false;
    }
    bool busy_ = false;
    Fault fault_ = none;
    std::uint32_t waiting_ = 0;
    std::uint16_t last_ = 0;
    std::uint64_t transitions_ = 0;
    Time entered_at_{};
    Time stepped_at_{};
    Trace trace_ = nullptr;
    void* trace_context_ = nullptr;
};

/// The loop of sums.osd, as it stands in a hand-written program that keeps its variables and its position.
struct HandWrittenSums {
    std::int64_t i = 0, a = 0, b = 1;
    double x = 0;
    int position = 0;
    [[gnu::noinline]] bool run() noexcept TAPPET_REALTIME;
};

} // namespace tappet::figures
