// Arming: each check passes on a correctly configured box and refuses with a cure on a faulty one, using
// simulated /proc and /sys trees. A check that the board downgrades only warns; a misspelt name refuses.
#include "kernel/os/arming.hpp"

#include "kernel/os/memory.hpp"
#include "tests/kernel/os/folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include <memory>
#include <string>

#include <sched.h>
#include <unistd.h>

namespace tappet::os {
namespace {

using namespace std::string_view_literals;
using testing::HasSubstr;

struct Box : test::Folder {
    Box() {
        write("sys/kernel/realtime", "1\n");
        write("proc/sys/kernel/osrelease", "6.1.0-rt\n");
        write("proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian\n");
        write("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
        write("proc/sys/kernel/sched_rt_runtime_us", "-1\n");
        write("proc/self/status",
              "Name:\tloom\nVmLck:\t    2032 kB\nCapEff:\t0000000000004000\nThreads:\t4\n");
        write("proc/swaps", "Filename\t\t\tType\t\tSize\tUsed\tPriority\n");
        write("sys/devices/system/cpu/online", "0-2,4\n");
        write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance\n");
    }
    void write(const std::string& file, std::string_view text) const {
        const std::filesystem::path whole = path + "/" + file;
        std::filesystem::create_directories(whole.parent_path());
        std::ofstream{whole} << text;
    }
    void remove(const std::string& file) const { std::filesystem::remove(path + "/" + file); }
};

constexpr std::array plan{1, 4};

std::string fair_server_of(int processor) {
    return "sys/kernel/debug/sched/fair_server/cpu" + std::to_string(processor) + "/runtime";
}

struct Situation {
    Box box;
    ArmingOptions options{.root = box.path, .processors = plan, .highest_priority = 80};
    ProcessFacts facts{.clock_resolution_ns = 1,
                       .fifo_error = 0,
                       .lockable_bytes = 65536,
                       .memory_locked = true,
                       .latency_held = true,
                       .timer_slack_ns = 1,
                       .heap_sealed = true,
                       .seal_counts = true};

    void run_on_6_12() const {
        box.write("proc/sys/kernel/osrelease", "6.12.9-rt\n");
        for (const int processor : plan) box.write(fair_server_of(processor), "0\n");
    }

