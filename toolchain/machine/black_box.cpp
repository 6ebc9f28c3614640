// SPDX-License-Identifier: Apache-2.0
// Selects the oldest black box and replaces it.
#include "toolchain/machine/black_box.hpp"

#include "kernel/os/terminal.hpp"
#include "kernel/services/browsing/protocol.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include <fcntl.h>
#include <unistd.h>

namespace tappet {

namespace {

/// Returns the file's number; 0 when it is missing or damaged.
std::uint64_t number_of(const Sentence& path) {
    map::black_box::Record record;
    const int file = ::open(path.data(), O_RDONLY | O_CLOEXEC);
    const bool is_whole = file >= 0 && ::pread(file, &record, sizeof record, 0) == sizeof record &&
                          record.magic == map::black_box::magic;
    if (file >= 0) ::close(file);
    return is_whole ? record.number : 0;
}

} // namespace

// Selects by number, not by file time: the clock of a box without a battery restarts with each boot.
Sentence keep_black_box(std::string_view directory, map::black_box::Record record,
                        std::span<const std::byte> memory) {
    if (directory.empty()) return {};
    Sentence chosen;
    std::uint64_t oldest = UINT64_MAX, newest = 0;
    for (int n = 0; n < black_boxes_kept; ++n) {
        const Sentence path{directory, "/", std::string_view{record.machine.data()}, "-", n, ".blackbox"};
        const std::uint64_t number = number_of(path);
        newest = std::max(newest, number);
        if (number >= oldest) continue;
        oldest = number;
        chosen = path;
    }
    record.number = newest + 1;
    std::array<char, map::black_box::memory_at> head{};
    __builtin_memcpy(head.data(), &record, sizeof record);
    const std::string_view pieces[] = {{head.data(), head.size()},
                                       {reinterpret_cast<const char*>(memory.data()), memory.size()}};
    return os::replace_file(chosen.data(), pieces) ? chosen : Sentence{};
}

void add_answers(const Sentence& file, MachineInstance& instance) {
    const int out = ::open(file.data(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (out < 0) return;
    const auto add = [&](const Sentence& request) {
        static std::array<char, browsing::max_packet_bytes> room;
        const std::string_view answer = instance.observation().ask(Sentence{"0 ", request}.view(), room);
        if (!answer.empty() && os::write_all(out, request.view()) && os::write_all(out, "\t"))
            static_cast<void>(os::write_all(out, answer)); // the answer ends its line
    };
    add(Sentence{"behaviours"});
    const auto rows = instance.machine().table.behaviours;
    for (std::size_t b = 0; b < rows.size(); ++b) {
        const BehaviourSlot* slot = instance.slot_of_row(b);
        const BehaviourUnit* unit = slot != nullptr ? slot->active() : instance.unit_of_row(b);
        if (slot != nullptr) add(Sentence{"behaviours ", rows[b].component});
        if (unit == nullptr) continue;
        for (const UnitPart& part : unit->parts())
            add(Sentence{"behaviours ", rows[b].component, ".", part.row->name});
    }
    static_cast<void>(::fsync(out));
    ::close(out);
}

} // namespace tappet
