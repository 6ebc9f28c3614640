// Asks the kernel for its release and the file system for the size of this program.
#include "kernel/os/box.hpp"

#include "kernel/os/arming.hpp"

#include <cstring>
#include <ctime>
#include <string_view>

#include <elf.h>
#include <link.h>
#include <sys/stat.h>
#include <sys/utsname.h>

namespace tappet::os {

Sentence kernel_release() noexcept {
    utsname names{};
    if (uname(&names) != 0) return Sentence{"unknown"};
    return Sentence{std::string_view{names.release}};
}

bool kernel_is_realtime() noexcept {
    const ArmingOptions here;
    for (const SystemCheck& check : system_checks())
        if (check.name == "realtime-kernel") return check.look(here, {}).good;
    return false;
}

std::size_t binary_bytes() noexcept {
    struct stat status{};
    return stat("/proc/self/exe", &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

namespace {

void take_build_id(const char* note, const char* end, BuildId& id) noexcept {
    while (note + sizeof(ElfW(Nhdr)) <= end) {
        ElfW(Nhdr) head;
        std::memcpy(&head, note, sizeof head);
        const char* name = note + sizeof head;
        const char* content = name + (head.n_namesz + 3) / 4 * 4;
        note = content + (head.n_descsz + 3) / 4 * 4;
        if (note > end) return;
        if (head.n_type != NT_GNU_BUILD_ID || head.n_namesz != 4 || std::memcmp(name, "GNU", 4) != 0)
            continue;
        for (std::size_t i = 0; i < head.n_descsz && id.length + 2 <= id.digits.size(); ++i)
            for (const int shift : {4, 0})
                id.digits[id.length++] =
                    "0123456789abcdef"[static_cast<unsigned char>(content[i]) >> shift & 15];
        return;
    }
}

} // namespace

BuildId build_id() noexcept {
    BuildId id;
    dl_iterate_phdr(
        [](dl_phdr_info* program, std::size_t, void* into) {
            for (std::size_t i = 0; i < program->dlpi_phnum; ++i) {
                const auto& segment = program->dlpi_phdr[i];
                if (segment.p_type != PT_NOTE) continue;
                const auto* note = reinterpret_cast<const char*>(program->dlpi_addr + segment.p_vaddr);
                take_build_id(note, note + segment.p_filesz, *static_cast<BuildId*>(into));
            }
            return 1; // the program itself comes first; its libraries are not searched
        },
        &id);
    return id;
}

std::int64_t wall_clock_ns() noexcept {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

Duration own_processor_time() noexcept {
    timespec used{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return std::chrono::seconds{used.tv_sec} + Duration{used.tv_nsec};
}

} // namespace tappet::os
