// SPDX-License-Identifier: Apache-2.0
// The layout of a black box: the file that a machine's guardian writes when the machine ends without a
// request.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

/// A file. It begins with Record. The machine's memory, as layout.hpp describes it, follows at memory_at, in
/// its state when the outputs were safe. An activity with an odd generation was in its cycle, and its data
/// may be half written. All integers are little-endian; texts end with a zero. After the memory follow the
/// answers that the machine then gave to browsers: lines of a request, a tabulator and the answer as
/// kernel/services/browsing/protocol.hpp defines it. There are none when nothing in the machine answers, or
/// when it was damaged.
namespace tappet::map::black_box {

inline constexpr std::array<char, 8> magic{'T', 'A', 'P', 'P', 'E', 'T', 'B', 'B'};
inline constexpr std::uint32_t version = 2;
inline constexpr std::uint64_t memory_at = 4096; ///< a whole page: it may be mapped

struct Record {
    std::array<char, 8> magic{};
    std::uint32_t version = 0;
    std::int32_t exit_code = 0;     ///< of the machine's process; 128 + the signal that ended it
    std::uint64_t memory_bytes = 0; ///< 0: the machine's memory could not be read
    std::int64_t wall_ns = 0;       ///< since 1970, UTC
    std::int64_t machine_ns = 0;    ///< in the machine's own time, like its stamps
    std::int32_t signal = 0;        ///< of a crash; 0: none
    std::int32_t thread = 0;
    std::uint64_t instruction = 0; ///< address in the program of build_id
    std::uint64_t address = 0;
    std::array<std::uint64_t, 16> returns{}; ///< on the stack of the crash, see os::CrashNote
    std::array<char, 16> thread_name{};
    std::array<char, 64> machine{};
    std::array<char, 64> board{};
    std::array<char, 64> build_id{};
    std::array<char, 512> reason{};
    std::array<char, 512> done{}; ///< what the guardian did
    std::uint64_t number = 0;     ///< of the machine's black boxes there, from 1; independent of the clock
};
static_assert(std::is_trivially_copyable_v<Record> && sizeof(Record) <= memory_at);

} // namespace tappet::map::black_box
