// SPDX-License-Identifier: Apache-2.0
// Finds the place of the oldest, and replaces it.
#include "toolchain/machine/black_box.hpp"

#include "kernel/os/terminal.hpp"

#include <array>
#include <cstdint>

#include <sys/stat.h>

namespace tappet {

Sentence keep_black_box(std::string_view directory, const map::black_box::Record& record,
                        std::span<const std::byte> memory) {
    if (directory.empty()) return {};
    Sentence chosen;
    std::int64_t oldest = INT64_MAX;
    for (int n = 0; n < black_boxes_kept; ++n) {
        const Sentence path{directory, "/", std::string_view{record.machine.data()}, "-", n, ".blackbox"};
        struct stat facts{};
        const bool is_there = ::stat(path.data(), &facts) == 0;
        const std::int64_t written =
            is_there ? facts.st_mtim.tv_sec * 1'000'000'000 + facts.st_mtim.tv_nsec : -1;
        if (written >= oldest) continue;
        oldest = written;
        chosen = path;
        if (!is_there) break;
    }
    std::array<char, map::black_box::memory_at> head{};
    __builtin_memcpy(head.data(), &record, sizeof record);
    const std::string_view pieces[] = {{head.data(), head.size()},
                                       {reinterpret_cast<const char*>(memory.data()), memory.size()}};
    return os::replace_file(chosen.data(), pieces) ? chosen : Sentence{};
}

} // namespace tappet
