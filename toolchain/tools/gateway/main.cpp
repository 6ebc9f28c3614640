// tappet-gateway: the machines of this host for browsers, programs and Prometheus in the network.
#include "toolchain/tools/gateway/program.hpp"
#include "toolchain/tools/gateway/user_command.hpp"
#include "toolchain/version.hpp"

#include <iostream>

#include <termios.h>
#include <unistd.h>

namespace {

/// Hides what is typed at a terminal while it lives.
class NoEcho {
public:
    NoEcho() : is_terminal_{::tcgetattr(STDIN_FILENO, &before_) == 0} {
        termios quiet = before_;
        quiet.c_lflag &= ~static_cast<tcflag_t>(ECHO);
        if (is_terminal_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &quiet);
    }
    ~NoEcho() {
        if (is_terminal_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
    }
    NoEcho(const NoEcho&) = delete;
    NoEcho& operator=(const NoEcho&) = delete;

private:
    termios before_{};
    bool is_terminal_;
};

std::string usage() {
    return "tappet-gateway: the machines of this host for browsers, programs and Prometheus in the "
           "network.\n\n"
           "  tappet-gateway [OPTION...]     serves\n" +
           std::string{tappet::network::user_usage} + "\n" +
           tappet::usage_of(tappet::network::gateway_options) +
           "\nExit codes: 0 ended by a signal, or done; 2 it could not start, or a wrong command line.\n";
}

} // namespace

int main(int count, char** arguments) {
    using namespace tappet::network;
    if (tappet::prints_version(count, arguments, "tappet-gateway")) return 0;
    const auto fail = [](const std::string& fault) {
        return std::cerr << "tappet-gateway: " << fault << "\n", 2;
    };
    const std::vector<std::string_view> words(arguments + 1, arguments + count);
    const auto line = tappet::read_command_line(gateway_options, words, tappet::Others::words);
    if (!line) return fail(line.error());
    if (line->has("--help")) return std::cout << usage(), 0;
    if (!line->words.empty() && line->words.front() == "user") {
        const NoEcho quiet;
        return run_user_command(std::span{line->words}.subspan(1), std::string{line->text("--users")},
                                std::cin, std::cout, std::cerr);
    }
    if (!line->words.empty())
        return fail("word " + std::string{line->words.front()} + " is unknown; see --help");
    const auto options = read_options(*line);
    if (!options) return fail(options.error());
    return serve(*options, std::cout, std::cerr);
}
