// SPDX-License-Identifier: Apache-2.0
// While the loom weaves, a fault ends it or a part of it at a random moment, or nearly does; the wires are
// judged.
//
//   loom_campaign [--runs N] [--seed S] [--only FAULT] [--no-guardian]
//
// The lines are pulled to their unsafe levels, so that a released line shows. Times are the guest's. Exit 1:
// a run was not safe in time, or the loom did not weave again.
#include "tests/bench/campaign/held_output.hpp"
#include "tests/bench/loom/loom_rig.hpp"

#include <array>
#include <cstring>
#include <iostream>
#include <map>
#include <net/if.h>
#include <random>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>

namespace tappet::bench {
namespace {

// For a hang: the life_sign_within of the board. For a bus that is down: the time-out of the drives. For a
// request of a browser: until the browser has started, and the loom stands.
constexpr auto death = 10ms, hang = 210ms, silence = 110ms, orderly = 110ms, guardian_hangs = 1310ms,
               exhausted = 1500ms, asked = 3000ms;
constexpr auto weaves_on = 2s; // at least this long, when the fault must not disturb it

/// Brake on, valve closed: read from files that stay open, so that reading costs the machine little.
class SafeLines {
public:
    [[nodiscard]] bool now() const { return is_high(brake_) && !is_high(valve_); }

private:
    static int open_level(unsigned line) {
        return ::open(("/sim/io/sim_gpio" + std::to_string(line) + "/value").c_str(), O_RDONLY | O_CLOEXEC);
    }
    static bool is_high(int file) {
        char level = 0;
        return ::pread(file, &level, 1, 0) == 1 && level == '1';
    }
    int brake_ = open_level(wires::line::brake), valve_ = open_level(wires::line::weft_release);

public:
    SafeLines() = default;
    SafeLines(const SafeLines&) = delete;
    SafeLines& operator=(const SafeLines&) = delete;
    ~SafeLines() {
        ::close(brake_);
        ::close(valve_);
    }
};

bool be_fifo(int priority) {
    sched_param parameter{};
    parameter.sched_priority = priority;
    return ::sched_setscheduler(0, priority == 0 ? SCHED_OTHER : SCHED_FIFO, &parameter) == 0;
}

/// Above every activity, below the guardian.
void spin(std::chrono::milliseconds time) {
    if (::fork() != 0) return;
    be_fifo(90);
    for (const auto end = std::chrono::steady_clock::now() + time; std::chrono::steady_clock::now() < end;) {
    }
    ::_exit(0);
}

/// Takes all free memory, until the kernel kills it. Runs below every activity: above them, it keeps the
/// kernel from finding memory, and the watchdog resets the box.
void exhaust_memory() {
    if (::fork() != 0) return;
    be_fifo(0);
    constexpr std::size_t piece = 4 << 20;
    for (;;)
        if (void* memory = ::mmap(nullptr, piece, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
            memory != MAP_FAILED)
            std::memset(memory, 1, piece);
}

void set_interface(const char* name, bool up) {
    const int file = ::socket(AF_INET, SOCK_DGRAM, 0);
    ifreq request{};
    std::strncpy(request.ifr_name, name, sizeof request.ifr_name - 1);
    ::ioctl(file, SIOCGIFFLAGS, &request);
    request.ifr_flags = static_cast<short>(up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP);
    ::ioctl(file, SIOCSIFFLAGS, &request);
    ::close(file);
}

constexpr const char* chip = "/sys/kernel/config/gpio-sim/io";
/// Runs below every activity: above them, the kernel's work for it keeps them from running.
void unplug_chip() {
    be_fifo(0);
    std::ofstream{std::string{chip} + "/live"} << 0;
}
/// It may come as another device.
void plug_chip() {
    std::ofstream{std::string{chip} + "/live"} << 1;
    const auto name = [](const std::string& file) {
        std::string word;
        std::ifstream{chip + file} >> word;
        return word;
    };
    const std::string device = name("/bank0/chip_name");
    for (const auto& [link, at] :
         {std::pair{"/dev/io", "/dev/" + device},
          std::pair{"/sim/io", "/sys/devices/platform/" + name("/dev_name") + "/" + device}}) {
        ::unlink(link);
        if (::symlink(at.c_str(), link) != 0) std::cout << "no " << link << std::endl;
    }
}

enum class After : std::uint8_t {
    dead,      ///< the guardian acted and forwarded the code
    stopped,   ///< the machine stopped itself
    goes_on,   ///< it waits for the operator
    misses,    ///< the same; once acknowledged it prepares itself without brake, and waits for its part
    unplugged, ///< it stopped everything within reach, and ends in order; nobody drives its lines
    untouched, ///< it weaves on
    either,    ///< untouched or dead: a process that asks the kernel for memory waits, even in real time
};

struct Victims {
    pid_t guardian, machine;
    HeldOutput& output;
};

struct Fault {
    std::string_view name;
    void (*commit)(const Victims&);
    std::chrono::milliseconds within;
    After after;
    int code = 0;                           ///< dead: the exit code
    const char* mended_by = nullptr;        ///< misses: the command that starts the part again
    void (*mend)(const Victims&) = nullptr; ///< untouched: undoes the fault
};

// clang-format off
constexpr Fault faults[] = {
    {"KILL",              [](const Victims& v) { ::kill(v.machine, SIGKILL); },  death,          After::dead, 137},
    {"SEGV",              [](const Victims& v) { ::kill(v.machine, SIGSEGV); },  death,          After::dead, 139},
    {"ABRT",              [](const Victims& v) { ::kill(v.machine, SIGABRT); },  death,          After::dead, 134},
    {"BUS",               [](const Victims& v) { ::kill(v.machine, SIGBUS); },   death,          After::dead, 135},
    {"FPE",               [](const Victims& v) { ::kill(v.machine, SIGFPE); },   death,          After::dead, 136},
    {"STOP",              [](const Victims& v) { ::kill(v.machine, SIGSTOP); },  hang,           After::dead, 137},
    {"spin",              [](const Victims&) { spin(600ms); },                   hang,           After::dead, 137},
    {"guardian-killed",   [](const Victims& v) { ::kill(v.guardian, SIGKILL); }, orderly,        After::stopped},
    {"guardian-stopped",  [](const Victims& v) { ::kill(v.guardian, SIGSTOP); }, guardian_hangs, After::stopped},
    {"can-down",          [](const Victims&) { set_interface("can0", false); },  silence,        After::goes_on},
    {"memory-exhausted",  [](const Victims&) { exhaust_memory(); },              exhausted,      After::either, 137},
    {"component-stopped", [](const Victims&) { ::tappet::run_foreign("tappet-browse stop weft"); },  asked, After::misses, 0, "tappet-browse start weft"},
    {"activity-stopped",  [](const Victims&) { ::tappet::run_foreign("tappet-browse stop shaft"); }, asked, After::misses, 0, "tappet-browse start shaft"},
    {"stdout-blocked",    [](const Victims& v) { v.output.hold(true); soon([&] { return v.output.unread() > 3600; }, 20s, 50ms); }, {}, After::untouched, 0, nullptr,
                          [](const Victims& v) { v.output.hold(false); }},
    {"modbus-gone",       [](const Victims&) { set_interface("lo", false); },    {},             After::untouched, 0, nullptr,
                          [](const Victims&) { set_interface("lo", true); }},
    {"chip-unbound",      [](const Victims&) { unplug_chip(); },                 orderly,        After::unplugged},
};
// clang-format on

const Fault* find_fault(std::string_view name) {
    const auto* found = std::find_if(std::begin(faults), std::end(faults),
                                     [&](const Fault& each) { return each.name == name; });
    return found == std::end(faults) ? nullptr : found;
}

bool drives_stand(const Logged& f) { return !f.enables_operation() && f.target() == 0; }
bool is_drive_command(const Logged& f) {
    return f.id == wires::cob::main_drive_command || f.id == wires::cob::let_off_drive_command;
}

struct Verdict {
    WallDuration lines{};  ///< until brake and valve were safe
    WallDuration drives{}; ///< until the last command that lets a drive turn
    std::string fault;     ///< empty: it was safe, in time, and stayed so
};

class Campaign {
public:
    Campaign(std::uint32_t seed, bool guarded) : random_{seed}, options_{guarded ? "" : "--no-guardian"} {}

    Verdict run(const Fault& fault) {
        if (!plant_) {
            plant_.emplace("carpet-loom-plant --period 1ms --operator-reaction 200ms");
            std::this_thread::sleep_for(100ms); // its Modbus server listens
        }
        if (!machine_) {
            output_.emplace();
            machine_.emplace("carpet_loom " + options_, output_->entry());
            output_->flow_into(machine_->file());
        }
        const std::size_t told = seen_;
        if (!says("state=weave")) return {{}, {}, "the loom does not weave: " + said().substr(told)};
        Foreign listener{listen_to_the_machine};
        std::this_thread::sleep_for(std::chrono::microseconds{100'000 + random_() % 400'000});

        pull(wires::line::brake, false);
        pull(wires::line::weft_release, true);
        const pid_t machine = machine_of(*machine_), guardian = machine_->number();
        be_fifo(95); // the judge must see how a spinning thread blocks all others
        const WallTime committed = wall_now();
        const Victims victims{guardian, machine == 0 ? guardian : machine, *output_};
        fault.commit(victims);
        Verdict verdict;
        if (fault.after == After::untouched) {
            if (soon([&] { return lines_->now(); }, weaves_on)) verdict.fault = "it stopped";
            fault.mend(victims);
        } else if (fault.after != After::unplugged) {
            verdict = judge_lines(fault, committed, machine);
        }
        be_fifo(0);
        After after = fault.after;
        if (after == After::either && comes_back()) {
            after = After::untouched;
            verdict = {}; // its lines needed not be safe
        }
        const std::string end = judge_end(fault, after, machine);
        if (verdict.fault.empty()) verdict.fault = end;
        if (after == After::unplugged) {
            plant_.reset(), lines_.reset();
            plug_chip();
            lines_.emplace();
        }
        pull(wires::line::brake, true);
        pull(wires::line::weft_release, false);
        if (after != After::untouched) judge_drives(fault, committed, listener, verdict);
        if (after == After::misses && ::tappet::run_foreign(fault.mended_by) != 0 && verdict.fault.empty())
            verdict.fault = "it takes no \"" + std::string{fault.mended_by} + "\"";
        return verdict;
    }

private:
    std::string said() {
        output_->settle();
        return machine_->output();
    }
    bool says(std::string_view text) {
        return soon(
            [&] {
                const std::size_t at = said().find(text, seen_);
                if (at == std::string::npos) return false;
                seen_ = at + text.size();
                return true;
            },
            20s, 20ms);
    }
    /// Waits until it weaves, perhaps after a stop for a late weft; false: it ended, or does neither.
    bool comes_back() {
        seen_ = said().size();
        bool ended = false;
        return soon(
                   [&] {
                       return (ended = !machine_->runs()) ||
                              said().find("state=weave", seen_) != std::string::npos;
                   },
                   20s, 20ms) &&
               !ended;
    }
    static std::string end_of(const std::string& told) {
        return told.substr(told.size() - std::min<std::size_t>(told.size(), 800));
    }
    static bool lives(pid_t process) {
        return ::kill(process, 0) == 0 &&
               !content_of("/proc/" + std::to_string(process) + "/status").contains("State:\tZ");
    }

    /// Judges the driver of the lines: the guardian, or, when that is the victim, the machine.
    Verdict judge_lines(const Fault& fault, WallTime committed, pid_t machine) {
        Verdict verdict;
        const pid_t holder = fault.after == After::stopped && machine != 0 ? machine : machine_->number();
        bool safe = false;
        while (wall_now() - committed < fault.within + 60ms) {
            const bool now_safe = lines_->now();
            // Once the holder has ended, nobody holds the lines, after a short delay.
            if (!now_safe && !lives(holder)) break;
            if (!now_safe && safe && soon([&] { return !lives(holder); }, 20ms)) break;
            if (now_safe && !safe)
                verdict.lines = std::chrono::duration_cast<WallDuration>(wall_now() - committed);
            // A machine that still lives may have stopped for a weft, and may weave again.
            const bool may_weave = fault.after == After::stopped || fault.after == After::either;
            if (!now_safe && safe && !may_weave && fault.after != After::misses)
                verdict.fault = "the lines did not stay safe";
            safe = now_safe || (safe && !may_weave);
            std::this_thread::sleep_for(200us);
        }
        if (!safe)
            verdict.fault = "brake and valve never became safe";
        else if (verdict.lines > fault.within)
            verdict.fault = "the lines were safe too late";
        return verdict;
    }

    std::string judge_end(const Fault& fault, After after, pid_t machine) {
        switch (after) {
        case After::either:
        case After::dead: {
            const bool ended = soon([&] { return !machine_->runs(); }, 20s);
            if (!ended) machine_->signal(SIGKILL);
            const int code = machine_->wait();
            const std::string told = said();
            forget_machine();
            if (!ended) return "it does not end: " + end_of(told);
            if (code != fault.code) return "its exit code is " + std::to_string(code);
            if (!told.contains("the guardian wrote the lines"))
                return "the guardian does not say what it did";
            if (!told.contains("the black box is /run/carpet-loom-")) return "no black box was kept";
            return {};
        }
        case After::stopped: {
            const bool ended = soon([&] { return !lives(machine); });
            machine_->signal(SIGKILL);
            const std::string told = (machine_->wait(), said());
            forget_machine();
            if (!ended) return "the machine goes on without a guardian";
            if (!told.contains("stopped: its guardian is gone"))
                return "the machine does not say why it stopped";
            return {};
        }
        case After::unplugged: {
            const bool stops = says("state=emergency");
            machine_->signal(SIGTERM);
            const int code = machine_->wait();
            const std::string told = said();
            forget_machine();
            if (!stops) return "it does not go to its emergency: " + end_of(told);
            return code == 4 ? "" : "its exit code is " + std::to_string(code); // nobody makes its lines safe
        }
        case After::goes_on:
        case After::misses:
        case After::untouched: break;
        }
        if (!machine_->runs()) {
            const std::string told = said();
            forget_machine();
            return "the machine ended: " + end_of(told);
        }
        seen_ = said().size();
        return after != After::untouched || says("state=weave") ? "" : "it does not weave on";
    }

    void judge_drives(const Fault& fault, WallTime committed, Foreign& listener, Verdict& verdict) {
        int told = 0;
        // Later commands belong to another start, whose first command that turns a drive follows an
        // acknowledgement.
        const WallTime end = committed + fault.within + 100ms;
        soon([&] { return wall_now() > end; });
        listener.signal(SIGINT); // it writes its buffered output
        listener.wait();
        for (const Logged& f : frames_of(listener.output())) {
            if (!is_drive_command(f) || f.at < committed || f.at > end) continue;
            ++told;
            // A machine that prepares itself holds its drives and tightens the warp; a shaft without its
            // brake coasts, and the let-off follows it.
            const bool turns = fault.after != After::misses && fault.after != After::unplugged
                                   ? !drives_stand(f)
                                   : f.id == wires::cob::main_drive_command && f.target() != 0;
            if (turns) verdict.drives = std::chrono::duration_cast<WallDuration>(f.at - committed);
        }
        if (!verdict.fault.empty()) return;
        if (verdict.drives > fault.within) verdict.fault = "a drive was still told to turn";
        if (told == 0 && fault.after == After::dead) verdict.fault = "the drives were told nothing";
    }

    void forget_machine() {
        machine_.reset();
        output_.reset();
        seen_ = 0;
    }

    std::optional<SafeLines> lines_{std::in_place};
    std::mt19937 random_;
    std::string options_;
    std::optional<Foreign> plant_;
    std::optional<HeldOutput> output_; // ends after the machine
    std::optional<Foreign> machine_;
    std::size_t seen_ = 0;
};

struct Times {
    int runs = 0, unsafe = 0;
    WallDuration lines{}, drives{};
};

int campaign(int runs, std::uint32_t seed, std::string_view only, bool guarded) {
    std::mt19937 random{seed};
    Campaign machine{seed, guarded};
    std::map<std::string_view, Times> times;
    int unsafe = 0;
    for (int i = 0; i < runs; ++i) {
        // Each fault once, starting at another one for each seed; then at random.
        const auto place = static_cast<std::size_t>(i);
        const std::size_t chosen = place < std::size(faults) ? place + seed : random();
        const Fault* fault = only.empty() ? &faults[chosen % std::size(faults)] : find_fault(only);
        const Verdict verdict = machine.run(*fault);
        Times& all = times[fault->name];
        ++all.runs;
        all.unsafe += !verdict.fault.empty();
        all.lines = std::max(all.lines, verdict.lines);
        all.drives = std::max(all.drives, verdict.drives);
        unsafe += !verdict.fault.empty();
        std::cout << "run " << i + 1 << ": " << fault->name << ": lines safe after " << verdict.lines.count()
                  << " us, drives after " << verdict.drives.count() << " us"
                  << (verdict.fault.empty() ? "" : "; UNSAFE: " + verdict.fault) << std::endl;
    }
    for (const auto& [name, all] : times)
        std::cout << name << ": " << all.runs << " runs, worst lines " << all.lines.count()
                  << " us, worst drives " << all.drives.count() << " us, " << all.unsafe << " unsafe"
                  << std::endl;
    std::cout << "campaign of seed " << seed << ": " << runs << " runs, " << unsafe << " unsafe" << std::endl;
    return unsafe == 0 ? 0 : 1;
}

} // namespace
} // namespace tappet::bench

int main(int count, char** words) {
    int runs = static_cast<int>(std::size(tappet::bench::faults));
    std::uint32_t seed = 1;
    std::string_view only;
    bool guarded = true;
    bool good = true;
    for (int i = 1; i < count && good; ++i) {
        const std::string_view word = words[i];
        const char* value = i + 1 < count ? words[i + 1] : nullptr;
        if (word == "--no-guardian") {
            guarded = false;
            continue;
        }
        good = value != nullptr && (word == "--runs" || word == "--seed" || word == "--only");
        if (!good) break;
        if (word == "--runs") good = (runs = std::atoi(value)) > 0;
        if (word == "--seed") seed = static_cast<std::uint32_t>(std::atoi(value));
        if (word == "--only") good = tappet::bench::find_fault(only = value) != nullptr;
        ++i;
    }
    if (good) return tappet::bench::campaign(runs, seed, only, guarded);
    std::cerr << "loom_campaign [--runs N] [--seed S] [--no-guardian] [--only FAULT], which is one of";
    for (const auto& each : tappet::bench::faults) std::cerr << ' ' << each.name;
    std::cerr << std::endl;
    return 2;
}
