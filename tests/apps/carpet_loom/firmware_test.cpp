// A firmware as a file: fully static, small, with its memory known at build time.
#include <gtest/gtest.h>

#include <elf.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

namespace {

struct Firmware {
    std::vector<char> bytes;
    explicit Firmware(const char* path) {
        std::ifstream file{path, std::ios::binary};
        bytes.assign(std::istreambuf_iterator<char>{file}, {});
    }
    template <class T>
    [[nodiscard]] T at(std::size_t offset) const {
        T value{};
        if (offset + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + offset, sizeof value);
        return value;
    }
    [[nodiscard]] Elf64_Ehdr header() const { return at<Elf64_Ehdr>(0); }
    [[nodiscard]] bool has_segment(std::uint32_t type) const {
        const Elf64_Ehdr head = header();
        for (unsigned i = 0; i < head.e_phnum; ++i)
            if (at<Elf64_Phdr>(head.e_phoff + i * sizeof(Elf64_Phdr)).p_type == type) return true;
        return false;
    }
    /// Bytes of all loaded sections; `writable_only`: of the writable ones.
    [[nodiscard]] std::uint64_t loaded_bytes(bool writable_only) const {
        const Elf64_Ehdr head = header();
        std::uint64_t sum = 0;
        for (unsigned i = 0; i < head.e_shnum; ++i) {
            const auto section = at<Elf64_Shdr>(head.e_shoff + i * sizeof(Elf64_Shdr));
            if ((section.sh_flags & SHF_ALLOC) == 0) continue;
            if (writable_only ? (section.sh_flags & SHF_WRITE) != 0 : section.sh_type != SHT_NOBITS)
                sum += section.sh_size;
        }
        return sum;
    }
};

class FirmwareFile : public testing::TestWithParam<const char*> {
protected:
    Firmware firmware_{GetParam()};
};

TEST_P(FirmwareFile, is_a_64_bit_executable) {
    ASSERT_GT(firmware_.bytes.size(), sizeof(Elf64_Ehdr)) << GetParam();
    const Elf64_Ehdr header = firmware_.header();
    EXPECT_EQ(0, std::memcmp(header.e_ident, ELFMAG, SELFMAG));
#if defined(__aarch64__)
    EXPECT_EQ(EM_AARCH64, header.e_machine);
#else
    EXPECT_EQ(EM_X86_64, header.e_machine);
#endif
}

TEST_P(FirmwareFile, asks_for_no_interpreter_and_no_library) {
    EXPECT_TRUE(firmware_.has_segment(PT_LOAD));
    EXPECT_FALSE(firmware_.has_segment(PT_INTERP));
    EXPECT_FALSE(firmware_.has_segment(PT_DYNAMIC));
}

TEST_P(FirmwareFile, is_under_2_MB_without_its_symbols) {
    EXPECT_LT(firmware_.loaded_bytes(false), 2u << 20);
}

TEST_P(FirmwareFile, takes_under_4_MB_of_static_memory) {
    const std::uint64_t bytes = firmware_.loaded_bytes(true);
    EXPECT_GT(bytes, 100'000u) << "a machine has stacks at least";
    EXPECT_LT(bytes, 4u << 20);
    RecordProperty("static_bytes", std::to_string(bytes));
}

INSTANTIATE_TEST_SUITE_P(each_board, FirmwareFile,
                         testing::Values(TAPPET_FIRMWARE_BENCH, TAPPET_FIRMWARE_IPC));

} // namespace
