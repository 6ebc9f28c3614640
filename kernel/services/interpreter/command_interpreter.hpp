// The command interpreter (thesis 3.3, 3.4.6): compiles a line of the script language, from a browser or a
// peer, and the engine whose components it names executes it.
#pragma once

#include "kernel/base/bounded_text.hpp"
#include "kernel/component/component.hpp"
#include "kernel/machine/instance/line_functions.hpp"
#include "kernel/services/interpreter/line_memory.hpp"

namespace tappet {

/// Runs in the activity of the browser's service, which is not_real_time, with `stack(224 * 1024)` for the
/// compiler. A line is one expression, which changes nothing and whose value is the answer, or statements:
/// these may wait, and the commands that they send are followed to their ends. It may name ports, properties
/// and methods of components of one activity, and commands of all; the engine of that activity steps the line
/// between two cycles, as often as the interpreter's own activity runs. One line at a time: an expression
/// gives way to a line of a higher role, which a browser must send again and which a peer's command waits
/// for; nobody breaks off a line of a higher role.
///     component<CommandInterpreter>("interpreter")
/// A peer sends it `execute` with a line and a place for its value; the command is rejected when the line is
/// not valid, and `said` tells why.
class CommandInterpreter {
public:
    static constexpr bool sees_machine = true;
    static constexpr std::size_t max_characters = 480;
    /// Lines that run, or whose commands are still in progress; one of them is reserved for engineers.
    static constexpr std::size_t lines_at_most = 3;
    /// The most statements of a line that its engine executes between two steps: the engine has other work.
    static constexpr std::uint32_t statements_between_steps = 64;
    /// An engine that does not serve a line within this time hangs, or is stopped.
    static constexpr Duration patience = 2s;
    using Line = Text<120>;

    Output<std::int64_t> executed, refused;
    Output<Text<240>> said;
    Property<Duration> longest{60s};

    Sentence configure(Setup& setup);
    void work(const Cycle& cycle);
    void stop(const Cycle&) noexcept TAPPET_REALTIME;

    bool execute(const Line& line, Line& value) noexcept;
    CommandProgress follow(const Line& line, Line& value) noexcept TAPPET_REALTIME;
    void break_off() noexcept TAPPET_REALTIME {
        is_broken_off_ = is_at_work();
        waits_ = false;
    }

    static const LineFunctions line_functions;

    static constexpr auto interface() {
        return facets(
            output<&CommandInterpreter::executed>("executed", "", "lines, since start"),
            output<&CommandInterpreter::refused>("refused", "", "lines that were not begun, since start"),
            output<&CommandInterpreter::said>("said", "", "what became of the last line"),
            property<&CommandInterpreter::longest>("longest", "s", "that a line may take",
                                                   range(0.001, 86400)),
            command<&CommandInterpreter::execute, &CommandInterpreter::follow>(
                "execute", "a line of the script language; its value comes back as text", may_block),
            operation<&CommandInterpreter::break_off>("break_off", "ends the line that is at work"));
    }

private:
    enum class Asker : std::uint8_t { none, peer, browser };

    Sentence begin(std::string_view text, Rights rights, Asker asker, LineRefusal& refusal);
    Sentence prepare(std::string_view text, Rights rights, interpreter::Bank& bank, LineRefusal& refusal);
    Sentence check_rights(const ScriptUnit& unit, Rights rights) const;
    Sentence check_running(const ScriptUnit& unit) const;
    [[nodiscard]] bool is_at_work() const noexcept TAPPET_REALTIME {
        return asker_ != Asker::none && in_flight(end_.state);
    }
    /// A client of a higher role waits for the end of the present line: no lower role is next.
    void keep_for(Role role, Time now) noexcept {
        if (role < kept_for_ && now < kept_until_) return; // a higher role waits already
        kept_for_ = role;
        kept_until_ = now + patience;
    }
    void post(interpreter::Bank& bank) noexcept;
    void tell(const Sentence& fault) noexcept;
    void finish(CommandState state, const Sentence& why) noexcept TAPPET_REALTIME;
    void finish_good();
    void reach_from(std::size_t home) noexcept;
    static void run(void* bank, const std::byte*) noexcept TAPPET_REALTIME;

    MachineInstance* machine_ = nullptr;
    std::size_t own_ = nowhere;
    /// Number 0 is unused: a line drives no component.
    std::array<Reachable, max_line_components + 1> reach_{};
    /// A command of a line that was broken off may keep one bank for ever, while the next line runs.
    static constexpr std::ptrdiff_t banks_of_engineers = 1;
    std::array<interpreter::Bank, lines_at_most> banks_{};
    interpreter::Bank* bank_ = nullptr; ///< of the present line, or of the last one
    Asker asker_ = Asker::none;         ///< the owner who has not released it
    bool is_broken_off_ = false;
    Role kept_for_ = Role::observer; ///< no line of a lower role is next,
    Time kept_until_{};              ///< until then
    Line of_peer_{};                 ///< the last line of a peer
    Line number_of_peer_{};          ///< identifies its sender
    std::uint64_t lines_of_peers_ = 0;
    bool waits_ = false; ///< a peer's line waits: the present line gives way to it
    Time since_waiting_{};
    Time since_{};
    Time posted_{};
    LineEnd end_{};
    Line value_{};
};

} // namespace tappet
