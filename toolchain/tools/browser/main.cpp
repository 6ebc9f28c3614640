// tappet-browse: inspects a running machine, on the same box or behind a gateway, and requests changes
// (thesis 4.8).
#include "toolchain/tools/browser/far/client.hpp"
#include "toolchain/tools/browser/screen.hpp"
#include "toolchain/version.hpp"

#include <csignal>
#include <cstdlib>
#include <iostream>

#include <unistd.h>

namespace {

tappet::browser::StopFlag last_signal{0};

} // namespace

int main(int count, char** words) {
    using namespace tappet::browser;
    if (tappet::prints_version(count, words, "tappet-browse")) return 0;
    struct sigaction action{};
    action.sa_handler = [](int signal) { last_signal = signal; };
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
    const char* const home = std::getenv("HOME");
    Surroundings surroundings{std::cout, std::cerr};
    surroundings.screen = Screen::possible();
    surroundings.interactive = ::isatty(STDIN_FILENO) != 0;
    surroundings.history_file = home == nullptr ? "" : std::string{home} + "/.tappet_browse_history";
    surroundings.signal = &last_signal;
    const std::vector<std::string> line(words + 1, words + count);
    const auto call = parse_call(line);
    if (!call) {
        std::cerr << "tappet-browse: " << call.error() << "\n";
        return 2;
    }
    const auto open = [](const FarCall& far) {
        return FarWire::open(far.address, {far.ca, KnownBoxes::usual_file()}, std::cerr);
    };
    const int code = *call ? run_far_line(**call, surroundings, open) : run_program(line, surroundings);
    if (std::cout.flush()) return code;
    std::cerr << "tappet-browse: its output could not be written; is the disk full?\n";
    return code == 0 ? 2 : code;
}
