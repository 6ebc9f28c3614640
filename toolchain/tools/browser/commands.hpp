// The browser's commands: one table for the command line, the prompt, the help and the completion.
#pragma once

#include "toolchain/tools/browser/files.hpp"
#include "toolchain/tools/browser/machines.hpp"
#include "toolchain/tools/browser/screen.hpp"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace tappet::browser {

/// The names that a command takes; used by completion and by the check before a request.
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

/// Treatment of a line that names no machine when there are several.
enum class Among {
    one,   ///< the line must name one
    each,  ///< without an argument it runs for each machine in turn
    values ///< each argument may belong to another machine
};

/// Which arguments are names in a machine; in Among::values all of them are.
enum class Names {
    none, ///< words of a line, or files
    first,
    second,
    every_other,
    behind_action ///< of behaviour
};

/// The part of a line for one machine.
struct Part {
    Session* session = nullptr;
    std::vector<std::string> names{};
};

/// Where a line's output goes, where its files are, and how it is stopped.
struct Means {
    std::ostream& out;
    Files& files;
    const StopFlag* signal = nullptr; ///< not 0 once the user wants to stop
    bool screen = false;              ///< `out` is a terminal that supports drawing
    std::optional<Size> far_screen{}; ///< its size, if it is not this program's own terminal

    /// Returns whether to stop; checked between two pictures and while waiting.
    [[nodiscard]] bool stopped() const { return signal != nullptr && signal->load() != 0; }
    /// Waits, but not beyond a stop.
    void pause(std::chrono::milliseconds time) const;
};

struct Work : Means {
    Session& session;
    const Line& line;
    std::span<const Part> among{}; ///< owners of the argument names, if not the session's

    /// Returns the words after the command's name.
    [[nodiscard]] std::span<const std::string> arguments() const { return std::span{line.words}.subspan(1); }
    /// Returns the arguments, machine by machine.
    [[nodiscard]] std::vector<Part> parts() const {
        if (!among.empty()) return {among.begin(), among.end()};
        return {{&session, {line.words.begin() + 1, line.words.end()}}};
    }
    /// Returns the prefix of the machine's own names when there are several machines.
    [[nodiscard]] const std::string& place() const { return session.map().place(); }
};

using Run = Result<void>(Work& work);

/// A command. Help, refusals and completion read its options from its usage, each as "[--option".
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
/// Runs the line's command. The line must have words.
Result<void> run_command(Work& work);
/// Returns whether the argument of that number, from 0, is a name in a machine.
[[nodiscard]] bool is_name(const Command& command, std::span<const std::string> arguments,
                           std::size_t argument);
/// Returns the line as one request, with the machine's own names.
[[nodiscard]] std::string request_of(const Work& work);
/// A machine's packet for programs: without internal fields; among several, with the machine's name.
[[nodiscard]] std::string packet_text(const Work& work, nlohmann::ordered_json packet);
/// Returns the facet, or why this command cannot take it, with the nearest name.
Result<FoundFacet> find_facet(const MapReader& map, Takes takes, std::string_view name);
/// Returns every name that a command accepts.
[[nodiscard]] std::vector<std::string> names_for(const MapReader& map, Takes takes);
/// The values that a line names, for one machine; a component's name means all of its values.
struct Seen {
    Session* session = nullptr;
    std::vector<std::uint32_t> facets{};
};
Result<std::vector<Seen>> find_seen(const Work& work);
/// Runs the line on its machine or machines. Returns the failures, machine by machine; empty: none.
[[nodiscard]] std::vector<Failure> run_among(Machines& machines, const Line& line, const Means& means);
/// Prints the machines, one a line, and the status of each. Returns the failures like run_among.
[[nodiscard]] std::vector<Failure> list_machines(Machines& machines, const Line& line, const Means& means);
/// Prints the sentence, or the machine's packet; prints nothing on failure.
Result<void> told(const Work& work, const Result<nlohmann::ordered_json>& reply, const std::string& sentence);
/// Checks that the command takes each option of the line; null: no command, so only common options.
Result<void> check_options(const Command* command, const Line& line);
[[nodiscard]] std::string usage();
[[nodiscard]] std::string help_of(const Command& command);

/// Returns true for commands that need no machine: about recordings that exist, or are being made.
[[nodiscard]] bool is_about_files(const Line& line);
Result<void> run_report_of_files(const Line& line, const Means& means);

} // namespace tappet::browser
