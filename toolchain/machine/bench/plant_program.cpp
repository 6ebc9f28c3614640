// Opens the plant's ends as the machine's binding says, and advances the plant.
#include "toolchain/machine/bench/plant_program.hpp"

#include "drivers/hardware/opened.hpp"
#include "drivers/plant/bench_kinds.hpp"
#include "kernel/base/value_text.hpp"
#include "kernel/machine/check/board.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/notify.hpp"
#include "toolchain/version.hpp"

#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <sched.h>
#include <sys/mman.h>
#include <time.h>

namespace tappet {

namespace {

enum Ending : int { ended_well = 0, plant_at_fault = 1, wrong_set_up = 2 };

/// SCHED_FIFO: above all other work of the box, but below the machine. Not above the machine: gpio-sim
/// reports an edge from a thread of this priority, and two edges before that thread runs merge into one.
constexpr int plant_priority = 1;

volatile std::sig_atomic_t told_to_end = 0;
volatile std::sig_atomic_t usr1_came = 0;

/// A fault of the wires, not of the plant: at a time, for a while.
struct Outage {
    Duration at = Duration::max();
    Duration lasts{};
};

struct Options {
    std::uint64_t seed = 1;
    std::string report{};    ///< a file; empty: standard output
    Duration period = 200us; ///< how often the wires are polled
    Outage server_stop{};    ///< every Modbus server is down
    Duration bus_off_at = Duration::max();
    Duration die_at = Duration::max(); ///< killed, without a report
    bool help = false;
    std::vector<std::pair<std::string_view, std::string_view>> of_plant{};
};

constexpr const char* usage =
    "  --seed N                seed of the plant (default 1)\n"
    "  --report FILE           writes its measurements to FILE as JSON (default: standard output)\n"
    "  --period T              polls the wires with this period, 50us..10ms (default 200us)\n"
    "  --help                  this text\n"
    "the wires themselves: --stop-servers-at T/DURATION --bus-off-at T --die-at T\n";

template <class T>
bool read(std::string_view word, T& into, T least, T most) {
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || value < least || value > most)
        return false;
    into = value;
    return true;
}
bool read(std::string_view word, Duration& into) {
    alignas(Duration) std::byte bytes[sizeof(Duration)];
    if (!parse_value(*type_id<Duration>, word, bytes).empty()) return false;
    std::memcpy(&into, bytes, sizeof into);
    return into >= Duration::zero();
}
bool read(std::string_view word, Outage& into) {
    const std::size_t slash = word.find('/');
    return slash != word.npos && read(word.substr(0, slash), into.at) &&
           read(word.substr(slash + 1), into.lasts);
}

/// Parses the words; returns empty when all are right. Passes unknown options on to the plant.
Sentence parse(int count, char** words, Options& to) {
    for (int i = 1; i < count; ++i) {
        const std::string_view word = words[i];
        if (word == "--help") {
            to.help = true;
            continue;
        }
        if (i + 1 == count) return Sentence{"option ", word, " is unknown, or needs a value; see --help"};
        const std::string_view value = words[++i];
        bool right = true;
        if (word == "--seed")
            right = read(value, to.seed, std::uint64_t{0}, ~std::uint64_t{0});
        else if (word == "--report")
            to.report = value;
        else if (word == "--period")
            right = read(value, to.period) && to.period >= 50us && to.period <= 10ms;
        else if (word == "--stop-servers-at")
            right = read(value, to.server_stop);
        else if (word == "--bus-off-at")
            right = read(value, to.bus_off_at);
        else if (word == "--die-at")
            right = read(value, to.die_at);
        else
            to.of_plant.emplace_back(word, value);
        if (!right) return Sentence{"option ", word, " does not take \"", value, "\"; see --help"};
    }
    return {};
}

/// The plant's ends of all wires of one machine on one board.
class BenchWires {
public:
    Sentence open(const MachineView& machine, const Board& board, const Binding& binding) {
        for (const ComponentRow& row : machine.components) {
            if (row.type->device_map == nullptr || row.type->device_kind == nullptr) continue;
            std::unique_ptr<BenchEnd> end = BenchKinds<Kinds>::make(*row.type->device_kind);
            if (end == nullptr) continue; // its kind has no end here: the plant refuses if it wants one
            if (auto opened = end->open(place_of(row, board, binding)); !opened)
                return Sentence{"device \"", row.device, "\": ", opened.error()};
            wires_.push_back(end->provided(row.device));
            ends_.push_back(std::move(end));
        }
        return {};
    }
    [[nodiscard]] std::span<const ProvidedDevice> all() const { return wires_; }
    Sentence listen() {
        for (const auto& each : ends_)
            if (auto listens = each->listen(); !listens) return listens.error();
        return {};
    }
    void look(Time now) {
        for (const auto& each : ends_) each->look(now);
    }
    void announce_bus_off() {
        for (const auto& each : ends_) each->announce_bus_off();
    }
    void set_power(bool on) {
        for (const auto& each : ends_) each->set_power(on);
    }
    [[nodiscard]] std::uint64_t sum(std::uint64_t (BenchEnd::*count)() const noexcept) const {
        std::uint64_t sum = 0;
        for (const auto& each : ends_) sum += (*each.*count)();
        return sum;
    }

private:
    template <class... End>
    struct Kinds {
        static std::unique_ptr<BenchEnd> make(const DeviceKind& kind) {
            std::unique_ptr<BenchEnd> made;
            ((kind.name == End::kind.name ? made = std::make_unique<End>() : made), ...);
            return made;
        }
    };
    std::vector<std::unique_ptr<BenchEnd>> ends_{};
    std::vector<ProvidedDevice> wires_{};
};

class Program {
public:
    Program(const char* name, Plant& plant, BenchWires& wires, const Options& options)
        : name_{name}, plant_{plant}, wires_{wires}, options_{options} {}

