// Executes one program (thesis 5.1.2, 5.1.3): its status, and what starts, stops, pauses and steps it. All
// calls in the program's engine, or while nobody steps it; real-time.
//
// clang-format off
//   ready     --start-->   running    from its first node
//   running   --pause-->   paused     where it stands; time-outs go on
//   paused    --start-->   running    from where it stands
//   running   --end-->     stopped    it came to its end node
//   running, paused, error --stop-->  stopped    what it waits for is forgotten; its data stay
//   stopped   --start-->   running    from its first node, with the data as they are
//   running, paused --a failing action or condition--> error
//   stopped, error, ready --reset-->  ready      with its data as at the beginning
// clang-format on
// What is not listed is ignored, and answered with false. A pause or a stop that a statement of the program
// itself led to (an event that it emits is heard here and now) takes effect at the end of its step.
#pragma once

#include "kernel/program/interpreter.hpp"

namespace tappet {

/// How many statements one step executes (thesis 5.1.3). Without any of it: until no arc is open, with a
/// bound that only guards.
struct ProgramPolicy {
    static constexpr std::uint32_t default_statements = 1000;
    std::uint32_t statements = default_statements;
    bool continue_on_error = false; ///< a failing statement is passed over, see past_failure()
};

class ProgramExecution {
public:
    /// Before start(). `context` has the component, the data with tables.layout.size bytes, the links. The
    /// tables, the data and the links outlive the execution. The data are set to `image`, at least
    /// layout.variables bytes: tables.image, or that of an instance.
    void bind(const ProgramCode& code, const ProgramContext& context, std::span<const std::byte> image,
              const ProgramPolicy& policy = {}, ProgramIndex program = 0) noexcept TAPPET_REALTIME;

    bool start() noexcept TAPPET_REALTIME;
    /// Before a start: its parameters, packed one after the other in their order. Not while it runs.
    void give(const std::byte* parameters) noexcept TAPPET_REALTIME;
    /// Of a program that has one: what it returned last.
    void take_result(std::byte* into) const noexcept TAPPET_REALTIME;
    bool pause() noexcept TAPPET_REALTIME;
    bool stop() noexcept TAPPET_REALTIME;
    /// Its variables have their first values; parameters keep theirs.
    bool reset() noexcept TAPPET_REALTIME;
    /// One step of the engine; does nothing unless it is running.
    void step(Time now) noexcept TAPPET_REALTIME;
    /// From outside: one statement at most, of a program that is paused (thesis 5.1.3). False: it is not.
    bool single_step(Time now) noexcept TAPPET_REALTIME;

    [[nodiscard]] ProgramStatus status() const noexcept TAPPET_REALTIME { return status_; }
    [[nodiscard]] bool is_at_work() const noexcept TAPPET_REALTIME {
        return status_ == ProgramStatus::running || status_ == ProgramStatus::paused;
    }
    /// It has executed its last statement since it was started; it was not stopped.
    [[nodiscard]] bool has_ended() const noexcept TAPPET_REALTIME { return has_ended_; }
    [[nodiscard]] const ProgramPosition& position() const noexcept TAPPET_REALTIME {
        return context_.position;
    }
    /// The statement at which it stands, waits or failed; of a script its line, 0 where there is none.
    [[nodiscard]] std::uint16_t line() const noexcept TAPPET_REALTIME {
        const NodeIndex node = context_.position.node;
        return node < code_.tables->nodes.size() ? code_.tables->nodes[node].line : std::uint16_t{0};
    }
    /// The last step used up its statements with more to do.
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME { return left_over_; }
    /// Statements that failed since bind(), those passed over too.
    [[nodiscard]] std::uint32_t failures() const noexcept TAPPET_REALTIME { return failures_; }
    /// When it wants a step although nothing happens: its earliest time-out; what was left over, or begun, at
    /// once; else `never`.
    [[nodiscard]] Time wakes() const noexcept TAPPET_REALTIME;
    [[nodiscard]] const ProgramCode& code() const noexcept TAPPET_REALTIME { return code_; }
    [[nodiscard]] const ProgramContext& context() const noexcept TAPPET_REALTIME { return context_; }

private:
    void fill(std::size_t from) noexcept TAPPET_REALTIME;
    void run(Time now, std::uint32_t statements) noexcept TAPPET_REALTIME;
    void advance(std::uint32_t statements) noexcept TAPPET_REALTIME;
    /// Whether it is in its step: then what is wanted follows that.
    bool comes_later(ProgramStatus wanted) noexcept TAPPET_REALTIME;

    ProgramCode code_{};
    ProgramContext context_{};
    std::span<const std::byte> image_{};
    ProgramPolicy policy_{};
    ProgramIndex program_ = 0;
    ProgramStatus status_ = ProgramStatus::ready;
    bool left_over_ = false;
    bool waits_ = false;
    bool has_ended_ = false;
    bool is_in_step_ = false;
    ProgramStatus wanted_ = ProgramStatus::running; ///< at its end
    std::uint32_t failures_ = 0;
};

} // namespace tappet
