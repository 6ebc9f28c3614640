// SPDX-License-Identifier: Apache-2.0
// The processors of boxes on the bench: their differences, and the processor that a program is for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tappet::bench {

struct Architecture {
    std::uint16_t elf = 0; // as in a program's ELF header
    std::string name;
    std::string suffix; // of the names of its kernels and of its PID 1
    std::string emulator;
    std::string package;              // that contains the emulator
    std::vector<std::string> machine; // for the emulator
    std::string console;
    std::string set_up; // the command that fetches its prerequisites
};

// Returns the machine number of the ELF header; 0: no program.
std::uint16_t elf_machine_of(const std::filesystem::path& file);

// Throws when the bench has no such box.
const Architecture& architecture_of(std::uint16_t elf, const std::filesystem::path& program);

// Returns the architecture of the first program among the files; the host's if there is none.
const Architecture& architecture_of_first(const std::vector<std::filesystem::path>& files);

} // namespace tappet::bench
