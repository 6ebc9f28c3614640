// Reading the command line: every wrong word is refused with the word, the reason and what would be right.
#include "apps/carpet_loom/plant/bench/options.hpp"

#include "apps/carpet_loom/wires.hpp"

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

/// "20s", "500ms" or "200us".
std::optional<Duration> duration(std::string_view text) {
    for (const auto& [unit, size] :
         {std::pair<std::string_view, Duration>{"ms", 1ms}, {"us", 1us}, {"s", 1s}}) {
        if (!text.ends_with(unit)) continue;
        const auto count = number(text.substr(0, text.size() - unit.size()));
        if (!count || *count > 1'000'000'000) return std::nullopt;
        return static_cast<std::int64_t>(*count) * size;
    }
    return std::nullopt;
}

/// WHEN[/DURATION][:NODE], WHEN a number of picks or a time.
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

class Reader {
public:
    Reader(std::string_view word, std::string_view value) : word_(word), value_(value) {}

    [[nodiscard]] bool is(std::string_view name) const { return word_ == name; }
    bool take(std::string& to) {
        to = value_;
        return true;
    }
    bool take(std::uint64_t& to) { return store(number(value_), to); }
    bool take(Duration& to) { return store(duration(value_), to); }
    bool take(int& to, int most) {
        const auto value = number(value_);
        if (!value || *value > static_cast<std::uint64_t>(most)) return false;
        to = static_cast<int>(*value);
        return true;
    }
    bool take(Outage& to) {
        const auto slash = value_.find('/');
        if (slash == value_.npos) return false;
        return store(duration(value_.substr(0, slash)), to.at) &&
               store(duration(value_.substr(slash + 1)), to.lasts);
    }
    bool take_fault(Fault fault, Settings& settings) {
        const auto row = scripted(fault, value_);
        return row && settings.script.push(*row);
    }

private:
    template <class T> static bool store(const std::optional<T>& from, T& to) {
        if (from) to = *from;
        return from.has_value();
    }
    std::string_view word_;
    std::string_view value_;
};

/// True when the word is known and its value right; `known` tells the two apart.
bool read(Reader reader, Options& to, bool& known) {
    known = true;
    if (reader.is("--can")) return reader.take(to.can);
    if (reader.is("--gpio-chip")) return reader.take(to.gpio_chip);
    if (reader.is("--modbus-port")) return reader.take(to.modbus_port, 65535);
    if (reader.is("--modbus-address")) return reader.take(to.modbus_address);
    if (reader.is("--seed")) return reader.take(to.seed);
    if (reader.is("--picks")) return reader.take(to.picks);
    if (reader.is("--picks-after-usr1")) return reader.take(to.picks_after_usr1);
    if (reader.is("--report")) return reader.take(to.report);
    if (reader.is("--period")) return reader.take(to.period) && to.period >= 50us && to.period <= 10ms;
    if (reader.is("--fifo")) return reader.take(to.fifo_priority, 98);
    if (reader.is("--stop-modbus-at")) return reader.take(to.modbus_stop);
    if (reader.is("--bus-off-at")) return reader.take(to.bus_off_at);
    if (reader.is("--edge-burst-at")) return reader.take(to.edge_burst_at);
    if (reader.is("--die-at")) return reader.take(to.die_at);
    if (reader.is("--operator-reaction")) return reader.take(to.settings.operator_reaction);
    if (reader.is("--weft-break-one-in")) return reader.take(to.settings.weft_break_one_in);
    if (reader.is("--warp-break-one-in")) return reader.take(to.settings.warp_break_one_in);
    if (reader.is("--operator-stop-one-in")) return reader.take(to.settings.operator_stop_one_in);
    if (reader.is("--emergency-stop-one-in")) return reader.take(to.settings.emergency_stop_one_in);
    for (const auto& [name, fault] : faults)
        if (reader.is(name)) return reader.take_fault(fault, to.settings);
    known = false;
    return false;
}

} // namespace

std::expected<Options, std::string> parse_options(int count, const char* const* words) {
    Options options;
    for (int i = 1; i < count; i += 2) {
        const std::string word = words[i];
        if (word == "--help") {
            options.help = true;
            return options;
        }
        const bool has_value = i + 1 < count;
        bool known = false;
        const bool right = read(Reader(word, has_value ? words[i + 1] : ""), options, known);
        if (!known) return std::unexpected("'" + word + "' is no option; --help lists them");
        if (!has_value) return std::unexpected("'" + word + "' wants a value; --help shows which");
        if (!right)
            return std::unexpected("'" + word + "' does not take '" + words[i + 1] +
                                   "'; --help shows what it takes");
    }
    options.settings.last_pick = options.picks_after_usr1 == 0 ? options.picks : 0;
    return options;
}

const char* usage() {
    return "carpet-loom-plant: the simulated carpet loom at the other end of the wires\n"
           "  --can NAME               CAN interface (can0)\n"
           "  --gpio-chip FOLDER       gpio-sim chip: sim_gpio<n>/pull and sim_gpio<n>/value lie in it "
           "(none)\n"
           "  --modbus-address A       numeric address the Modbus TCP server listens on (127.0.0.1)\n"
           "  --modbus-port N          its port; 0 = no Modbus (1502)\n"
           "  --seed N                 which loom (1)\n"
           "  --picks N                end when N picks are woven and the loom stands (at SIGTERM)\n"
           "  --picks-after-usr1 N     end not before USR1 came, and N picks later at least (nobody sends "
           "it)\n"
           "  --report FILE            where the JSON report goes (standard output)\n"
           "  --period T               polling of the lines, 50us..10ms (200us)\n"
           "  --fifo N                 run with SCHED_FIFO priority N (not)\n"
           "  --operator-reaction T    from standstill to the repair (1s)\n"
           "chances per pick, one in N: --weft-break-one-in --warp-break-one-in --operator-stop-one-in\n"
           "  --emergency-stop-one-in\n"
           "faults, WHEN[/DURATION], WHEN = picks (40) or time (20s, 500ms); without duration until "
           "repaired:\n"
           "  --weft-break-at --warp-break-at --oil-lost-at --oil-level-low-at --feeder-empty-at\n"
           "  --emergency-stop-at --operator-stop-at, and with :NODE --node-lost-at (1..6) --drive-fault-at "
           "(1..2)\n"
           "the wires themselves: --stop-modbus-at T/DURATION --bus-off-at T --edge-burst-at T --die-at T\n";
}

} // namespace tappet::loom
