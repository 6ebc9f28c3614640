// The command interpreter (thesis 3.3, 3.4.6): a line of the script language, from a browser or a peer, is
// compiled here and executed by the engine whose components it names.
#pragma once

#include "kernel/base/bounded_text.hpp"
#include "kernel/component/component.hpp"
#include "kernel/machine/instance/line_functions.hpp"
#include "kernel/services/interpreter/line_memory.hpp"

namespace tappet {

/// In the activity of the browser's service, which is not_real_time, with `stack(224 * 1024)` for the
/// compiler. A line is one expression, which changes nothing and whose value is the answer, or statements:
/// these may wait, and commands that they send are followed to their ends. It may name ports, properties and
/// methods of components of one activity, whose engine steps it between two cycles as often as the
/// interpreter's own runs, and commands of all. One line at a time: an expression gives way to a line of a
/// higher role, which a browser asks for again and a peer is given, and nobody breaks off a line of one.
///     component<CommandInterpreter>("interpreter")
/// A peer sends it `execute` with a line and where its value goes: rejected when it is no good line, of which
/// `said` tells why.
class CommandInterpreter {
public:
    static constexpr bool sees_machine = true;
    static constexpr std::size_t max_characters = 480;
    /// At work, or with commands that are on their way still; one of them is for engineers.
    static constexpr std::size_t lines_at_most = 3;
    /// Of a line its engine executes so many between two steps: it belongs to other work.
    static constexpr std::uint32_t statements_between_steps = 64;
    /// An engine that does not come to a line for so long hangs, or stands.
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

    Sentence begin(std::string_view text, Role role, Asker asker, LineRefusal& refusal);
    Sentence prepare(std::string_view text, Role role, interpreter::Bank& bank, LineRefusal& refusal);
    Sentence check_role(const ScriptUnit& unit, Role role) const;
    Sentence check_running(const ScriptUnit& unit) const;
    [[nodiscard]] bool is_at_work() const noexcept TAPPET_REALTIME {
        return asker_ != Asker::none && in_flight(end_.state);
    }
    /// Somebody of a higher role waits for the end of the line at work: nobody of a lower one is next.
    void keep_for(Role role, Time now) noexcept {
        if (role < kept_for_ && now < kept_until_) return; // somebody of a role above theirs waits already
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
    /// Number 0 is nobody: a line drives no component.
    std::array<Reachable, max_line_components + 1> reach_{};
    /// A command of a line that was broken off may keep one for ever, while the next line runs.
    static constexpr std::ptrdiff_t banks_of_engineers = 1;
    std::array<interpreter::Bank, lines_at_most> banks_{};
    interpreter::Bank* bank_ = nullptr; ///< of the line at work, or that ended last
    Asker asker_ = Asker::none;         ///< who has not let go of it
    bool is_broken_off_ = false;
    Role kept_for_ = Role::observer; ///< no line of a lower role is next,
    Time kept_until_{};              ///< until then
    Line of_peer_{};                 ///< that a peer sent last
    Line number_of_peer_{};          ///< by which its sender is known
    std::uint64_t lines_of_peers_ = 0;
    bool waits_ = false; ///< it does: the line at work gives way to it
    Time since_waiting_{};
    Time since_{};
    Time posted_{};
    LineEnd end_{};
    Line value_{};
};

} // namespace tappet
