// SPDX-License-Identifier: Apache-2.0
// What every PID 1 of ours does with the kernel's small files, its mounts and its children, without a heap of
// tools around it.
#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace tappet::init {

/// The error is a sentence: what could not be done, and what the kernel said to it.
using Done = std::expected<void, std::string>;
/// With the kernel's last word, errno.
[[nodiscard]] std::unexpected<std::string> failed(const std::string& what);
/// If it is open; what went wrong before is left in errno.
void close_it(int descriptor);

void pause_for(std::chrono::milliseconds time);

void make_folder(const std::string& path);
/// Into a file that is there; errno tells why not.
bool write_text(const std::string& path, std::string_view text);
/// All of it; empty when it cannot be read.
[[nodiscard]] std::string read_text(const std::string& path);
[[nodiscard]] std::string read_line(const std::string& path);
/// The names in a folder; none when there is no such folder.
[[nodiscard]] std::vector<std::string> names_in(const std::string& folder);

/// The kernel's own file systems, where every program looks for them.
[[nodiscard]] Done mount_kernel_files();

/// Stops what takes processors from real-time threads: throttling and, since Linux 6.12, the fair server of
/// each processor, which only debugfs reaches; debugfs stays mounted where there is one. Returns the number
/// of fair servers stopped.
[[nodiscard]] std::expected<int, std::string> stop_throttling();

/// A program in a session of its own, its output and errors to `output`. The error: no process was left.
[[nodiscard]] std::expected<pid_t, std::string> start(const std::vector<std::string>& words, int output,
                                                      const std::string& cure);
/// As a shell tells it: 128 and the number of the signal that ended it.
[[nodiscard]] int to_exit_code(int status);
/// Tells of every child that has ended; PID 1 inherits every orphan.
void reap(const std::function<void(pid_t, int exit_code)>& ended);

/// As /proc has them at this moment.
[[nodiscard]] std::vector<pid_t> children_of(pid_t parent);

/// At once: a disk that does not answer keeps nobody.
[[noreturn]] void reset_box();
/// For good, with everything written to the disks.
[[noreturn]] void power_off();
[[noreturn]] void restart_box();

} // namespace tappet::init
