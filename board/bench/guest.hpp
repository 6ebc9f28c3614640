// SPDX-License-Identifier: Apache-2.0
// What every part of PID 1 needs: the way to tell the host, to give up, and to read and write small files of
// the kernel.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace tappet::bench {

// What the host reads: one line per fact, written at once, so that a bench that hangs still tells how far it
// got.
class Results {
public:
    void open(int descriptor) { descriptor_ = descriptor; }

    void line(const std::string& text) { write_all(text + "\n"); }

    void write_all(std::string_view bytes);

private:
    int descriptor_ = -1;
};

extern Results results;

[[noreturn]] void power_off();

// The guest cannot go on: the host must learn why, and on the kernel's console too if no port is up yet.
[[noreturn]] void give_up(const std::string& what);

void pause_for(std::chrono::milliseconds time);

void make_folder(const std::string& path);
bool write_text(const std::string& path, const std::string& text);
std::string read_line(const std::string& path);
void mount_at(const char* type, const std::string& path);

} // namespace tappet::bench
