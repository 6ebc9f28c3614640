// SPDX-License-Identifier: Apache-2.0
// The guest's root file system: an archive in the "newc" format, which the kernel unpacks into memory.
#pragma once

#include <cstdio>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "toolchain/tools/bench/architecture.hpp"

namespace tappet::bench {

// A fault of a scenario or its surroundings; the text names what, where and the cure.
struct BenchError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Initramfs {
public:
    // For a box of this architecture; refuses programs of another.
    Initramfs(const std::filesystem::path& archive, const Architecture& architecture);
    ~Initramfs();
    Initramfs(const Initramfs&) = delete;
    Initramfs& operator=(const Initramfs&) = delete;

    void add_folder(const std::string& guest);
    void add_text(const std::string& guest, std::string_view text);
    // Adds a file. A program includes its shared libraries, at the place where its loader searches them; a
    // folder is copied completely.
    void add(const std::filesystem::path& host, const std::string& guest);
    // Adds a program of the host, by its name, to /bin. Python includes its standard library.
    void add_tool(const std::string& name);
    void finish();

private:
    void add_file(const std::filesystem::path& host, const std::string& guest);
    void add_libraries(const std::filesystem::path& program);
    void entry(const std::string& guest, unsigned mode, std::string_view content, unsigned major = 0,
               unsigned minor = 0);

    const Architecture& architecture_;
    std::FILE* archive_;
    std::set<std::string> present_;
    unsigned next_inode_ = 1;
};

// Returns where a program of that name is on the host.
std::filesystem::path find_program(const std::string& name);

} // namespace tappet::bench
