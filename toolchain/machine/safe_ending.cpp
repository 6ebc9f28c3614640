// SPDX-License-Identifier: Apache-2.0
// The order of the steps, and how long each may take.
#include "toolchain/machine/safe_ending.hpp"

#include "kernel/os/clock.hpp"
#include "toolchain/machine/firmware.hpp"

namespace tappet {

namespace {

constexpr Duration killed_within = 100ms; // a thread in the kernel ends when its call does
constexpr Duration confirmed_within = 500ms;
constexpr Duration answered_within = 5s;
constexpr Duration ended_within = 2s;
constexpr Duration again_within = 1s;
constexpr Duration kick_every = 100ms;
static_assert(killed_within + 2 * confirmed_within + answered_within + ended_within + again_within <
              os::guardian_acts_within);

} // namespace

SafeEnding end_safely(EndedProcess& process, GuardedDevices& devices, os::OutputLatch& outputs,
                      os::Watchdog& watchdog) noexcept {
    SafeEnding done;
    const Time begin = os::Clock::monotonic();
    outputs.lose(begin + os::guardian_acts_within);
    const Meanwhile kick{
        &watchdog, [](void* dog) noexcept { static_cast<os::Watchdog*>(dog)->kick(os::Clock::monotonic()); }};
    // Also for a dead process: the signal then has no effect.
    process.kill(); // guardian.kill
    static_cast<void>(devices.write_safe_lines());
    done.written = os::Clock::monotonic() - begin;
    const bool ended_at_once = process.await_end(killed_within);
    static_cast<void>(devices.write_safe_lines());
    kick();
    done.frames = devices.send_safe_frames(confirmed_within);
    done.confirmed = os::Clock::monotonic() - begin;
    done.servers = devices.write_safe_registers(answered_within, kick);
    // A thread that waited in the kernel for memory, a chip or a network may have written after this process.
    for (const Time until = os::Clock::monotonic() + ended_within;
         !(done.ended = process.await_end(kick_every)) && os::Clock::monotonic() < until;)
        kick();
    done.chips = devices.write_safe_lines(); // guardian.write
    if (!ended_at_once) {
        done.frames = devices.send_safe_frames(confirmed_within);
        done.servers = devices.write_safe_registers(again_within, kick);
    }
    if (done.outputs_are_safe())
        outputs.guardian_says_safe();
    else
        outputs.lose(Time::min());
    return done;
}

int code_handed_on(int code) noexcept {
    const bool touched_nothing = code == static_cast<int>(Ending::wrong_set_up);
    return touched_nothing ? static_cast<int>(Ending::stopped_by_fault) : code;
}

} // namespace tappet
