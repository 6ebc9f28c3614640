// A linked program: its code by objdump, the addresses of functions in its data by its ELF sections.
#include "tests/stack/bounds.hpp"

#include <cstdint>
#include <cstring>
#include <elf.h>
#include <fstream>
#include <iterator>
#include <map>

namespace tappet::stack_bound {

namespace {

template <class T> T at(const std::string& bytes, std::size_t place) {
    T value{};
    if (place + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + place, sizeof value);
    return value;
}

} // namespace

Image read_image(const std::string& path) {
    std::ifstream file{path, std::ios::binary};
    const std::string bytes{std::istreambuf_iterator<char>{file}, {}};
    const auto header = at<Elf64_Ehdr>(bytes, 0);
    if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) return {};
    Image image;
    image.functions = waitfree::disassemble({path});
    std::map<std::uint64_t, std::string> at_address;
    for (const auto& [name, function] : image.functions)
        if (!function.code.empty()) at_address[function.code.front().address] = name;
    const std::string_view names = [&] {
        const auto section = at<Elf64_Shdr>(bytes, header.e_shoff + header.e_shstrndx * sizeof(Elf64_Shdr));
        return std::string_view{bytes}.substr(std::min(section.sh_offset, bytes.size()), section.sh_size);
    }();
    // A jump into the middle of a cold part is a jump to it: all of it is treated as entered anywhere.
    for (auto& [name, function] : image.functions)
        for (waitfree::Instruction& one : function.code) {
            const auto after = at_address.upper_bound(one.reckoned);
            if (!one.symbol.empty() && one.reckoned != 0 && after != at_address.begin())
                if (const std::string& holder = std::prev(after)->second;
                    holder.find(".cold") != std::string::npos && holder != name)
                    one.symbol = holder;
        }
    const auto take = [&](std::uint64_t address) {
        if (const auto found = at_address.find(address); found != at_address.end())
            image.taken.insert(found->second);
    };
    for (unsigned i = 0; i < header.e_phnum; ++i)
        if (const auto part = at<Elf64_Phdr>(bytes, header.e_phoff + i * sizeof(Elf64_Phdr));
            part.p_type == PT_TLS)
            image.thread_local_bytes = part.p_memsz + part.p_align;
    for (unsigned i = 0; i < header.e_shnum; ++i) {
        const auto section = at<Elf64_Shdr>(bytes, header.e_shoff + i * sizeof(Elf64_Shdr));
        // The linker's stubs of functions that libc picks for the processor when the program starts.
        if (names.substr(section.sh_name).starts_with(".plt"))
            for (auto& [name, function] : image.functions)
                for (waitfree::Instruction& one : function.code)
                    if (!one.symbol.empty() && one.reckoned - section.sh_addr < section.sh_size)
                        one.symbol = picked_at_start;
        const bool is_data = section.sh_type == SHT_PROGBITS && (section.sh_flags & SHF_ALLOC) != 0 &&
                             (section.sh_flags & SHF_EXECINSTR) == 0;
        for (std::uint64_t word = 0; is_data && word + 8 <= section.sh_size; word += 8)
            take(at<std::uint64_t>(bytes, section.sh_offset + word));
    }
    // A pointer that code makes: an address relative to the instruction, which objdump reckons, or a number.
    for (const auto& [name, function] : image.functions)
        for (const waitfree::Instruction& one : function.code)
            if (one.reckoned != 0) take(one.reckoned);
    return image;
}

} // namespace tappet::stack_bound
