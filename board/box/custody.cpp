// SPDX-License-Identifier: Apache-2.0
// The steps follow tests/models/outputs.pml.
#include "board/box/custody.hpp"

#include "kernel/os/clock.hpp"

#include <utility>

namespace tappet::box {

namespace {

constexpr int touched_nothing = 2; // Ending::wrong_set_up; no guardian passes it on from a machine
constexpr std::chrono::milliseconds look_every{10};
constexpr std::chrono::seconds reset_grace{2}; // time for the messages to reach the disk

} // namespace

Custody::Custody(Processes& processes, std::string watchdog, std::chrono::seconds within)
    : processes_{processes}, path_{std::move(watchdog)}, within_{within} {}

init::Done Custody::hold_watchdog() {
    if (path_.empty()) return {};
    if (auto opened = watchdog_.open(path_.c_str(), within_); !opened)
        return std::unexpected(std::string{opened.error().view()});
    return {};
}

init::Done Custody::hand_over() {
    if (!outputs_.is_safe())
        return std::unexpected("no firmware is started: the outputs may not be safe, and the box is reset");
    watchdog_.hand_over();
    static_cast<void>(outputs_.drive(Time::min()));
    return {};
}

void Custody::firmware_started(pid_t process) {
    firmware_ = process;
    if (process > 0) return;
    outputs_.leave_untouched();
    if (const auto held = hold_watchdog(); !held) processes_.say(held.error());
}

void Custody::hear(std::string_view notice) {
    if (notice == os::outputs_are_safe_notice && firmware_runs()) outputs_.guardian_says_safe();
}

void Custody::firmware_ended(int code) {
    firmware_ = -1;
    if (code == touched_nothing) outputs_.leave_untouched();
    if (!outputs_.is_safe()) {
        outputs_.lose(Time::min());
        return;
    }
    if (is_ending_) return;
    if (const auto held = hold_watchdog(); !held) processes_.say(held.error());
}

template <class Done>
bool Custody::await(Duration time, Done done) {
    for (const Time until = processes_.now() + time; !done() && processes_.now() < until;)
        processes_.pause(look_every);
    return done();
}

void Custody::end_everything() {
    is_ending_ = true;
    if (firmware_runs()) {
        processes_.ask_to_end(firmware_); // init.ask
        if (!await(stop_patience, [this] { return !firmware_runs(); })) {
            processes_.say("the firmware does not end: its machine is killed, and its guardian makes the "
                           "outputs safe");
            processes_.kill_children_of(firmware_); // init.kill_machine
            // Once the guardian has reported safe outputs, its black box is not awaited.
            await(guardian_patience, [this] { return !firmware_runs() || outputs_.is_safe(); });
        }
    }
    if (!outputs_.is_safe()) return await_reset();
    firmware_ = -1;
    processes_.kill_others(); // init.kill_others
    watchdog_.stand_down();
}

void Custody::worker_ended(pid_t process, int code) {
    if (process == worker_) worker_code_ = code;
}

std::optional<int> Custody::await_worker(pid_t worker, Duration within) {
    worker_ = worker;
    worker_code_.reset();
    const auto has_ended = [this] {
        kick();
        return worker_code_.has_value();
    };
    if (await(within, has_ended)) return worker_code_;
    processes_.say("it takes too long, and is killed; the version that ran before starts again");
    processes_.kill(worker); // init.kill_worker
    if (!await(gone_patience, has_ended)) {
        processes_.say("it waits for a disk that does not answer, and cannot be ended; check that disk");
        await_reset();
    }
    return std::nullopt;
}

void Custody::await_reset() {
    processes_.say(outputs_.is_safe()
                       ? "the box is reset"
                       : "its outputs may not be safe: nothing is started, and the box is reset");
    outputs_.lose(Time::min()); // init.await_reset
    await(path_.empty() ? reset_grace : within_ + reset_grace, [] { return false; });
    processes_.reset_box(); // init.reset
}

} // namespace tappet::box
