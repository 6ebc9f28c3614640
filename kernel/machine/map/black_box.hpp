// SPDX-License-Identifier: Apache-2.0
// The layout of a black box: what a machine's guardian keeps of a machine that ended otherwise than it was
// asked to.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

/// A file. It begins with Record; the machine's memory, as layout.hpp describes it, follows at memory_at, as
/// it stood when the outputs were safe. An activity whose generation is odd was in its cycle, and what it
/// writes may be half written. All integers are little-endian; texts end with a zero. After the memory stand
/// what the machine then answered to browsers: lines of a request, a tabulator and the answer as
/// kernel/services/browsing/protocol.hpp has it; none when nothing in it answers, or it was damaged.
namespace tappet::map::black_box {

inline constexpr std::array<char, 8> magic{'T', 'A', 'P', 'P', 'E', 'T', 'B', 'B'};
inline constexpr std::uint32_t version = 2;
inline constexpr std::uint64_t memory_at = 4096; ///< a whole page: it may be mapped

struct Record {
    std::array<char, 8> magic{};
    std::uint32_t version = 0;
    std::int32_t exit_code = 0;     ///< of the machine's process; 128 and the signal that ended it
    std::uint64_t memory_bytes = 0; ///< 0: nothing of the machine could be seen
    std::int64_t wall_ns = 0;       ///< since 1970, UTC
    std::int64_t machine_ns = 0;    ///< in the machine's own time, as its stamps
    std::int32_t signal = 0;        ///< of a crash; 0: none
    std::int32_t thread = 0;
    std::uint64_t instruction = 0; ///< in the program of build_id
    std::uint64_t address = 0;
    std::array<std::uint64_t, 16> returns{}; ///< on the stack of the crash, see os::CrashNote
    std::array<char, 16> thread_name{};
    std::array<char, 64> machine{};
    std::array<char, 64> board{};
    std::array<char, 64> build_id{};
    std::array<char, 512> reason{};
    std::array<char, 512> done{}; ///< by the guardian
    std::uint64_t number = 0;     ///< of those that the machine left there, from 1, whatever the clock said
};
static_assert(std::is_trivially_copyable_v<Record> && sizeof(Record) <= memory_at);

} // namespace tappet::map::black_box
