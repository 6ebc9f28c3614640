// Carries frames, levels and registers between the machine's wires and the loom.
#include "apps/carpet_loom/plant.hpp"

#include <algorithm>
#include <string>

namespace tappet::carpet {

namespace {

using Io = gpio::FarEnd<io_lines>;
namespace line = loom::wires::line;

struct Output {
    Io::Output name;
    unsigned offset;
};
constexpr Output outputs[] = {{"weft_release", line::weft_release}, {"brake", line::brake},
                              {"lamp_run", line::lamp_run},         {"lamp_stop", line::lamp_stop},
                              {"lamp_fault", line::lamp_fault},     {"yarn_cutter", line::yarn_cutter}};
struct Input {
    Io::Input name;
    unsigned offset;
};
constexpr Input inputs[] = {
    {"emergency_stop", line::emergency_stop}, {"drop_wire", line::drop_wire},
    {"weft_detector", line::weft_detector},   {"button_start", line::button_start},
    {"button_stop", line::button_stop},       {"button_acknowledge", line::button_acknowledge}};

/// Holding registers of the unit that the machine neither reads nor writes. Its discrete input "oil level
/// low" is likewise unused.
struct Setting {
    std::uint16_t first, least, most;
};
constexpr std::size_t humidity_set_point = 0;     // 0.1 %
constexpr Setting settings[] = {{650, 300, 900},  // humidity_set_point
                                {120, 10, 3600}}; // lubrication interval, s

} // namespace

void Plant::begin() {
    if (settings_.picks_after_told != 0) loom().end_at(0); // weaves on until told
    modbus::ServerTables& tables = utility_.tables();
    tables.have(modbus::Table::discrete_inputs, 1);
    tables.have(modbus::Table::holding_registers, std::size(settings));
    for (std::size_t i = 0; i < std::size(settings); ++i)
        tables.set(modbus::Table::holding_registers, i, settings[i].first);
    tables.accept_only([](modbus::Table table, std::size_t address, std::uint16_t value) noexcept {
        return table != modbus::Table::holding_registers ||
               (address < std::size(settings) && value >= settings[address].least &&
                value <= settings[address].most);
    });
}

void Plant::told() {
    if (settings_.picks_after_told == 0) return;
    settings_.last_pick = std::max(settings_.last_pick, loom().picks() + settings_.picks_after_told);
    settings_.picks_after_told = 0;
    loom().end_at(settings_.last_pick);
}

Time Plant::move(Time now) {
    if (!origin_) {
        origin_ = now.time_since_epoch();
        begin();
    }
    const Time own = now - *origin_;
    take_wires(own);
    loom().advance(own);
    give_frames(now);
    give_lines(now);
    exchange_registers();
    return loom().next_event() + *origin_;
}

std::optional<Time> Plant::leap(Time until) {
    if (settings_.edge_burst_at != Duration::max()) return {}; // the burst leaves the wires, not the loom
    const Time next = loom().leap(until - *origin_);
    exchange_registers();
    return next + *origin_;
}

void Plant::take_wires(Time own) {
    for (const Output& each : outputs)
        if (io_.changed(each.name))
            loom().set_line(each.offset, io_.get(each.name), io_.changed_at() - *origin_);
    can::Frame frame;
    while (can_.receive(frame)) loom().receive(frame, own);
}

void Plant::give_frames(Time now) {
    // A full bus loses the frame, as with a real node; the final report counts it.
    const auto send = [this, now](can::Frame frame) {
        frame.stamp = now;
        static_cast<void>(can_.send(frame));
    };
    bool is_sampled = false;
    for (can::Frame frame; loom().transmit(frame);) {
        if (frame.id == loom::wires::cob::encoder_position)
            is_sampled = true; // when late, the present angle is sent once, not each past sample
        else
            send(frame);
    }
    if (is_sampled) send(loom().encoder_sample());
}

void Plant::give_lines(Time now) {
    loom::Edge edge;
    while (loom().next_edge(edge))
        for (const Input& each : inputs)
            if (each.offset == edge.line) io_.set(each.name, edge.level, edge.at + *origin_);
    if (now - *origin_ < Time{} + settings_.edge_burst_at) return;
    settings_.edge_burst_at = Duration::max();
    constexpr unsigned burst_edges = 400; // more than any event buffer holds
    for (unsigned i = 0; i < burst_edges; ++i) io_.set("weft_detector", i % 2 == 0, now);
}

void Plant::exchange_registers() {
    modbus::ServerTables& tables = utility_.tables();
    loom::Climate& climate = loom().climate();
    if (climate.steps() == exchanged_.steps && tables.changes() == exchanged_.changes) return;
    utility_.set("unit.temperature", climate.temperature_c());
    utility_.set("unit.humidity", climate.humidity_percent());
    utility_.set("unit.oil_pressure", climate.oil_bar());
    utility_.set("unit.oil_temperature", climate.oil_c());
    tables.set(modbus::Table::discrete_inputs, 0, climate.oil_level_low() ? 1 : 0);
    climate.want_humidity(0.1 * tables.get(modbus::Table::holding_registers, humidity_set_point));
    climate.set_pump(utility_.get("pump.on") != 0.0);
    exchanged_ = {climate.steps(), tables.changes()};
}

bool Plant::take_option(std::string_view option, std::string_view value, Sentence& fault) {
    bool known = false;
    if (!loom::read_option(option, value, settings_, known) && known)
        fault = Sentence{"\"", value, "\" is not a valid value of this option; see --help"};
    return known;
}

Sentence Plant::fault() const {
    if (settings_.last_pick == 0 || is_done()) return {};
    return Sentence{"the picks were not woven in time"};
}

} // namespace tappet::carpet
