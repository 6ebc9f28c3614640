// SPDX-License-Identifier: Apache-2.0
// Custody of the outputs and the watchdog: a firmware with its guardian has it, or init. A firmware is ended
// here and nowhere else.
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
    /// For so long; meanwhile notices and the ends of children reach Custody.
    virtual void pause(std::chrono::milliseconds time) = 0;
    virtual void say(const std::string& sentence) = 0;
    virtual void ask_to_end(pid_t process) = 0;
    virtual void kill(pid_t process) = 0;
    /// Kills the children of this process: those of a guardian are the machine.
    virtual void kill_children_of(pid_t process) = 0;
    /// All but init, and until they are gone, for a short time.
    virtual void kill_others() = 0;
    /// At once: neither disks nor processes are waited for.
    virtual void reset_box() = 0;
};

class Custody {
public:
    /// Then a firmware that was asked to end is killed, and its guardian makes the outputs safe.
    static constexpr Duration stop_patience = 15s;
    /// A guardian's black box comes last.
    static constexpr Duration guardian_patience = os::guardian_acts_within + 5s;
    /// How long a killed process may take to disappear.
    static constexpr Duration gone_patience = 10s;

    /// `watchdog`: its path; empty: the board has none.
    Custody(Processes& processes, std::string watchdog, std::chrono::seconds within);

    [[nodiscard]] bool outputs_are_safe() const { return outputs_.is_safe(); }
    [[nodiscard]] bool firmware_runs() const { return firmware_ > 0; }
    [[nodiscard]] bool is(pid_t process) const { return firmware_runs() && process == firmware_; }

    /// Init kicks it from here on, when the outputs are safe. Without effect on a board that has none.
    [[nodiscard]] init::Done hold_watchdog();
    void kick() { watchdog_.kick(processes_.now()); }
    /// For what may take long, and may never end: the kicks end at `until`.
    void kick_until(Time until) {
        if (processes_.now() < until) kick();
    }

    /// The watchdog is the guardian's from here on. The error: the outputs are not safe, and nothing may be
    /// started.
    [[nodiscard]] init::Done hand_over();
    /// After hand_over(). A negative number: it was not started.
    void firmware_started(pid_t process);
    /// Takes a child's notice. Only a guardian's statement that the outputs are safe has an effect.
    void hear(std::string_view notice);
    /// With its exit code. When the outputs are safe the watchdog is init's again.
    void firmware_ended(int code);

    /// Asks the firmware to end, then makes it, kills everybody else and stands the watchdog down. It comes
    /// back only when the outputs are safe; else the box is reset. A guardian is never killed before it has
    /// said so.
    void end_everything();
    /// The exit code of a worker, see worker_ended(), or none: it took too long and was killed. One that
    /// cannot be killed is not waited for: the box is reset.
    [[nodiscard]] std::optional<int> await_worker(pid_t worker, Duration within);
    /// Of every child that ended, with its exit code: it may be the worker that is awaited.
    void worker_ended(pid_t process, int code);
    /// Waits for the watchdog without a kick; on a board without one, or when it does not come, init resets.
    void await_reset();
    void stand_down() { watchdog_.stand_down(); }

private:
    /// Whether `done` became true in that time.
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
