// Arming: the box and the process are checked before the machine may move. A fault refuses, with its reason
// and cure. A development board may downgrade named checks to warnings, which stay visible.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::os {

enum class Severity : std::uint8_t { passed, warning, refused };

struct Finding {
    std::string_view name; ///< name of the check; its characters outlive the report
    Severity severity = Severity::passed;
    Sentence finding;
    Sentence cure;
};

/// The report of the checks of check_system and of other layers: buses, boards, schedules. Some 60 kB. Not
/// real-time.
class ArmingReport {
public:
    static constexpr std::size_t max_findings = 64;

    /// `downgraded`: the names of checks whose faults only warn; it outlives the report.
    explicit ArmingReport(std::span<const std::string_view> downgraded = {}) noexcept
        : downgraded_{downgraded} {}

    void passed(std::string_view name, const Sentence& finding) noexcept;
    /// Adds a fault. It refuses, unless `name` is downgraded.
    void fault(std::string_view name, const Sentence& finding, const Sentence& cure) noexcept;
    /// Adds a fault that no board downgrades.
    void refuse(std::string_view name, const Sentence& finding, const Sentence& cure) noexcept;
    /// Adds a fault with which the machine can run.
    void warning(std::string_view name, const Sentence& finding, const Sentence& cure) noexcept;

    /// Ends the report after the last check. A downgraded name that no check has is refused, with the nearest
    /// name of a check. Returns true when the machine may arm. Once; findings added later do not count.
    [[nodiscard]] bool conclude() noexcept;
    /// Returns whether the machine may arm; false before conclude().
    [[nodiscard]] bool can_arm() const noexcept { return concluded_ && refused() == 0; }

    [[nodiscard]] std::span<const Finding> findings() const noexcept {
        return {findings_.begin(), findings_.end()};
    }
    [[nodiscard]] std::size_t refused() const noexcept { return count(Severity::refused) + lost_; }
    [[nodiscard]] std::size_t warnings() const noexcept { return count(Severity::warning); }
    /// Returns the number of findings without room; each refuses.
    [[nodiscard]] std::size_t lost() const noexcept { return lost_; }

private:
    void add(const Finding& finding) noexcept;
    [[nodiscard]] std::size_t count(Severity severity) const noexcept;
    [[nodiscard]] bool has_check(std::string_view name) const noexcept;

    std::span<const std::string_view> downgraded_;
    Bounded<Finding, max_findings> findings_{};
    std::size_t lost_ = 0;
    bool concluded_ = false;
};

/// Writes "cannot arm: 3 reasons" and a line for each finding that did not pass, with its cure. No heap.
void print(const ArmingReport& report, int file) noexcept;

/// The requirements of the machine and its board on the system.
struct ArmingOptions {
    std::string_view root = "";                                              ///< prefix of /proc and /sys
    std::span<const int> processors{};                                       ///< named by the board's plan
    std::span<const std::string_view> clock_sources = trusted_clock_sources; ///< the accepted ones
    int highest_priority = 1;                                                ///< SCHED_FIFO, 1..99
    // The board must accept a guest's clock (kvm-clock) or a slow one (hpet).
    static constexpr std::string_view trusted_clock_sources[] = {"tsc", "arch_sys_counter"};
};

/// Facts that no file shows, from the process itself. A test states its own.
struct ProcessFacts {
    std::int64_t clock_resolution_ns = 0;
    int fifo_error = 0; ///< errno of setting the highest priority on this thread; 0: it could be set
    std::uint64_t lockable_bytes = 0; ///< RLIMIT_MEMLOCK; all ones: no limit
    bool memory_locked = false;
    bool latency_held = false;
    std::int64_t timer_slack_ns = 0; ///< of this thread
    bool heap_sealed = false;
    bool seal_counts = false; ///< heap::seal_counts()
};
ProcessFacts observe_process(int highest_priority) noexcept;

/// One row of the table of checks.
struct SystemCheck {
    struct Verdict {
        bool good;
        Sentence finding;
    };
    std::string_view name;
    std::string_view looks_at;
    std::string_view claims; ///< the property of a box that passes
    /// Kernels on which `tests/bench/probe/arming.cpp` measured the claim on x86-64, as "6.1 6.12". Empty: an
    /// emulated box cannot show it.
    std::string_view measured_on;
    Severity severity; ///< of a fault that is not downgraded
    std::string_view cure;
    Verdict (*look)(const ArmingOptions&, const ProcessFacts&) noexcept;
};
std::span<const SystemCheck> system_checks() noexcept;

/// Runs every check in system_checks. Not real-time; no heap.
void check_system(ArmingReport& report, const ArmingOptions& options, const ProcessFacts& facts) noexcept;
inline void check_system(ArmingReport& report, const ArmingOptions& options) noexcept {
    check_system(report, options, observe_process(options.highest_priority));
}

} // namespace tappet::os
