// Reads /proc and /sys, and works without pause to find interruptions.
#include "tests/figures/report/surroundings.hpp"

#include "tests/figures/measure/ticks.hpp"
#include "tests/figures/measure/undisturbed.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <sys/utsname.h>

namespace tappet::figures {

namespace {

/// The first line of a file; empty when the file is missing or empty.
std::string first_line(const std::string& path) {
    std::ifstream file{path};
    std::string line;
    std::getline(file, line);
    return line;
}
/// The value of a line "name : value".
std::string value_in(const std::string& path, std::string_view name) {
    std::ifstream file{path};
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(name))
            if (const auto colon = line.find(':'); colon != line.npos)
                return line.substr(std::min(line.find_first_not_of(" \t", colon + 1), line.size()));
    return {};
}
std::string said_by(const std::string& command) {
    std::string line;
    std::FILE* const pipe =
        popen((command + " 2>/dev/null").c_str(), "r"); // NOLINT: no word of it is foreign
    if (pipe == nullptr) return line;
    std::array<char, 256> text{};
    if (std::fgets(text.data(), text.size(), pipe) != nullptr) line = text.data();
    pclose(pipe);
    while (!line.empty() && line.back() == '\n') line.pop_back();
    return line;
}
std::string or_else(const std::string& value, const char* otherwise) {
    return value.empty() ? otherwise : value;
}

std::string caches() {
    std::string all;
    for (int i = 0; i < 8; ++i) {
        const std::string cache = "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(i) + "/";
        const std::string size = first_line(cache + "size");
        if (size.empty()) break;
        const std::string type = first_line(cache + "type");
        all += (all.empty() ? "L" : ", L") + first_line(cache + "level") +
               (type == "Data"          ? "d "
                : type == "Instruction" ? "i "
                                        : " ") +
               size;
    }
    return or_else(all, "not told");
}
std::string memory() {
    const double kib = std::atof(value_in("/proc/meminfo", "MemTotal").c_str());
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f GiB", kib / 1024 / 1024);
    return text.data();
}
std::string virtualised() {
    if (value_in("/proc/cpuinfo", "flags").find(" hypervisor") == std::string::npos) return "no";
    const std::string name = said_by("systemd-detect-virt --vm");
    return name.empty() || name == "none" ? "yes: a guest of a hypervisor" : "yes: a guest of " + name;
}
std::string power() {
    const std::string governor = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
    const std::string idle = first_line("/sys/devices/system/cpu/cpuidle/current_driver");
    return "governor " + or_else(governor, "none that Linux sees") + ", idle driver " +
           or_else(idle, "none") +
           (std::filesystem::exists("/dev/cpu_dma_latency") ? ", latency lock available"
                                                            : ", no latency lock");
}

/// The multiplications of one block depend on each other: caches and memory do not affect its time.
void fixed_work() noexcept {
    std::uint64_t value = 0x9E3779B97F4A7C15;
    for (int i = 0; i < 20000; ++i) {
        value = value * value + 1;
        asm volatile("" : "+r"(value));
    }
}

struct Pauses {
    double count = 0, longest_ns = 0, all_ns = 0, ns = 0;
};
void look_for_pauses(double ns, Pauses& pauses) {
    constexpr double pause_ns = 1000;
    const double each = ns_per_tick();
    const std::uint64_t begin = ticks();
    std::uint64_t last = begin, now = begin;
    while (static_cast<double>(now - begin) * each < ns) {
        now = ticks();
        if (const double gap = static_cast<double>(now - last) * each; gap > pause_ns) {
            ++pauses.count;
            pauses.all_ns += gap;
            pauses.longest_ns = std::max(pauses.longest_ns, gap);
        }
        last = now;
    }
    pauses.ns += static_cast<double>(now - begin) * each;
}

} // namespace

