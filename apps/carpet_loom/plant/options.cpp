// Parses the options of a loom and checks their values.
#include "apps/carpet_loom/plant/options.hpp"

#include "apps/carpet_loom/wires.hpp"
#include "kernel/base/value_bytes.hpp"

#include <array>
#include <charconv>
#include <optional>
#include <string_view>

namespace tappet::loom {
namespace {

constexpr std::array<std::pair<std::string_view, Fault>, 9> faults{{
    {"--weft-break-at", Fault::weft_break},
    {"--warp-break-at", Fault::warp_break},
    {"--node-lost-at", Fault::node_lost},
    {"--drive-fault-at", Fault::drive_fault},
    {"--oil-lost-at", Fault::oil_lost},
    {"--oil-level-low-at", Fault::oil_level_low},
    {"--feeder-empty-at", Fault::feeder_empty},
    {"--emergency-stop-at", Fault::emergency_stop},
    {"--operator-stop-at", Fault::operator_stop},
}};

std::optional<std::uint64_t> number(std::string_view text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::optional<Duration> duration(std::string_view text) {
    std::int64_t ns = 0;
    if (!parse_duration(text, ns).empty() || ns < 0) return std::nullopt;
    return Duration{ns};
}

/// Parses WHEN[/DURATION][:NODE]; WHEN is a number of picks or a time.
std::optional<ScriptedFault> scripted(Fault fault, std::string_view text) {
    ScriptedFault row{.fault = fault};
    const bool wants_node = fault == Fault::node_lost || fault == Fault::drive_fault;
    if (const auto colon = text.find(':'); colon != text.npos) {
        const auto node = number(text.substr(colon + 1));
        const std::uint64_t last =
            fault == Fault::drive_fault ? wires::node::let_off_drive : wires::node::count;
        if (!wants_node || !node || *node == 0 || *node > last) return std::nullopt;
        row.node = static_cast<std::uint8_t>(*node);
        text = text.substr(0, colon);
    } else if (wants_node) {
        return std::nullopt;
    }
    if (const auto slash = text.find('/'); slash != text.npos) {
        const auto lasts = duration(text.substr(slash + 1));
        if (!lasts) return std::nullopt;
        row.lasts = *lasts;
        text = text.substr(0, slash);
    }
    if (const auto at = duration(text)) {
        row.at = Time{} + *at;
    } else if (const auto pick = number(text)) {
        row.at_pick = *pick;
    } else {
        return std::nullopt;
    }
    return row;
}

template <class T>
bool store(const std::optional<T>& from, T& to) {
    if (from) to = *from;
    return from.has_value();
}

} // namespace

bool read_option(std::string_view word, std::string_view value, Settings& to, bool& known) {
    known = true;
    if (word == "--picks") return store(number(value), to.last_pick) && to.last_pick != 0;
    if (word == "--picks-after-usr1") return store(number(value), to.picks_after_told);
    if (word == "--edge-burst-at") return store(duration(value), to.edge_burst_at);
    if (word == "--operator-reaction") return store(duration(value), to.operator_reaction);
    if (word == "--weft-break-one-in") return store(number(value), to.weft_break_one_in);
    if (word == "--warp-break-one-in") return store(number(value), to.warp_break_one_in);
    if (word == "--operator-stop-one-in") return store(number(value), to.operator_stop_one_in);
    if (word == "--emergency-stop-one-in") return store(number(value), to.emergency_stop_one_in);
    for (const auto& [name, fault] : faults)
        if (word == name) {
            const auto row = scripted(fault, value);
            return row && to.script.push(*row);
        }
    known = false;
    return false;
}

std::string_view usage() {
    return "  --picks N               ends when N picks are woven and the loom stands (default: never)\n"
           "  --picks-after-usr1 N    ends at the earliest N picks after the signal USR1 (default: waits for "
           "no signal)\n"
           "  --operator-reaction T   time from standstill to the repair (default 1s)\n"
           "chances per pick, one in N: --weft-break-one-in --warp-break-one-in --operator-stop-one-in\n"
           "  --emergency-stop-one-in\n"
           "faults, WHEN[/DURATION], WHEN = picks (40) or time (20s, 500ms); without duration until "
           "repaired:\n"
           "  --weft-break-at --warp-break-at --oil-lost-at --oil-level-low-at --feeder-empty-at\n"
           "  --emergency-stop-at --operator-stop-at, and with :NODE --node-lost-at (1..6) --drive-fault-at "
           "(1..2)\n"
           "  --edge-burst-at T       the weft detector's line flutters\n";
}

} // namespace tappet::loom
