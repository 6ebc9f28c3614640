// SPDX-License-Identifier: Apache-2.0
// Common work of every PID 1 here with the kernel's small files, mounts and children, without external tools.
#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace tappet::init {

/// The error is a sentence: what failed, and the kernel's reason.
using Done = std::expected<void, std::string>;
/// Returns an error with the text of errno.
[[nodiscard]] std::unexpected<std::string> failed(const std::string& what);
/// Closes the descriptor if it is open; preserves errno.
void close_it(int descriptor);

void pause_for(std::chrono::milliseconds time);

void make_folder(const std::string& path);
/// Writes to an existing file; on failure errno has the reason.
bool write_text(const std::string& path, std::string_view text);
/// Returns the whole file; empty when it cannot be read.
[[nodiscard]] std::string read_text(const std::string& path);
[[nodiscard]] std::string read_line(const std::string& path);
/// Returns the names in a folder; none when it does not exist.
[[nodiscard]] std::vector<std::string> names_in(const std::string& folder);

/// Mounts the kernel's own file systems at their usual places.
[[nodiscard]] Done mount_kernel_files();

/// Stops the kernel from taking processors from real-time threads: disables throttling and, since Linux 6.12,
/// the fair server of each processor, which only debugfs reaches; debugfs stays mounted if there is one.
/// Returns the number of fair servers stopped.
[[nodiscard]] std::expected<int, std::string> stop_throttling();

/// Starts a program in its own session, its output and errors to `output`. The error: no process was created.
[[nodiscard]] std::expected<pid_t, std::string> start(const std::vector<std::string>& words, int output,
                                                      const std::string& cure);
/// Returns the exit code as a shell does: 128 plus the number of the signal that ended it.
[[nodiscard]] int to_exit_code(int status);
/// Calls `ended` for every child that has ended; PID 1 inherits every orphan.
void reap(const std::function<void(pid_t, int exit_code)>& ended);

/// Returns the present children from /proc.
[[nodiscard]] std::vector<pid_t> children_of(pid_t parent);

/// Resets at once, without waiting for disks.
[[noreturn]] void reset_box();
/// Switches off permanently, after everything is written to the disks.
[[noreturn]] void power_off();
[[noreturn]] void restart_box();

} // namespace tappet::init
