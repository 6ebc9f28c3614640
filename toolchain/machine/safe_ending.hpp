// SPDX-License-Identifier: Apache-2.0
// What a guardian does when the machine's process does not end well: the outputs become safe, or the box is
// reset.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/os/output_latch.hpp"
#include "kernel/os/watchdog.hpp"

#include <cstddef>

namespace tappet {

/// The machine's process, for whoever ends it.
class EndedProcess {
public:
    EndedProcess() = default;
    EndedProcess(const EndedProcess&) = delete;
    EndedProcess& operator=(const EndedProcess&) = delete;
    virtual void kill() noexcept = 0;
    /// Whether it has ended, or ends within `time`.
    [[nodiscard]] virtual bool await_end(Duration time) noexcept = 0;

protected:
    ~EndedProcess() = default;
};

/// What came of it.
struct SafeEnding {
    Duration written{};      ///< until the lines had their safe values
    Duration confirmed{};    ///< until the frames were confirmed, or given up
    bool ended = false;      ///< the process
    std::size_t chips = 0;   ///< that took no safe values
    std::size_t frames = 0;  ///< that nobody confirmed
    std::size_t servers = 0; ///< that did not confirm their registers

    /// Drives and servers that answer nobody are safe by their own time-out, or by nothing that this box can
    /// do.
    [[nodiscard]] bool outputs_are_safe() const noexcept { return ended && chips == 0; }
};

/// Kills the process, writes lines, awaits its end, writes lines again (another thread may have come in
/// between), sends frames until they are confirmed, writes registers, writes lines. Takes less than
/// os::guardian_acts_within, and kicks the watchdog meanwhile. When all is safe the latch says so; else
/// nobody kicks any more. Not real-time.
[[nodiscard]] SafeEnding end_safely(EndedProcess& process, GuardedDevices& devices, os::OutputLatch& outputs,
                                    os::Watchdog& watchdog) noexcept;

/// The guardian's exit code of a machine that it ended with `code`: never that nothing was touched.
[[nodiscard]] int code_handed_on(int code) noexcept;

} // namespace tappet
