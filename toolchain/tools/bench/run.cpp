// SPDX-License-Identifier: Apache-2.0
// tappet-bench: runs one scenario on the bench, from the command line. Exit code: that of the guest's first
// failing command, 0 if none failed, 125 if the bench itself did not work.

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "toolchain/tools/bench/bench.hpp"
#include "toolchain/version.hpp"

namespace tappet::bench {
namespace {

constexpr int bench_fault = 125;

constexpr std::string_view usage = R"(usage: tappet-bench OPTION...
  --run COMMAND          run in the guest, in order; may be given often. "COMMAND &" runs in the background,
                         "- COMMAND" may fail. Also: @sleep S, @write PATH TEXT, @link NAME up|down,
                         @signal NAME TERM|INT|KILL|STOP|CONT|USR1|HUP, @wait NAME [while OTHER]
  --file HOST=GUEST      a file or folder for the guest; programs bring their shared libraries. The box is of the
                         architecture of the first program: x86-64 or aarch64
  --board                all that a machine finds on the board "bench": can0 to can2, io and panel with 32 lines,
                         and real-time threads that nobody throttles
  --tool NAME            a program of this machine for the guest's /bin; python3 brings its standard library
  --can NAME             a virtual CAN interface
  --can-card sja1000|ctucan   two emulated CAN controllers on one bus, of classical CAN or of CAN FD; Linux names
                         their interfaces, which are down
  --gpio-chip NAME:LINES simulated GPIO: /dev/NAME, its outside at /sim/NAME/sim_gpioN/pull and .../value
  --camera               a camera, Linux's vivid: /dev/video0
  --set PATH=VALUE       written before the first command, e.g. /proc/sys/vm/swappiness=0
  --unthrottled          nothing takes the processor from real-time threads, on any kernel
  --collect GUEST=HOST   a file copied out at the end
  --kernel rt|rt-6.12|plain   with PREEMPT_RT (default), a later one with it, or without real-time
  --clock instructions|host   guest time from executed instructions (default; steady) or from the host
  --cpus N               processors of the guest (default 1; more only with --clock host)
  --memory MIB           memory of the guest (default 256)
  --append TEXT          more kernel arguments
  --timeout S            of wall time from the first command on (default 120)
  --init FILE            PID 1 (default: bench-init, or bench-init-aarch64, beside this program)
  --verbose              boot and total time at the end
  --keep                 leave the working folder in the temporary folder
)";

[[noreturn]] void refuse(const std::string& what) {
    std::fprintf(stderr, "tappet-bench: %s\n%s", what.c_str(), std::string(usage).c_str());
    std::exit(bench_fault);
}

std::pair<std::string, std::string> parts(const std::string& option, const std::string& value,
                                          char separator) {
    const std::size_t at = value.find(separator);
    if (at == std::string::npos || at == 0 || at + 1 == value.size())
        refuse(option + " needs two parts with '" + separator + "' between them, not '" + value + "'");
    return {value.substr(0, at), value.substr(at + 1)};
}

unsigned number(const std::string& option, const std::string& value) {
    unsigned result = 0;
    const char* end = value.data() + value.size();
    if (const auto [at, error] = std::from_chars(value.data(), end, result);
        error != std::errc{} || at != end) {
        refuse(option + " needs a number, not '" + value + "'");
    }
    return result;
}

struct Request {
    Scenario scenario;
    bool verbose = false;
};

// Returns false if the option takes no value.
bool take(Request& request, const std::string& option, const std::string& value) {
    Scenario& scenario = request.scenario;
    if (option == "--run") {
        scenario.commands.push_back(value);
    } else if (option == "--file") {
        const auto [host, guest] = parts(option, value, '=');
        scenario.files.push_back({host, guest});
    } else if (option == "--tool") {
        scenario.tools.push_back(value);
    } else if (option == "--can") {
        scenario.can.push_back(value);
    } else if (option == "--can-card" && (value == "sja1000" || value == "ctucan")) {
        scenario.can_cards.push_back(value);
    } else if (option == "--gpio-chip") {
        const auto [name, lines] = parts(option, value, ':');
        scenario.gpio.push_back({name, number(option, lines)});
    } else if (option == "--set") {
        const auto [path, text] = parts(option, value, '=');
        scenario.settings.push_back({path, text});
    } else if (option == "--collect") {
        const auto [guest, host] = parts(option, value, '=');
        scenario.collect.push_back({host, guest});
    } else if (option == "--kernel") {
        scenario.kernel = value;
    } else if (option == "--clock" && (value == "instructions" || value == "host")) {
        scenario.clock = value == "host" ? Clock::host : Clock::instructions;
    } else if (option == "--cpus") {
        scenario.processors = number(option, value);
    } else if (option == "--memory") {
        scenario.memory_mib = number(option, value);
    } else if (option == "--append") {
        scenario.kernel_arguments = value;
    } else if (option == "--timeout") {
        scenario.timeout_s = number(option, value);
    } else if (option == "--init") {
        scenario.init = value;
    } else {
        return false;
    }
    return true;
}

Request parse(int count, char** arguments) {
    if (prints_version(count, arguments, "tappet-bench")) std::exit(0);
    Request request;
    for (int i = 1; i < count; ++i) {
        const std::string option = arguments[i];
        if (option == "--help") {
            std::fputs(std::string(usage).c_str(), stdout);
            std::exit(0);
        } else if (option == "--verbose") {
            request.verbose = true;
        } else if (option == "--keep") {
            request.scenario.keep = true;
        } else if (option == "--camera") {
            request.scenario.camera = true;
        } else if (option == "--unthrottled") {
            request.scenario.unthrottled = true;
        } else if (option == "--board") {
            add_board(request.scenario);
        } else if (i + 1 >= count) {
            refuse("'" + option + "' is unknown or lacks its value");
        } else if (!take(request, option, arguments[++i])) {
            refuse("'" + option + " " + arguments[i] + "' is unknown");
        }
    }
    if (request.scenario.commands.empty()) refuse("there is nothing to run; give --run");
    return request;
}

int main(int count, char** arguments) {
    const Request request = parse(count, arguments);
    const Outcome outcome = run(request.scenario, [](std::string_view bytes) {
        std::fwrite(bytes.data(), 1, bytes.size(), stdout);
        std::fflush(stdout);
    });
    if (request.verbose) {
        std::fprintf(stderr, "tappet-bench: %.1f s to the first command, %.1f s in all\n",
                     outcome.boot_wall_s, outcome.total_wall_s);
    }
    if (!outcome.completed) {
        std::fprintf(stderr, "tappet-bench: %s\n", outcome.fault.c_str());
        return bench_fault;
    }
    return outcome.exit_code;
}

} // namespace
} // namespace tappet::bench

int main(int count, char** arguments) { return tappet::bench::main(count, arguments); }
