// A compiled or loaded unit on the components of bench.hpp, without a machine around it: each instance with
// its data, links and command slots, stepped by hand.
#pragma once

#include "tests/differential/bench.hpp"

#include "kernel/activity/command_processor.hpp"
#include "kernel/program/execution.hpp"
#include "kernel/script/unit.hpp"
#include "kernel/statechart/execution.hpp"

#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tappet {

class UnitBench;

/// The parts of a unit's "m" and "m.left".
struct BenchPart {
    const BehaviourInstance* row = nullptr;
    const BehaviourType* type = nullptr;
    StateMachineExecution* machine = nullptr; ///< of a program alone unused
    ProgramExecution program{};
    std::unique_ptr<std::byte[]> memory{};
    std::byte* data = nullptr;
    std::vector<ProgramLink> links{};
    // Names of the resolved machine.
    std::vector<StatePlan> plans{};
    std::vector<std::string_view> triggers{};
    std::vector<AskedIndex> cells{};
    std::vector<AskedArc> asked{};
    std::vector<StateArc> arcs{};
    std::vector<TransitionStep> steps{};
    std::vector<StateIndex> regions{}, history{};
    std::vector<std::uint16_t> captured{};
    std::vector<std::byte> deferred{};

    [[nodiscard]] bool is_program() const { return type->is_program(); }
};

class UnitBench {
public:
    Diary diary{};
    Bench own{};
    Bench mate{};
    Arm arm{};
    Output<double> source{};                 ///< of own.measured
    BufferOutput<std::int64_t> feed{};       ///< of own.queue
    BufferInput<double> drain{};             ///< of own.sent
    static constexpr std::size_t places = 4; ///< of each buffer
    Time now{};

    UnitBench();
    ~UnitBench();
    UnitBench(const UnitBench&) = delete;
    UnitBench& operator=(const UnitBench&) = delete;

    /// One ProgramCode for each type; without any, the programs are interpreted.
    void place(const ScriptUnit& unit, std::span<const ProgramCode> code = {},
               std::span<const StateMachineFast> fast = {},
               StateMachinePolicy policy = {.statements = 100'000});
    void start();
    void step();
    /// Steps the other activity: sent commands begin, running ones continue.
    void step_arm();
    void hear(std::string_view event, const std::byte* packed);

    [[nodiscard]] BenchPart& part(std::string_view name);
    [[nodiscard]] std::deque<BenchPart>& parts() { return parts_; }
    /// The only program that others of the script may command; it stands first. 0: there is none.
    [[nodiscard]] std::size_t programs_beside() const { return parts_.front().row->on_command ? 1 : 0; }
    [[nodiscard]] std::string picture(const BenchPart& part) const;
    /// A variable by name, as the reference prints it.
    [[nodiscard]] std::string value(const BenchPart& part, const VariableRow& row) const;

    static std::span<const Reachable> reach();

private:
    struct Heard; // of one event
    template <class T> void connect(BufferOutput<T>& from, BufferInput<T>& to);
    void bind_links(BenchPart& part);
    void resolve(BenchPart& part, const ProgramCode& code, const StateMachineFast& fast,
                 const StateMachinePolicy& policy);

    ScriptUnit unit_{};
    std::deque<BenchPart> parts_;
    std::unique_ptr<StateMachineExecution[]> machines_; ///< by instance: children side by side
    std::deque<CommandSlot> slots_;
    std::deque<std::vector<std::byte>> slot_values_;
    std::deque<std::vector<std::byte>> subscribers_, rings_;
    std::vector<std::unique_ptr<Heard>> heard_;
    std::vector<std::byte> mail_;
    std::unique_ptr<CommandMailbox> mailbox_;
    std::vector<CommandSlot*> followed_;
    CommandProcessor commands_;
    GatedComponent gates_[3]{GatedComponent{&own, ComponentState::running},
                             GatedComponent{&mate, ComponentState::running},
                             GatedComponent{&arm, ComponentState::running}};
};

} // namespace tappet
