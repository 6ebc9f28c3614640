// SPDX-License-Identifier: Apache-2.0
// What a slot holds, and what became of it.
#pragma once

#include "board/init/boot_state.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace tappet::box {

/// Of a version: whether it has proven itself, or why it is given up.
enum class Standing : std::uint8_t { untried, proven, harmed, silent };

/// In a file of one sector beside the kernel. The loader does not know it: it outlives a file of the loader's
/// that a power cut tore, and tells a start that was cut short from a trial that failed.
struct Record {
    Standing standing = Standing::untried;
    unsigned cut_short = 0; ///< starts in a row that did not come to their end

    friend bool operator==(const Record&, const Record&) = default;
};
inline constexpr std::string_view record_file = "RECORD";
/// Of one length, so that it is written in its place.
[[nodiscard]] std::string encode(const Record& record);
/// Untried, of anything else.
[[nodiscard]] Record record_of(std::string_view bytes);

struct Slot {
    std::string device{};
    init::BootState state{}; ///< of revision 0, failed, when it cannot be read
    std::string header{};    ///< of what lies in it; empty: it was written without
    Record record{};

    /// The loader would boot it when the other one fails.
    [[nodiscard]] bool is_good() const { return state.state == init::SlotState::good; }
    [[nodiscard]] bool is_on_trial() const;
};

/// For who asks.
[[nodiscard]] std::string standing_of(const Slot& slot);
/// "version 2, revision 3, good"
[[nodiscard]] std::string summary_of(const Slot& slot);

/// Whether the loader runs `running` because a start of the other one, which had proven itself, did not come
/// to its end. A slot that runs as the newest is marked by the loader; one to which it falls back is not.
[[nodiscard]] bool is_fallback(const Slot& running, const Slot& other);
/// Then: the other one starts once more, or is given up.
[[nodiscard]] Record after_cut_short(Record record, bool is_harmed);

} // namespace tappet::box
