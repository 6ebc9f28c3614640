// Executes one program (thesis 5.1.2, 5.1.3): its status, and what starts, stops, pauses and steps it. Make
// all calls in the program's engine, or while nothing steps it; real-time.
//
// clang-format off
//   ready     --start-->   running    from its first node
//   running   --pause-->   paused     at its position; time-outs continue
//   paused    --start-->   running    from its position
//   running   --end-->     stopped    it reached its end node
//   running, paused, error --stop-->  stopped    what it waits for is forgotten; its data stay
//   stopped   --start-->   running    from its first node, with the data as they are
//   running, paused --a failing action or condition--> error
//   stopped, error, ready --reset-->  ready      with its data as at the beginning
// clang-format on
// Other commands are ignored and return false. A pause or a stop that a statement of the program itself
// caused (an event that it emits is handled at once) takes effect at the end of its step.
#pragma once

#include "kernel/program/interpreter.hpp"

namespace tappet {

/// Statements that one step executes (thesis 5.1.3). By default: until no arc is open, with a bound that is
/// only a safeguard.
struct ProgramPolicy {
    static constexpr std::uint32_t default_statements = 1000;
    std::uint32_t statements = default_statements;
    bool continue_on_error = false; ///< skips a failing statement, see past_failure()
};

class ProgramExecution {
public:
    /// Call before start(). `context` has the component, the data with tables.layout.size bytes, the links.
    /// The tables, the data and the links must outlive the execution. Sets the data to `image`, at least
    /// layout.variables bytes: tables.image, or that of an instance.
    void bind(const ProgramCode& code, const ProgramContext& context, std::span<const std::byte> image,
              const ProgramPolicy& policy = {}, ProgramIndex program = 0) noexcept TAPPET_REALTIME;

    bool start() noexcept TAPPET_REALTIME;
    /// Sets the parameters, packed one after the other in their order. Before a start; not while it runs.
    void give(const std::byte* parameters) noexcept TAPPET_REALTIME;
    /// Copies the last result, of a program that has one.
    void take_result(std::byte* into) const noexcept TAPPET_REALTIME;
    bool pause() noexcept TAPPET_REALTIME;
    bool stop() noexcept TAPPET_REALTIME;
    /// Sets its variables to their initial values; parameters keep theirs.
    bool reset() noexcept TAPPET_REALTIME;
    /// Executes one step of the engine; does nothing unless it is running.
    void step(Time now) noexcept TAPPET_REALTIME;
    /// Executes at most one statement of a paused program (thesis 5.1.3). Returns false when it is not
    /// paused.
    bool single_step(Time now) noexcept TAPPET_REALTIME;

    [[nodiscard]] ProgramStatus status() const noexcept TAPPET_REALTIME { return status_; }
    [[nodiscard]] bool is_at_work() const noexcept TAPPET_REALTIME {
        return status_ == ProgramStatus::running || status_ == ProgramStatus::paused;
    }
    /// Returns whether it has executed its last statement since it was started, and was not stopped.
    [[nodiscard]] bool has_ended() const noexcept TAPPET_REALTIME { return has_ended_; }
    [[nodiscard]] const ProgramPosition& position() const noexcept TAPPET_REALTIME {
        return context_.position;
    }
    /// Returns the script line of the current statement, also when it waits or failed; 0: none.
    [[nodiscard]] std::uint16_t line() const noexcept TAPPET_REALTIME {
        const NodeIndex node = context_.position.node;
        return node < code_.tables->nodes.size() ? code_.tables->nodes[node].line : std::uint16_t{0};
    }
    /// Returns whether the last step used up its statements with work left.
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME { return left_over_; }
    /// Returns how many statements failed since bind(), skipped ones included.
    [[nodiscard]] std::uint32_t failures() const noexcept TAPPET_REALTIME { return failures_; }
    /// Returns when it needs a step without an event: its earliest time-out; at once when work was left over
    /// or begun; else `never`.
    [[nodiscard]] Time wakes() const noexcept TAPPET_REALTIME;
    [[nodiscard]] const ProgramCode& code() const noexcept TAPPET_REALTIME { return code_; }
    [[nodiscard]] const ProgramContext& context() const noexcept TAPPET_REALTIME { return context_; }

private:
    void fill(std::size_t from) noexcept TAPPET_REALTIME;
    void run(Time now, std::uint32_t statements) noexcept TAPPET_REALTIME;
    void advance(std::uint32_t statements) noexcept TAPPET_REALTIME;
    /// Returns whether it is inside its step: then `wanted` takes effect at the end of that step.
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
    ProgramStatus wanted_ = ProgramStatus::running; ///< at the end of the step
    std::uint32_t failures_ = 0;
};

} // namespace tappet