    void run() {
        const Time start = clock_.now();
        Time last = start, next = never;
        while (told_to_end == 0 && !rested(last)) {
            if (usr1_came != 0) {
                usr1_came = 0;
                plant_.told();
            }
            // Does not also wake when the plant wants to move: each wake-up costs the guest a process switch,
            // and a frame of a node has no exact time that the machine knows.
            const Time wake = std::min(last + options_.period, std::max(next, last + 20us));
            sleep_until(wake);
            const Time now = clock_.now();
            latest_ = std::max(latest_, now - wake);
            wires_.look(now);
            static_cast<void>(plant_.advance(now));
            next = plant_.next_edge();
            trouble_the_wires(now - start);
            last = now;
        }
        std::fprintf(stderr, "%s: latest wake-up %lld us, frames not sent %llu, line failures %llu\n", name_,
                     static_cast<long long>(latest_ / 1us),
                     static_cast<unsigned long long>(wires_.sum(&BenchEnd::unsent)),
                     static_cast<unsigned long long>(wires_.sum(&BenchEnd::failures)));
    }

private:
    /// Leaves the machine time to show how it stopped.
    bool rested(Time now) {
        if (!plant_.is_done())
            done_since_ = never;
        else if (done_since_ == never)
            done_since_ = now;
        return done_since_ != never && now - done_since_ > 500ms;
    }
    static void sleep_until(Time at) {
        const std::int64_t ns = to_ns(at);
        const timespec until{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    }
    void trouble_the_wires(Duration since_start) {
        if (since_start >= options_.die_at) std::raise(SIGKILL);
        if (since_start >= options_.bus_off_at && !bus_off_told_) {
            bus_off_told_ = true;
            wires_.announce_bus_off();
        }
        const Outage& stop = options_.server_stop;
        if (stop.at != Duration::max())
            wires_.set_power(since_start < stop.at || since_start >= stop.at + stop.lasts);
    }

    const char* name_;
    Plant& plant_;
    BenchWires& wires_;
    const Options& options_;
    os::Clock clock_{os::Clock::Kind::real};
    bool bus_off_told_ = false;
    Time done_since_ = never;
    Duration latest_{};
};

void become_real_time(const char* name) {
    sched_param parameter{};
    parameter.sched_priority = plant_priority;
    if (sched_setscheduler(0, SCHED_FIFO, &parameter) != 0 || mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
        std::fprintf(stderr,
                     "%s: SCHED_FIFO %d: %s; it will be late when other programs compute; start it as root\n",
                     name, plant_priority, std::strerror(errno));
}

void listen_to_signals() {
    struct sigaction action{};
    action.sa_handler = [](int) { told_to_end = 1; };
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
    action.sa_handler = [](int) { usr1_came = 1; };
    sigaction(SIGUSR1, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN); // a client that disconnects must not end this process
}

bool write_report(const Plant& plant, const std::string& path) {
    std::string text(64 * 1024, '\0');
    JsonText json{text};
    json.open('{');
    plant.report(json);
    json.close('}').raw("\n");
    std::FILE* const file = path.empty() ? stdout : std::fopen(path.c_str(), "w");
    if (file == nullptr || json.size() == 0) return false;
    const bool written = std::fwrite(text.data(), 1, json.size(), file) == json.size();
    return (file == stdout ? std::fflush(file) : std::fclose(file)) == 0 && written;
}

} // namespace

int run_plant(const MachineView& machine, const Board& board, const Binding& binding,
              const std::function<std::unique_ptr<Plant>(std::uint64_t seed)>& make_plant, int count,
              char** words) {
    const std::string name = std::string{machine.name} + "-plant";
    if (prints_version(count, words, name)) return ended_well;
    const auto fail = [&name](const Sentence& why) {
        std::fprintf(stderr, "%s: %s\n", name.c_str(), std::string{why.view()}.c_str());
        return wrong_set_up;
    };
    Options options;
    if (const Sentence fault = parse(count, words, options); !fault.empty()) return fail(fault);
    const std::unique_ptr<Plant> plant = make_plant(options.seed);
    if (options.help) {
        std::fprintf(
            stdout, "%s: simulates the machine's plant at the other end of the wires of board \"%s\"\n%s%s",
            name.c_str(), std::string{board.name}.c_str(), usage, std::string{plant->usage()}.c_str());
        return ended_well;
    }
    for (const auto& [option, value] : options.of_plant) {
        Sentence fault;
        if (!plant->take_option(option, value, fault))
            return fail(Sentence{"option ", option, " is unknown; see --help"});
        if (!fault.empty()) return fail(Sentence{"option ", option, ": ", fault});
    }
    // Its ends are opened where the binding says. Not the whole table: nobody runs it here, and it may be no
    // more than the wires of several machines.
    if (const Sentence fault = checks::check_each_device(machine, board, binding); !fault.empty())
        return fail(Sentence{machine.name, ": ", fault});
    listen_to_signals();
    BenchWires wires;
    if (const Sentence fault = wires.open(machine, board, binding); !fault.empty()) return fail(fault);
    if (const Sentence fault = plant->connect(wires.all()); !fault.empty()) return fail(fault);
    static_cast<void>(
        plant->advance(os::Clock{os::Clock::Kind::real}.now())); // clients must not read unset values
    if (const Sentence fault = wires.listen(); !fault.empty()) return fail(fault);
    become_real_time(name.c_str());
    os::notify_starter("X_TAPPET_PLANT=ready");
    Program{name.c_str(), *plant, wires, options}.run();
    if (!write_report(*plant, options.report))
        return fail(Sentence{"the report cannot be written to \"", std::string_view{options.report}, "\""});
    if (const Sentence fault = plant->fault(); !fault.empty()) {
        std::fprintf(stderr, "%s: %s\n", name.c_str(), std::string{fault.view()}.c_str());
        return plant_at_fault;
    }
    return ended_well;
}

} // namespace tappet
