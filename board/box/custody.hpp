// SPDX-License-Identifier: Apache-2.0
// Custody of the outputs and the watchdog: held by a firmware with its guardian, or by init. Firmware is
// ended only here.
#pragma once

#include "board/init/system.hpp"
#include "kernel/os/output_latch.hpp"
#include "kernel/os/watchdog.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include <sys/types.h>

namespace tappet::box {

/// The system calls that custody makes. Tests replace them.
class Processes {
public:
    Processes() = default;
    Processes(const Processes&) = delete;
    Processes& operator=(const Processes&) = delete;
    virtual ~Processes() = default;

    [[nodiscard]] virtual Time now() = 0;
    /// Waits this long; meanwhile notices and ends of children are passed to Custody.
    virtual void pause(std::chrono::milliseconds time) = 0;
    virtual void say(const std::string& sentence) = 0;
    virtual void ask_to_end(pid_t process) = 0;
    virtual void kill(pid_t process) = 0;
    /// Kills the children of this process; those of a guardian are the machine.
    virtual void kill_children_of(pid_t process) = 0;
    /// Kills all processes but init, and waits a short time for their end.
    virtual void kill_others() = 0;
    /// Resets at once, without waiting for disks or processes.
    virtual void reset_box() = 0;
};

class Custody {
public:
    /// After this time, a firmware that was asked to end is killed, and its guardian makes the outputs safe.
    static constexpr Duration stop_patience = 15s;
    /// A guardian writes its black box last.
    static constexpr Duration guardian_patience = os::guardian_acts_within + 5s;
    /// Longest time for a killed process to disappear.
    static constexpr Duration gone_patience = 10s;

    /// `watchdog`: its path; empty: the board has none.
    Custody(Processes& processes, std::string watchdog, std::chrono::seconds within);

    [[nodiscard]] bool outputs_are_safe() const { return outputs_.is_safe(); }
    [[nodiscard]] bool firmware_runs() const { return firmware_ > 0; }
    [[nodiscard]] bool is(pid_t process) const { return firmware_runs() && process == firmware_; }

    /// Lets init kick the watchdog from now on, when the outputs are safe. No effect on a board without one.
    [[nodiscard]] init::Done hold_watchdog();
    void kick() { watchdog_.kick(processes_.now()); }
    /// Kicks, but not after `until`: for an operation that takes long and may never end.
    void kick_until(Time until) {
        if (processes_.now() < until) kick();
    }

    /// Gives the watchdog to the guardian. The error: the outputs are not safe, and nothing may be started.
    [[nodiscard]] init::Done hand_over();
    /// Called after hand_over(). A negative number: the firmware was not started.
    void firmware_started(pid_t process);
    /// Processes a child's notice. Only a guardian's statement that the outputs are safe has an effect.
    void hear(std::string_view notice);
    /// Processes the firmware's end with its exit code. With safe outputs, init has the watchdog again.
    void firmware_ended(int code);

    /// Asks the firmware to end, then forces it, kills all others and stops the watchdog. Returns only when
    /// the outputs are safe; otherwise the box is reset. A guardian is never killed before it has reported
    /// safe outputs.
    void end_everything();
    /// Returns the exit code of a worker, see worker_ended(); empty when it took too long and was killed.
    /// When it cannot be killed, the box is reset.
    [[nodiscard]] std::optional<int> await_worker(pid_t worker, Duration within);
    /// Called for every child that ended, with its exit code, since it may be the awaited worker.
    void worker_ended(pid_t process, int code);
    /// Stops kicking and waits for the watchdog's reset; without a watchdog, or without a reset, init resets.
    void await_reset();
    void stand_down() { watchdog_.stand_down(); }

private:
    /// Waits for `done`, at most for this time; returns whether it became true.
    template <class Done>
    bool await(Duration time, Done done);

    Processes& processes_;
    std::string path_;
    std::chrono::seconds within_;
    os::OutputLatch outputs_{};
    os::Watchdog watchdog_{outputs_};
    pid_t firmware_ = -1;
    pid_t worker_ = -1;
    std::optional<int> worker_code_{};
    bool is_ending_ = false;
};

} // namespace tappet::box
