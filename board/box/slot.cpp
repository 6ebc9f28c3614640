// SPDX-License-Identifier: Apache-2.0
// A record is a line of words.
#include "board/box/slot.hpp"

#include "board/box/facts.hpp"
#include "board/box/update.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>

namespace tappet::box {

namespace {

constexpr std::size_t record_bytes = 512;
constexpr unsigned most_cut_short = 2; // a power cut in the second start after a power cut is bad luck

constexpr std::string_view standings[] = {"untried", "proven", "harmed", "silent"};

} // namespace

std::string encode(const Record& record) {
    std::string bytes = "standing " + std::string{standings[static_cast<std::size_t>(record.standing)]} +
                        " " + std::to_string(record.cut_short);
    bytes.resize(record_bytes, '\n');
    return bytes;
}

Record record_of(std::string_view bytes) {
    const Facts facts{bytes};
    const auto found = std::ranges::find(standings, facts.one("standing"));
    if (found == std::end(standings)) return {};
    return {static_cast<Standing>(found - standings),
            static_cast<unsigned>(std::strtoul(facts.one("standing", 1).c_str(), nullptr, 10))};
}

bool Slot::is_on_trial() const {
    return record.standing == Standing::untried &&
           (state.state == init::SlotState::testing || state.state == init::SlotState::installed);
}

std::string standing_of(const Slot& slot) {
    if (slot.record.standing == Standing::harmed) return "given up: its kernel is not what was written there";
    if (slot.record.standing == Standing::silent)
        return "given up: " + std::to_string(slot.record.cut_short + 1) + " starts in a row did not finish";
    // A proven version is on trial at each start, which matters only to the loader.
    if (slot.record.standing == Standing::proven && slot.state.state != init::SlotState::failed)
        return std::string{init::name_of(init::SlotState::good)};
    return std::string{init::name_of(slot.state.state)};
}

std::string summary_of(const Slot& slot) {
    const std::uint32_t version = manifest_of(slot.header).version;
    return "version " + (version == 0 ? "unknown" : std::to_string(version)) + ", revision " +
           std::to_string(slot.state.revision) + ", " + standing_of(slot);
}

bool is_fallback(const Slot& running, const Slot& other) {
    return running.is_good() && other.record.standing == Standing::proven &&
           other.state.state == init::SlotState::failed;
}

Record after_cut_short(Record record, bool is_harmed) {
    if (is_harmed)
        record.standing = Standing::harmed;
    else if (record.cut_short >= most_cut_short)
        record.standing = Standing::silent;
    else
        ++record.cut_short;
    return record;
}

} // namespace tappet::box
