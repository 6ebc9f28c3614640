// The bench's plant: the simulated loom on SocketCAN, gpio-sim and Modbus TCP, in real time.
#include "apps/carpet_loom/plant/bench/can_wire.hpp"
#include "apps/carpet_loom/plant/bench/line_wire.hpp"
#include "apps/carpet_loom/plant/bench/modbus_wire.hpp"
#include "apps/carpet_loom/plant/bench/options.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <sched.h>
#include <sys/mman.h>
#include <time.h>

namespace tappet::loom {
namespace {

volatile std::sig_atomic_t told_to_end = 0;
volatile std::sig_atomic_t usr1_came = 0;

std::int64_t monotonic_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

void sleep_until_ns(std::int64_t ns) {
    const timespec until{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

int complain(const std::string& what) {
    std::fprintf(stderr, "carpet-loom-plant: %s\n", what.c_str());
    return 2;
}

int write_report(const Plant& plant, const std::string& path) {
    std::vector<char> text(64 * 1024);
    const std::size_t length = write_json(plant.report(), text);
    std::FILE* const file = path.empty() ? stdout : std::fopen(path.c_str(), "w");
    if (file == nullptr) return complain("report '" + path + "': " + std::strerror(errno));
    const bool written = std::fwrite(text.data(), 1, length, file) == length && std::fflush(file) == 0;
    if (file != stdout) std::fclose(file);
    return written ? 0 : complain("report '" + path + "': " + std::strerror(errno));
}

void become_real_time(int priority) {
    sched_param parameter{};
    parameter.sched_priority = priority;
    if (sched_setscheduler(0, SCHED_FIFO, &parameter) != 0 || mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
        std::fprintf(stderr, "carpet-loom-plant: --fifo %d: %s; running without\n", priority,
                     std::strerror(errno));
}

class Bench {
public:
    Bench(const Options& options, Plant& plant, CanWire& can, std::optional<LineWire>& lines,
          std::unique_ptr<ModbusWire>& modbus)
        : options_(options), plant_(plant), can_(can), lines_(lines), modbus_(modbus) {}

    void run() {
        const std::int64_t start = monotonic_ns();
        Time last{};
        Time slow{};
        while (told_to_end == 0 && !finished(last)) {
            if (awaits_usr1_ && usr1_came != 0) {
                awaits_usr1_ = false;
                options_.picks = std::max(options_.picks, plant_.picks() + options_.picks_after_usr1);
                plant_.end_at(options_.picks);
            }
            const Time wake = std::min(last + options_.period, std::max(plant_.next_timer(), last + 20us));
            sleep_until_ns(start + to_ns(wake));
            const Time now = at_ns(monotonic_ns() - start);
            latest_ = std::max(latest_, now - wake);
            if (lines_) lines_->read_outputs(plant_, last, now);
            can_.exchange(plant_, now);
            if (lines_) lines_->write_inputs(plant_);
            if (modbus_ && now >= slow) {
                modbus_->exchange(plant_.climate());
                slow = now + 10ms;
            }
            trouble_the_wires(now - Time{});
            last = now;
        }
        std::fprintf(stderr,
                     "carpet-loom-plant: latest wake-up %lld us, frames not sent %llu, line failures %llu\n",
                     static_cast<long long>(latest_ / 1us), static_cast<unsigned long long>(can_.unsent()),
                     static_cast<unsigned long long>(lines_ ? lines_->failures() : 0));
    }

private:
    bool finished(Time now) {
        if (awaits_usr1_ || options_.picks == 0 || plant_.picks() < options_.picks ||
            plant_.speed_rpm() != 0.0) {
            rested_since_ = now;
            return false;
        }
        return now - rested_since_ > 500ms; // the machine may still show its stop
    }

    void trouble_the_wires(Duration now) {
        if (now >= options_.die_at) std::raise(SIGKILL);
        const auto due = [now](Duration& at) {
            return now >= at && std::exchange(at, Duration::max()) <= now;
        };
        if (due(options_.bus_off_at)) can_.announce_bus_off();
        if (lines_ && due(options_.edge_burst_at)) lines_->flutter(wires::line::weft_detector, burst_edges);
        const Outage& stop = options_.modbus_stop;
        if (modbus_ && stop.at != Duration::max())
            modbus_->set_power(now < stop.at || now >= stop.at + stop.lasts);
    }

    static constexpr unsigned burst_edges = 400; // more than any buffer of events holds

    Options options_;
    Plant& plant_;
    CanWire& can_;
    std::optional<LineWire>& lines_;
    std::unique_ptr<ModbusWire>& modbus_;
    bool awaits_usr1_ = options_.picks_after_usr1 != 0;
    Time rested_since_{};
    Duration latest_{};
};

int run(int count, const char* const* words) {
    const auto options = parse_options(count, words);
    if (!options) return complain(options.error());
    if (options->help) {
        std::fputs(usage(), stdout);
        return 0;
    }
    struct sigaction action{};
    action.sa_handler = [](int) { told_to_end = 1; };
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
    action.sa_handler = [](int) { usr1_came = 1; };
    sigaction(SIGUSR1, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN); // a master that went away is no reason to die

    auto plant = std::make_unique<Plant>(options->settings, options->seed);
    auto can = CanWire::open(options->can);
    if (!can) return complain(can.error());
    std::optional<LineWire> lines;
    if (!options->gpio_chip.empty()) {
        auto opened = LineWire::open(options->gpio_chip);
        if (!opened) return complain(opened.error());
        lines.emplace(std::move(*opened));
    }
    std::unique_ptr<ModbusWire> modbus;
    if (options->modbus_port != 0) {
        auto opened = ModbusWire::open(options->modbus_address, options->modbus_port, plant->climate());
        if (!opened) return complain(opened.error());
        modbus = std::move(*opened);
    }
    if (options->fifo_priority > 0) become_real_time(options->fifo_priority);
    Bench(*options, *plant, *can, lines, modbus).run();
    return write_report(*plant, options->report);
}

} // namespace
} // namespace tappet::loom

int main(int count, char** words) { return tappet::loom::run(count, words); }
