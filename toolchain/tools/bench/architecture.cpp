// SPDX-License-Identifier: Apache-2.0
#include "toolchain/tools/bench/architecture.hpp"

#include "toolchain/tools/bench/initramfs.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

#include <elf.h>

namespace tappet::bench {

namespace {

const std::array<Architecture, 2>& architectures() {
    static const std::array<Architecture, 2> all{
        {{EM_X86_64, "x86-64", "", "qemu-system-x86_64", "qemu-system-x86", {"q35"}, "ttyS0", "ci/setup"},
         // The oldest processor with the atomic instructions for which the firmware is compiled.
         {EM_AARCH64,
          "aarch64",
          "-aarch64",
          "qemu-system-aarch64",
          "qemu-system-arm",
          {"virt", "-cpu", "cortex-a76"},
          "ttyAMA0",
          "ci/setup aarch64"}}};
    return all;
}

} // namespace

std::uint16_t elf_machine_of(const std::filesystem::path& file) {
    std::ifstream program(file, std::ios::binary);
    Elf64_Ehdr head{};
    program.read(reinterpret_cast<char*>(&head), sizeof head);
    return program && std::memcmp(head.e_ident, ELFMAG, SELFMAG) == 0 ? head.e_machine : std::uint16_t{0};
}

const Architecture& architecture_of(std::uint16_t elf, const std::filesystem::path& program) {
    const auto found = std::ranges::find(architectures(), elf, &Architecture::elf);
    if (found == architectures().end())
        throw BenchError(
            "'" + program.string() +
            "' is a program for a processor that the bench does not emulate; build it for x86-64 "
            "or aarch64");
    return *found;
}

const Architecture& architecture_of_first(const std::vector<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files)
        if (const std::uint16_t elf = elf_machine_of(file); elf != 0) return architecture_of(elf, file);
    return architectures().front();
}

} // namespace tappet::bench
