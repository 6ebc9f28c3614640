// SPDX-License-Identifier: Apache-2.0
// A guardian's actions when the machine's process does not end well: the outputs become safe, or the box is
// reset.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/os/output_latch.hpp"
#include "kernel/os/watchdog.hpp"

#include <cstddef>

namespace tappet {

/// The machine's process, as an object that can be ended.
class EndedProcess {
public:
    EndedProcess() = default;
    EndedProcess(const EndedProcess&) = delete;
    EndedProcess& operator=(const EndedProcess&) = delete;
    virtual void kill() noexcept = 0;
    /// Returns whether it has ended, or ends within `time`.
    [[nodiscard]] virtual bool await_end(Duration time) noexcept = 0;

protected:
    ~EndedProcess() = default;
};

/// The result of end_safely().
struct SafeEnding {
    Duration written{};      ///< until the lines had their safe values
    Duration confirmed{};    ///< until the frames were confirmed, or given up
    bool ended = false;      ///< the process
    std::size_t chips = 0;   ///< chips that did not accept safe values
    std::size_t frames = 0;  ///< frames that nobody confirmed
    std::size_t servers = 0; ///< servers that did not confirm their registers

    /// Ignores drives and servers that do not answer: only their own time-out can make them safe, not this
    /// box.
    [[nodiscard]] bool outputs_are_safe() const noexcept { return ended && chips == 0; }
};

/// Kills the process, writes lines, awaits its end, writes lines again (another thread may have written in
/// between), sends frames until they are confirmed, writes registers, writes lines. Takes less than
/// os::guardian_acts_within, and kicks the watchdog meanwhile. When all is safe the latch records it;
/// otherwise nobody kicks the watchdog any more. Not real-time.
[[nodiscard]] SafeEnding end_safely(EndedProcess& process, GuardedDevices& devices, os::OutputLatch& outputs,
                                    os::Watchdog& watchdog) noexcept;

/// Returns the guardian's exit code for a machine ended with `code`: never "nothing was touched".
[[nodiscard]] int code_handed_on(int code) noexcept;

} // namespace tappet
