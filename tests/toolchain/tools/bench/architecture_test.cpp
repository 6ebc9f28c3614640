// A box of the bench takes the architecture of its first program.
#include "toolchain/tools/bench/architecture.hpp"
#include "toolchain/tools/bench/folders.hpp"
#include "toolchain/tools/bench/initramfs.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include <elf.h>

namespace tappet::bench {
namespace {

class ArchitectureOfABox : public testing::Test {
protected:
    std::filesystem::path program(const char* name, std::uint16_t elf) {
        Elf64_Ehdr head{};
        std::copy_n(ELFMAG, SELFMAG, head.e_ident);
        head.e_machine = elf;
        std::ofstream(folder / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(&head), sizeof head);
        return folder / name;
    }
    std::filesystem::path script() {
        std::ofstream(folder / "script") << "#!/bin/sh\n";
        return folder / "script";
    }
    WorkFolder folder{"architecture-test"};
};

TEST_F(ArchitectureOfABox, is_that_of_the_first_program) {
    EXPECT_EQ(architecture_of_first({script(), program("a", EM_AARCH64), program("b", EM_X86_64)}).name,
              "aarch64");
    EXPECT_EQ(architecture_of_first({program("b", EM_X86_64), program("a", EM_AARCH64)}).name, "x86-64");
}

TEST_F(ArchitectureOfABox, is_that_of_the_host_without_a_program) {
    EXPECT_EQ(architecture_of_first({}).name, "x86-64");
    EXPECT_EQ(architecture_of_first({script(), folder / "nothing", "/tmp"}).name, "x86-64");
}

TEST_F(ArchitectureOfABox, is_refused_when_the_bench_does_not_have_it) {
    EXPECT_THROW(static_cast<void>(architecture_of_first({program("r", EM_RISCV)})), BenchError);
}

TEST_F(ArchitectureOfABox, excludes_programs_of_another_architecture) {
    Initramfs root{folder / "root.cpio", architecture_of_first({program("a", EM_AARCH64)})};
    EXPECT_THROW(root.add(program("b", EM_X86_64), "/bin/b"), BenchError);
    EXPECT_NO_THROW(root.add(script(), "/bin/script"));
}

} // namespace
} // namespace tappet::bench
