// What the browser can be told to do: one table for the command line, the prompt, the help and the
// completion.
#pragma once

#include "toolchain/tools/browser/machines.hpp"

#include <nlohmann/json_fwd.hpp>

#include <csignal>
#include <iosfwd>

namespace tappet::browser {

/// Which names a command takes; completion and the check before a request look here.
enum class Takes {
    nothing,
    component,
    component_or_activity,
    value,
    property,
    callable,
    command,
    event,
    port,
    anything
};

/// Where there are several machines, and a line does not name one of them.
enum class Among {
    one,   ///< it has to
    each,  ///< without an argument it is about each of them in turn
    values ///< each argument may be of another machine
};

/// Which arguments are names of something in a machine; in Among::values each is.
enum class Names {
    none, ///< they are words of a line, or files
    first,
    second,
    every_other,
    behind_action ///< of behaviour
};

/// What a line wants of one machine.
struct Part {
    Session* session = nullptr;
    std::vector<std::string> names{};
};

struct Work {
    Session& session;
    const Line& line;
    std::ostream& out;
    bool screen = false;                                ///< `out` is a terminal that can be drawn on
    const volatile std::sig_atomic_t* signal = nullptr; ///< not 0 once the user wants no more
    std::span<const Part> among{}; ///< whose names the arguments are, if not the session's

    /// Asked between two pictures and while waiting.
    [[nodiscard]] bool stopped() const { return signal != nullptr && *signal != 0; }

    /// After the command's name.
    [[nodiscard]] std::span<const std::string> arguments() const { return std::span{line.words}.subspan(1); }
    /// The arguments, machine by machine.
    [[nodiscard]] std::vector<Part> parts() const {
        if (!among.empty()) return {among.begin(), among.end()};
        return {{&session, {line.words.begin() + 1, line.words.end()}}};
    }
    /// What stands before the machine's own names, where others are there.
    [[nodiscard]] const std::string& place() const { return session.map().place(); }
};

using Run = Result<void>(Work& work);

/// With its options, each as "[--option", the usage is all that help, refusals and completion know.
struct Command {
    std::string_view name;
    std::string_view usage;
    std::string_view help;
    Takes takes;
    std::size_t fewest; ///< arguments
    std::size_t most;
    Run* run;
    Among among = Among::one;
    Names names = Names::first;
};

[[nodiscard]] std::span<const Command> commands();
[[nodiscard]] const Command* find_command(std::string_view name);
[[nodiscard]] std::string unknown_command(std::string_view name);
/// Runs the line's command; its words are not empty.
Result<void> run_command(Work& work);
/// Whether the argument of that number, from 0, is a name of something in a machine.
[[nodiscard]] bool is_name(const Command& command, std::span<const std::string> arguments,
                           std::size_t argument);
/// The line as one request: the machine hears its own names.
[[nodiscard]] std::string request_of(const Work& work);
/// A machine's packet for programs: without what is for the two ends only, with the machine among others.
[[nodiscard]] std::string packet_text(const Work& work, nlohmann::ordered_json packet);
/// The facet, or why it is none that this command takes, with the nearest name.
Result<FoundFacet> find_facet(const MapReader& map, Takes takes, std::string_view name);
/// Every name that a command may be given.
[[nodiscard]] std::vector<std::string> names_for(const MapReader& map, Takes takes);
/// The values that a line names, machine by machine; a component's name is all of its values.
struct Seen {
    Session* session = nullptr;
    std::vector<std::uint32_t> facets{};
};
Result<std::vector<Seen>> find_seen(const Work& work);
/// Runs the line at the machine or the machines that it is about. What went wrong, machine by machine; empty:
/// nothing did.
[[nodiscard]] std::vector<Failure> run_among(Machines& machines, const Line& line, std::ostream& out,
                                             bool screen, const volatile std::sig_atomic_t* signal);
/// The sentence, or the machine's packet; nothing of a failure.
Result<void> told(const Work& work, const Result<nlohmann::ordered_json>& reply, const std::string& sentence);
/// Whether the command takes each option of the line; null: no command, which takes those of all only.
Result<void> check_options(const Command* command, const Line& line);
[[nodiscard]] std::string usage();
[[nodiscard]] std::string help_of(const Command& command);

/// What needs no machine: recordings that are there, or are being made.
[[nodiscard]] bool is_about_files(const Line& line);
Result<void> run_report_of_files(const Line& line, std::ostream& out);

} // namespace tappet::browser