    [[nodiscard]] std::unique_ptr<ArmingReport>
    report(std::span<const std::string_view> downgraded = {}) const {
        auto made = std::make_unique<ArmingReport>(downgraded);
        check_system(*made, options, facts);
        static_cast<void>(made->conclude());
        return made;
    }
};

std::string printed(const ArmingReport& report) {
    int ends[2] = {};
    EXPECT_EQ(pipe(ends), 0);
    print(report, ends[1]);
    close(ends[1]);
    std::string text;
    std::array<char, 1024> part{};
    for (ssize_t got = 0; (got = read(ends[0], part.data(), part.size())) > 0;)
        text.append(part.data(), static_cast<std::size_t>(got));
    close(ends[0]);
    return text;
}

TEST(Arming, succeeds_on_a_correctly_configured_box) {
    const Situation situation;
    const auto report = situation.report();
    EXPECT_TRUE(report->can_arm()) << printed(*report);
    EXPECT_EQ(report->warnings(), 0u);
    EXPECT_EQ(report->findings().size(), system_checks().size());
    EXPECT_EQ(printed(*report), "can arm: 14 checks made\n");
}

TEST(Arming, defines_a_name_a_subject_and_a_cure_for_each_check) {
    for (const SystemCheck& check : system_checks()) {
        EXPECT_FALSE(check.name.empty() || check.looks_at.empty() || check.claims.empty() ||
                     check.cure.empty())
            << check.name;
        EXPECT_EQ(std::count_if(system_checks().begin(), system_checks().end(),
                                [&](const SystemCheck& other) { return other.name == check.name; }),
                  1);
    }
}

struct Fault {
    const char* what;
    const char* check;
    const char* says;
    void (*make)(Situation&);
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.what; }

// clang-format off
const Fault faults[] = {
    {"preemptible_kernel", "realtime-kernel", "kernel 6.1.0-rt is not PREEMPT_RT",
     [](Situation& s) { s.box.write("sys/kernel/realtime", "0\n"); s.box.write("proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC\n"); }},
    {"no_kernel_files", "realtime-kernel", "kernel 6.1.0-rt is not PREEMPT_RT",
     [](Situation& s) { s.box.remove("sys/kernel/realtime"); s.box.remove("proc/sys/kernel/version"); }},
    {"slow_clock_source", "clock-source", "hpet; the board accepts tsc arch_sys_counter",
     [](Situation& s) { s.box.write("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet\n"); }},
    {"no_clock_source", "clock-source", "cannot be read",
     [](Situation& s) { s.box.remove("sys/devices/system/clocksource/clocksource0/current_clocksource"); }},
    {"coarse_clock", "clock-resolution", "4000000 ns", [](Situation& s) { s.facts.clock_resolution_ns = 4'000'000; }},
    {"no_priority", "fifo-priority", "priority 80 cannot be set", [](Situation& s) { s.facts.fifo_error = EPERM; }},
    {"throttling", "rt-throttling", "stopped after 950000 us", [](Situation& s) { s.box.write("proc/sys/kernel/sched_rt_runtime_us", "950000\n"); }},
    {"throttling_unknown", "rt-throttling", "cannot be read", [](Situation& s) { s.box.remove("proc/sys/kernel/sched_rt_runtime_us"); }},
    {"fair_server", "rt-throttling", "processor 4 lose 50000000 ns of each period",
     [](Situation& s) { s.run_on_6_12(); s.box.write(fair_server_of(4), "50000000\n"); }},
    {"fair_server_unknown", "rt-throttling", "kernel 6.12.9-rt has a fair server, which may stop real-time threads on processor 1: "
     "/sys/kernel/debug/sched/fair_server/cpu1/runtime cannot be read (No such file or directory)",
     [](Situation& s) { s.run_on_6_12(); s.box.remove(fair_server_of(1)); }},
    {"fair_server_of_an_earlier_kernel", "rt-throttling", "processor 1 lose 1 ns",
     [](Situation& s) { s.box.write(fair_server_of(1), "1\n"); }},
    {"deep_sleep", "cpu-dma-latency", "not held", [](Situation& s) { s.facts.latency_held = false; }},
    {"lock_limit", "memory-lockable", "may lock 64 kB only",
     [](Situation& s) { s.box.write("proc/self/status", "VmLck:\t 64 kB\nCapEff:\t0000000000000800\n"); }},
    {"unlocked", "memory-locked", "not locked", [](Situation& s) { s.facts.memory_locked = false; }},
    {"lock_lost", "memory-locked", "0 kB", [](Situation& s) { s.box.write("proc/self/status", "VmLck:\t       0 kB\nCapEff:\t0000000000004000\n"); }},
    {"swap", "swap", "in use on /dev/sda2", [](Situation& s) { s.box.write("proc/swaps", "Filename Type\n/dev/sda2\tpartition 1 0 -2\n"); }},
    {"unreadable_swap", "swap", "/proc/swaps cannot be read (Is a directory)",
     [](Situation& s) { s.box.remove("proc/swaps"); s.box.write("proc/swaps/what", ""); }},
    {"unreadable_governor", "cpu-governor", "scaling_governor cannot be read (Is a directory)",
     [](Situation& s) {
         s.box.remove("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor");
         s.box.write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor/what", "");
     }},
    {"missing_processor", "processors", "not online: 4; online are 0-3", [](Situation& s) { s.box.write("sys/devices/system/cpu/online", "0-3\n"); }},
    {"unreadable_processors", "processors", "not online: 1 4", [](Situation& s) { s.box.write("sys/devices/system/cpu/online", "what?\n"); }},
    {"powersave", "cpu-governor", "processor 1 has the frequency governor powersave",
     [](Situation& s) { s.box.write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave\n"); }},
    {"open_heap", "heap-sealed", "not sealed", [](Situation& s) { s.facts.heap_sealed = false; }},
    {"blind_heap", "heap-sealed", "sees nothing", [](Situation& s) { s.facts.seal_counts = false; }},
};
// clang-format on

class BadBox : public ::testing::TestWithParam<Fault> {};

TEST_P(BadBox, is_refused_by_the_matching_check_with_a_cure) {
    Situation situation;
    GetParam().make(situation);
    const auto report = situation.report();
    EXPECT_FALSE(report->can_arm());
    EXPECT_EQ(report->refused(), 1u) << printed(*report);
    for (const Finding& found : report->findings()) {
        if (found.severity == Severity::passed) continue;
        EXPECT_EQ(found.name, GetParam().check);
        EXPECT_THAT(std::string{found.finding.view()}, HasSubstr(GetParam().says));
        EXPECT_FALSE(found.cure.empty());
    }
    EXPECT_TRUE(printed(*report).starts_with("cannot arm: 1 reason\n")) << printed(*report);
}

TEST_P(BadBox, only_causes_a_warning_where_the_board_downgrades_the_check) {
    Situation situation;
    GetParam().make(situation);
    const std::array downgraded{std::string_view{GetParam().check}};
    const auto report = situation.report(downgraded);
    EXPECT_TRUE(report->can_arm()) << printed(*report);
    EXPECT_EQ(report->warnings(), 1u);
    EXPECT_THAT(printed(*report), HasSubstr("  warning  " + std::string{GetParam().check}));
}

INSTANTIATE_TEST_SUITE_P(Faults, BadBox, ::testing::ValuesIn(faults),
                         [](const auto& fault) { return std::string{fault.param.what}; });

// clang-format off
const Fault no_faults[] = {
    {"a_mainline_kernel_by_its_version", "", "", [](Situation& s) { s.box.remove("sys/kernel/realtime"); }},
    {"a_kernel_whose_fair_servers_are_stopped", "", "", [](Situation& s) { s.run_on_6_12(); }},
    {"an_unlimited_lock_without_the_capability", "", "",
     [](Situation& s) { s.box.write("proc/self/status", "VmLck:\t 64 kB\nCapEff:\t0000000000000000\n"); s.facts.lockable_bytes = ~std::uint64_t{0}; }},
    {"a_kernel_without_swap_or_frequency_scaling", "", "",
     [](Situation& s) { s.box.remove("proc/swaps"); s.box.remove("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor"); }},
    {"timer_slack", "timer-slack", "", [](Situation& s) { s.facts.timer_slack_ns = 50'000; }}, // a warning
};
// clang-format on

class GoodBox : public ::testing::TestWithParam<Fault> {};

TEST_P(GoodBox, is_armed) {
    Situation situation;
    GetParam().make(situation);
    const auto report = situation.report();
    EXPECT_TRUE(report->can_arm()) << printed(*report);
    EXPECT_EQ(report->warnings(), *GetParam().check == '\0' ? 0u : 1u) << printed(*report);
}

INSTANTIATE_TEST_SUITE_P(With, GoodBox, ::testing::ValuesIn(no_faults),
                         [](const auto& fault) { return std::string{fault.param.what}; });

TEST(Arming, assumes_a_fair_server_in_a_kernel_of_unknown_release) {
    const Situation situation;
    situation.box.remove("proc/sys/kernel/osrelease");
    EXPECT_THAT(printed(*situation.report()), HasSubstr("refused  rt-throttling: kernel of unknown release"));
}

TEST(Arming, warns_about_an_untried_kernel_and_names_the_tried_ones) {
    const Situation situation;
    situation.run_on_6_12();
    for (const std::string kernel : {"6.18.44", "6.11.0-rt", "6.13.1", "7.1.0", "5.12.3", "6"}) {
        situation.box.write("proc/sys/kernel/osrelease", kernel);
        const auto report = situation.report();
        EXPECT_TRUE(report->can_arm()) << printed(*report);
        EXPECT_EQ(report->warnings(), 1u) << kernel;
        EXPECT_THAT(printed(*report), HasSubstr("  warning  kernel-tried: no check was tried on kernel " +
                                                kernel + "; the kernels tried are 6.1 6.12; cure: "));
    }
}

TEST(Arming, accepts_a_clock_source_that_the_board_accepts) {
    Situation situation;
    situation.box.write("sys/devices/system/clocksource/clocksource0/current_clocksource", "kvm-clock\n");
    EXPECT_FALSE(situation.report()->can_arm());
    const std::array accepted{"tsc"sv, "kvm-clock"sv};
    situation.options.clock_sources = accepted;
    EXPECT_TRUE(situation.report()->can_arm());
}

TEST(Arming, refuses_a_misspelt_downgrade_with_the_nearest_name) {
    const Situation situation;
    const std::array downgraded{"cpu-dma-latncy"sv, "nothing-like-it"sv};
    const auto report = situation.report(downgraded);
    EXPECT_FALSE(report->can_arm());
    EXPECT_EQ(report->refused(), 2u);
    const std::string text = printed(*report);
    EXPECT_THAT(text,
                HasSubstr("no check is called \"cpu-dma-latncy\"; cure: correct the name in the board's "
                          "list of downgraded checks; did you mean \"cpu-dma-latency\"?"));
    EXPECT_THAT(text,
                HasSubstr("no check is called \"nothing-like-it\"; cure: correct the name in the board's "
                          "list of downgraded checks\n"));
}

TEST(Arming, includes_findings_of_other_layers_and_allows_downgrades) {
    const Situation situation;
    const std::array downgraded{"bus-load"sv};
    ArmingReport report{downgraded};
    check_system(report, situation.options, situation.facts);
    report.fault("bus-up", Sentence{"can0 is down"}, Sentence{"run ip link set can0 up"});
    report.fault("bus-load", Sentence{"can1 is at ", 97, " %"}, Sentence{"lower a rate"});
    EXPECT_FALSE(report.can_arm()) << "before it is concluded";
    EXPECT_FALSE(report.conclude());
    EXPECT_EQ(printed(report), "cannot arm: 1 reason, 1 warning\n"
                               "  refused  bus-up: can0 is down; cure: run ip link set can0 up\n"
                               "  warning  bus-load: can1 is at 97 %; cure: lower a rate\n");
}

TEST(Arming, refuses_when_there_is_no_room_for_a_finding) {
    ArmingReport report;
    for (std::size_t i = 0; i < ArmingReport::max_findings + 3; ++i) report.passed("bus", Sentence{"fine"});
    EXPECT_FALSE(report.conclude());
    EXPECT_EQ(report.lost(), 3u);
    EXPECT_THAT(printed(report), HasSubstr("3 findings had no room"));
}

TEST(Arming, observes_its_own_process_without_changing_it) {
    const ProcessFacts facts = observe_process(1);
    EXPECT_GE(facts.clock_resolution_ns, 1);
    EXPECT_GT(facts.timer_slack_ns, 0);
    EXPECT_FALSE(facts.memory_locked || facts.latency_held || facts.heap_sealed);
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
    EXPECT_NE(observe_process(1000).fifo_error, 0) << "there is no priority 1000";
}

TEST(Arming, checks_this_box_without_a_simulated_root) {
    ArmingReport report;
    check_system(report, {});
    EXPECT_FALSE(report.conclude()) << "this test seals no heap and holds no latency";
    EXPECT_EQ(report.findings().size(), system_checks().size());
}

} // namespace
} // namespace tappet::os
