// The program as a function of a command line and its output streams; main and the tests call it.
#pragma once

#include "toolchain/tools/browser/commands.hpp"

namespace tappet::browser {

/// How the program was called, and its access to the terminal.
struct Surroundings {
    std::ostream& out;
    std::ostream& errors;
    bool screen = false; ///< the watch view may draw
    bool interactive =
        false; ///< without a command there is a prompt; otherwise lines come from standard input
    std::string history_file{};
    StopFlag* signal = nullptr; ///< the last signal; reset to 0 before each typed line
};

/// Returns the exit code, as usage() lists them.
[[nodiscard]] int run_program(std::span<const std::string> words, Surroundings& surroundings);

/// Parses a line and checks its command and its options, without a machine; prints help. Returns the line, or
/// the exit code if it is done.
[[nodiscard]] std::expected<Line, int> accept_line(std::span<const std::string> words, std::ostream& out,
                                                   std::ostream& errors);
/// Prints the failure, as one JSON object if `json`. Returns the exit code.
int tell_failure(std::ostream& errors, const Failure& failure, bool json);

/// One line of a user elsewhere, which a server runs in a thread of its own. It reaches the machines and the
/// black boxes of two directories, and no other file or socket of this host.
struct RemoteLine {
    std::span<const std::string> words; ///< as behind tappet-browse; none: which machines are there
    std::string directory;              ///< of the machines' sockets
    std::string black_boxes;            ///< directory of the machines' black boxes; empty: none is shown
    User user;
    Files& files;
    std::ostream& out;
    std::ostream& errors;
    const StopFlag& stop;         ///< the line then ends within most_remote_patience
    std::optional<Size> screen{}; ///< of the user's terminal; none: lines only
};
/// The longest time that a remote line waits for a machine's answer.
inline constexpr std::chrono::milliseconds most_remote_patience{10'000};
/// The longest recording of cycles, which is in memory until its end.
inline constexpr std::chrono::milliseconds most_remote_cycles{60'000};

/// Returns the exit code, as usage() lists them. Several may run at once.
[[nodiscard]] int run_remote_line(const RemoteLine& remote);

} // namespace tappet::browser
