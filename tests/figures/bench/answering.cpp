// answering PAIRS FILE: in the guest. Asks the machine and the bare program in turns, in a random order, and
// writes a line for each pair: the request, and both response times in ns.
#include "drivers/can/socket_can.hpp"
#include "drivers/gpio/lines.hpp"
#include "drivers/hardware/hardware.hpp"
#include "kernel/base/random.hpp"
#include "kernel/machine/firmware.hpp"
#include "kernel/machine/worlds/real_world.hpp"
#include "tests/figures/bench/bare.hpp"
#include "tests/figures/bench/machine.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fcntl.h>
#include <linux/can.h>
#include <poll.h>
#include <sched.h>
#include <unistd.h>

namespace tappet::figures::bench {

namespace {

constexpr int patience_ms = 1000;
constinit os::Clock machine_clock{os::Clock::Kind::real};

std::int64_t now_ns() { return to_ns(os::Clock::monotonic()); }

int fail(const char* what) {
    std::printf("answering: %s\n", what);
    return 1;
}

/// Nanoseconds from before the request is written until its answer is read; -1: no answer came.
std::int64_t ask_frame(int socket, std::uint32_t request, std::uint32_t answer, unsigned char number) {
    can_frame frame{};
    frame.can_id = request;
    frame.can_dlc = 8;
    frame.data[0] = number;
    const std::int64_t begin = now_ns();
    if (write(socket, &frame, sizeof frame) != sizeof frame) return -1;
    while (true) {
        pollfd polled{socket, POLLIN, 0};
        if (poll(&polled, 1, patience_ms) != 1) return -1;
        if (read(socket, &frame, sizeof frame) != sizeof frame) return -1;
        const std::int64_t end = now_ns();
        if (frame.can_id == answer && frame.data[0] == number) return end - begin;
    }
}

/// One line of the simulated chip from outside.
struct Outside {
    int pull = -1;
    int value = -1;
    void open(unsigned in, unsigned out) {
        const std::string chip = "/sim/panel/sim_gpio";
        pull = ::open((chip + std::to_string(in) + "/pull").c_str(), O_WRONLY);
        value = ::open((chip + std::to_string(out) + "/value").c_str(), O_RDONLY);
    }
    /// Nanoseconds from before the edge until the output follows; -1: it did not.
    [[nodiscard]] std::int64_t ask(bool high) const {
        const char* word = high ? "pull-up" : "pull-down";
        const auto length = static_cast<ssize_t>(high ? 7 : 9);
        const std::int64_t begin = now_ns();
        if (pwrite(pull, word, static_cast<std::size_t>(length), 0) != length) return -1;
        while (true) {
            char level = 0;
            if (pread(value, &level, 1, 0) != 1) return -1;
            const std::int64_t end = now_ns();
            if (level == (high ? '1' : '0')) return end - begin;
            if (end - begin > std::int64_t{patience_ms} * 1'000'000) return -1;
        }
    }
};

struct Pair {
    std::int64_t ours = -1, bare = -1;
};

template <class Ours, class Bare> Pair in_turns(Random& random, Ours&& ours, Bare&& bare) {
    Pair pair;
    const bool bare_first = random.below(2) == 0;
    if (bare_first) pair.bare = bare();
    pair.ours = ours();
    if (!bare_first) pair.bare = bare();
    return pair;
}

int write_pairs(const char* path, const std::vector<Pair>& frames, const std::vector<Pair>& edges) {
    std::FILE* file = std::fopen(path, "w");
    if (file == nullptr) return fail("its file cannot be written");
    for (const Pair& each : frames)
        std::fprintf(file, "can %lld %lld\n", static_cast<long long>(each.ours),
                     static_cast<long long>(each.bare));
    for (const Pair& each : edges)
        std::fprintf(file, "gpio %lld %lld\n", static_cast<long long>(each.ours),
                     static_cast<long long>(each.bare));
    return std::fclose(file) == 0 ? 0 : fail("its file cannot be written");
}

int run(int count, char** words) {
    if (count != 3) return fail("usage: answering PAIRS FILE");
    const std::size_t pairs = std::strtoul(words[1], nullptr, 10);
    static Hardware<table> hardware;
    using Made = Firmware<table, board, bound>;
    if (const auto opened = hardware.open(Made::machine()); !opened) return fail(opened.error().characters);
    static MachineInstance instance{Made::machine(), machine_clock};
    if (const auto configured = instance.configure(hardware.provided()); !configured)
        return fail(configured.error().characters);

    const auto priority = [](std::size_t activity) {
        return instance.machine().plan.activities[activity].priority;
    };
    if (!start_bare_can("can0", wire::bare_request, wire::bare_answer, priority(0))) return 1;
    if (!start_bare_lines("/dev/panel", wire::bare_in, wire::bare_out, priority(1))) return 1;
    const int socket = open_can("can0", wire::answer, wire::bare_answer);
    Outside ours, bare;
    ours.open(wire::in, wire::out);
    bare.open(wire::bare_in, wire::bare_out);
    if (socket < 0 || ours.pull < 0 || ours.value < 0 || bare.pull < 0 || bare.value < 0)
        return fail("the other end of the wires is not there");
    std::vector<Pair> frames(pairs), edges(pairs);

    static RealWorld world{instance};
    static os::ArmingReport report{{board.only_warned.begin(), board.only_warned.end()}};
    const auto armed = world.arm(report, 2);
    if (!armed) return fail("the machine could not be armed");
    if (!world.start(*armed)) return fail(world.refusal().characters);
    sched_param parameters{};
    parameters.sched_priority = 1; // above everything else, below the machine and the bare program
    sched_setscheduler(0, SCHED_FIFO, &parameters);

    Random random{3};
    for (std::size_t i = 0; i < pairs; ++i) {
        usleep(500);
        const auto number = static_cast<unsigned char>(i);
        frames[i] = in_turns(
            random, [&] { return ask_frame(socket, wire::request, wire::answer, number); },
            [&] { return ask_frame(socket, wire::bare_request, wire::bare_answer, number); });
        const bool high = i % 2 == 0;
        edges[i] = in_turns(random, [&] { return ours.ask(high); }, [&] { return bare.ask(high); });
    }
    const int hung = world.stop();
    const int written = write_pairs(words[2], frames, edges);
    std::fflush(stdout);
    std::_Exit(hung == 0 ? written : fail("a thread of the machine hung")); // the bare threads never end
}

} // namespace

} // namespace tappet::figures::bench

int main(int count, char** words) { return tappet::figures::bench::run(count, words); }
