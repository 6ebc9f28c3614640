// SPDX-License-Identifier: Apache-2.0
// The processors that a box on the bench can have: what differs between them, and which one a program is for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tappet::bench {

struct Architecture {
    std::uint16_t elf = 0; // as the head of a program says it
    std::string name;
    std::string suffix; // behind the names of its kernels and of its PID 1
    std::string emulator;
    std::string package;              // in which that is
    std::vector<std::string> machine; // for the emulator
    std::string console;
    std::string set_up; // the command that fetches what it needs
};

// The head's number; 0: it is no program.
std::uint16_t elf_machine_of(const std::filesystem::path& file);

// Throws when the bench has no such box.
const Architecture& architecture_of(std::uint16_t elf, const std::filesystem::path& program);

// Of the first program among them; the host's if there is none.
const Architecture& architecture_of_first(const std::vector<std::filesystem::path>& files);

} // namespace tappet::bench
