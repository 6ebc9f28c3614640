// Runs one script in both interpreters through the same day: events, requests, measurements and time at
// random.
#pragma once

#include "tests/differential/reference_bench.hpp"
#include "tests/differential/reference_machine.hpp"
#include "tests/differential/unit_bench.hpp"

#include "kernel/base/random.hpp"

namespace tappet {

class RandomDay {
public:
    RandomDay(std::uint64_t seed, const std::string& text, const ScriptUnit& unit,
              std::span<const ProgramCode> code = {}, std::span<const StateMachineFast> fast = {});

    /// The first difference, and the whole diary of both; empty: no difference in that many steps.
    std::string run(int steps);

private:
    /// A program alone, in the second interpreter.
    struct Alone {
        reference::Scope scope{};
        reference::ProgramRun run{};
        std::string status{"ready"};
        void start(const reference::Type& type);
        void step(std::int64_t now, std::int64_t statements);
        void stop();
    };
    /// A program that the script's state machine commands.
    struct Aid final : Alone, reference::BenchWorld::Beside {
        const reference::Type* type = nullptr; ///< null: there is none
        bool has_ended = false;
        bool is_in_step = false;
        bool is_to_stop = false; ///< requests a stop at the end of the step: its own statement led to that
        bool begin(const std::vector<reference::Value>& given) override;
        reference::Answer ended() override;
        void stop() override;
        [[nodiscard]] bool is_running() const override { return status == "running"; }
        [[nodiscard]] reference::Value result() const override { return run.result(); }
        void advance(std::int64_t now, std::int64_t statements);
    };

    void do_something();
    void emit();
    void feed();
    void drain();
    void command();
    void command_program();
    void step();
    void single_step();
    [[nodiscard]] std::string difference() const;
    [[nodiscard]] std::string compare(const BenchPart& part, const std::string& picture,
                                      const reference::Scope& scope) const;
    void did(const std::string& what);
    [[nodiscard]] reference::Machine& machine(std::size_t i) const;
    /// The root, or the program alone; then its children.
    [[nodiscard]] BenchPart& part(std::size_t i) const;

    Random random_;
    StateMachinePolicy policy_{};
    reference::Script script_;
    reference::BenchWorld world_{};
    UnitBench bench_{};
    std::unique_ptr<reference::Machine> root_;
    Alone alone_{};
    Aid aid_{};
};

} // namespace tappet