std::vector<std::pair<std::string, std::string>> describe_machine() {
    utsname system{};
    uname(&system);
    const std::string realtime = first_line("/sys/kernel/realtime");
    std::string load = first_line("/proc/loadavg");
    if (const auto end = load.rfind(' '); end != load.npos) load.resize(end);
    return {
        {"processor", or_else(value_in("/proc/cpuinfo", "model name"), system.machine)},
        {"processors", std::to_string(std::thread::hardware_concurrency()) + " online, isolated: " +
                           or_else(first_line("/sys/devices/system/cpu/isolated"), "none")},
        {"virtual", virtualised()},
        {"caches", caches()},
        {"memory", memory()},
        {"kernel", std::string{system.sysname} + " " + system.release + ", " + system.version +
                       (realtime == "1" ? "" : " (no PREEMPT_RT)")},
        {"kernel command line", or_else(first_line("/proc/cmdline"), "not told")},
        {"clock source",
         or_else(first_line("/sys/devices/system/clocksource/clocksource0/current_clocksource"), "not told")},
        {"power", power()},
        {"real-time throttling", or_else(first_line("/proc/sys/kernel/sched_rt_runtime_us"), "?") +
                                     " us of each " +
                                     or_else(first_line("/proc/sys/kernel/sched_rt_period_us"), "?") + " us"},
        {"compiler of the figures", "g++ " __VERSION__ ", " TAPPET_FIGURES_FLAGS},
        {"other compiler", or_else(said_by("clang++-22 --version"), "clang++-22 is not installed")},
        {"load at the start (1, 5, 15 minutes; running/all)", load},
    };
}

std::string commit_of_tree() {
    const std::string commit = said_by("git log -1 --format='%h of %cs: %<(72,trunc)%s'");
    if (commit.empty()) return "unknown";
    return said_by("git status --porcelain -uno").empty() ? commit : commit + " (and changes)";
}

std::string local_time() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::array<char, 64> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S%z", &local);
    return text.data();
}

Noise measure_noise(int processor, double seconds) {
    const Undisturbed quiet{processor};
    Samples work;
    Pauses pauses;
    // Half of the time it works, half it reads the clock, in spans short enough for the throttling of
    // real-time threads.
    constexpr double span_ns = 50e6;
    for (double spent = 0; spent < seconds * 1e9; spent += 2 * span_ns) {
        fixed_work();
        double busy = 0;
        while (busy < span_ns) {
            const std::uint64_t first = ticks();
            fixed_work();
            const double took = static_cast<double>(ticks() - first) * ns_per_tick();
            work.add(took);
            busy += took;
        }
        rest_after(span_ns);
        look_for_pauses(span_ns, pauses);
        rest_after(span_ns);
    }
    Noise noise;
    const double median = work.median();
    noise.work_us = median / 1000;
    noise.spread_percent = (work.quantile(0.99) / median - 1) * 100;
    noise.worst_percent = (work.max() / median - 1) * 100;
    noise.gaps_per_second = pauses.count / pauses.ns * 1e9;
    noise.longest_gap_us = pauses.longest_ns / 1000;
    noise.lost_percent = pauses.all_ns / pauses.ns * 100;
    return noise;
}

Meter::Meter() : begin_(read()) {}

Meter::Counters Meter::read() {
    Counters counters;
    counters.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    std::ifstream file{"/proc/stat"};
    for (std::string line; std::getline(file, line);) {
        std::istringstream words{line};
        std::string name;
        words >> name;
        if (name == "cpu") {
            double user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, soft = 0;
            words >> user >> nice >> system >> idle >> wait >> irq >> soft >> counters.steal;
            counters.busy = user + nice + system + irq + soft;
            counters.all = counters.busy + idle + wait + counters.steal;
        } else if (name == "intr") {
            words >> counters.interrupts;
        } else if (name == "ctxt") {
            words >> counters.switches;
        }
    }
    return counters;
}

Usage Meter::usage() const {
    const Counters end = read();
    const double seconds = std::max(1e-9, end.seconds - begin_.seconds);
    const double all = std::max(1.0, end.all - begin_.all);
    return {seconds, (end.busy - begin_.busy) / all * 100, (end.steal - begin_.steal) / all * 100,
            (end.switches - begin_.switches) / seconds, (end.interrupts - begin_.interrupts) / seconds};
}

} // namespace tappet::figures
