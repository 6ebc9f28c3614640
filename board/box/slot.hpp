// SPDX-License-Identifier: Apache-2.0
// The contents of a slot, and its history.
#pragma once

#include "board/init/boot_state.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace tappet::box {

/// State of a version: proven, or the reason why it was given up.
enum class Standing : std::uint8_t { untried, proven, harmed, silent };

/// Stored in a file of one sector next to the kernel, unknown to the loader: it survives when a power cut
/// tears the loader's file, and distinguishes an interrupted start from a failed trial.
struct Record {
    Standing standing = Standing::untried;
    unsigned cut_short = 0; ///< starts in a row that were interrupted

    friend bool operator==(const Record&, const Record&) = default;
};
inline constexpr std::string_view record_file = "RECORD";
/// Returns the file's contents, of constant length, so that it is overwritten in place.
[[nodiscard]] std::string encode(const Record& record);
/// Reads a record; anything invalid gives `untried`.
[[nodiscard]] Record record_of(std::string_view bytes);

struct Slot {
    std::string device{};
    init::BootState state{}; ///< revision 0 and failed when it cannot be read
    std::string header{};    ///< header of its contents; empty: it was written without one
    Record record{};

    /// Returns whether the loader would boot it when the other one fails.
    [[nodiscard]] bool is_good() const { return state.state == init::SlotState::good; }
    [[nodiscard]] bool is_on_trial() const;
};

/// Returns the state as text for status requests.
[[nodiscard]] std::string standing_of(const Slot& slot);
/// Returns "version 2, revision 3, good".
[[nodiscard]] std::string summary_of(const Slot& slot);

/// Returns whether the loader runs `running` because a start of the other, proven slot was interrupted. The
/// loader marks a slot that it runs as the newest; it does not mark one that it falls back to.
[[nodiscard]] bool is_fallback(const Slot& running, const Slot& other);
/// Returns the other slot's record after that: it starts once more, or is given up.
[[nodiscard]] Record after_cut_short(Record record, bool is_harmed);

} // namespace tappet::box
