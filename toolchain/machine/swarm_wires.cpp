// The outputs of a machine, found in its table and its maps, and the rules that hold for all of them.
#include "toolchain/machine/swarm_wires.hpp"

#include "drivers/gpio/line_map.hpp"
#include "drivers/modbus/register_map.hpp"
#include "drivers/modbus/session.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tappet {

namespace {

constexpr Duration usual_settling = 200ms; // periods, deadlines and queues on the way to a wire

/// Returns whether a signal is in its frame: the selecting signal must have one of its values.
bool is_in(const can::Identifiers& map, const can::FrameRow& row, const can::Signal& signal,
           const can::Frame& frame) {
    if (signal.multiplexor.empty()) return true;
    for (const can::Signal& each : map.signals.subspan(row.first, row.values))
        if (each.name == signal.multiplexor)
            return is_in(map, row, each, frame) && signal.is_selected_by(can::extract(frame.data, each));
    return false;
}

} // namespace

SwarmWires::SwarmWires(const AcceptedMachine& machine, SimulatedDevices& devices, const Struck& struck,
                       const AllLeftBehind* left)
    : machine_{machine}, devices_{devices}, struck_{struck}, left_{left} {}

void SwarmWires::listen() {
    const auto rows = machine_.table.components;
    for (std::size_t c = 0; c < rows.size(); ++c) {
        if (tappet::drives(rows[c], "gpio")) add_lines(c);
        if (tappet::drives(rows[c], "can")) add_signals(c);
        if (tappet::drives(rows[c], "modbus")) add_registers(c);
    }
    add_axes();
    find_together();
    devices_.look_at_frames(
        [this](std::string_view device, const can::Frame& frame) { hear(device, frame); });
}

void SwarmWires::begin(MachineInstance& instance) {
    instance_ = &instance;
    for (Axis& each : axes_) {
        each.rests_at = {};
        each.rests_since = each.astray_since = never;
        if (each.stands_below < 0.0)
            each.stands_below = *static_cast<const double*>(instance.facet(each.standing));
    }
    for (Output& each : outputs_) {
        each.before = each.left = {};
        each.since = each.wanted_since = never;
        each.told_looked = {};
        each.wanted = std::numeric_limits<double>::quiet_NaN();
        each.excused = {};
    }
}

void SwarmWires::excuse(std::size_t driver, Time until) {
    for (Output& each : outputs_)
        if (each.driver == driver) {
            each.excused = std::max(each.excused, until);
            each.is_meddled = true;
        }
}

void SwarmWires::add_lines(std::size_t c) {
    const ComponentRow& row = machine_.table.components[c];
    const auto& map = *static_cast<const std::span<const gpio::LineRow>*>(row.type->device_map);
    gpio::Twin& chip = devices_.lines(row.device);
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (map[i].line.role != gpio::Role::output) continue;
        const std::string name{map[i].line.name};
        Output output{.driver = c, .safe = map[i].line.safe_value, .is_switch = true, .is_line = true};
        output.read = [&chip, i] { return std::optional<std::uint64_t>{chip.outputs() >> i & 1}; };
        if (map[i].driven == gpio::Driven::by_port)
            add(std::move(output), name);
        else
            add(std::move(output), name, {name + ".set", name + ".clear"});
    }
}

void SwarmWires::add_signals(std::size_t c) {
    const ComponentRow& row = machine_.table.components[c];
    const auto& map = *static_cast<const can::Identifiers*>(row.type->device_map);
    for (std::size_t f = 0; f < map.frames.size(); ++f) {
        const can::FrameRow& frame = map.frames[f];
        if (frame.direction != can::Direction::transmit) continue;
        sent_.push_back({row.device, &map, f});
        for (const can::Signal& signal : map.signals.subspan(frame.first, frame.values)) {
            Output output{.driver = c, .is_switch = signal.bits == 1, .settles = frame.every, .goes_in = f};
            // A multiplexed frame, or one that selects others, goes out in turns.
            if (frame.every > Duration{} && !signal.is_bits && !frame.multiplexed) {
                output.numbers = numbers_of(signal);
                output.physical = [&signal](std::uint64_t raw) { return can::to_physical(signal, raw); };
            }
            if (signal.says_safe) output.safe = can::to_raw(signal, signal.safe_value).bits;
            output.read = [this, at = sent_.size() - 1, &signal]() -> std::optional<std::uint64_t> {
                const Sent& sent = sent_[at];
                const bool is_cyclic = sent.map->frames[sent.row].every > Duration{};
                if (!sent.last || !is_in(*sent.map, sent.map->frames[sent.row], signal, *sent.last))
                    return {};
                // A silent wire is the receiver's to detect.
                if (is_cyclic && now_ - sent.last->stamp > usual_settling) return {};
                return can::extract(sent.last->data, signal);
            };
            add(std::move(output), std::string{frame.name} + "." + std::string{signal.name});
        }
    }
}

void SwarmWires::add_registers(std::size_t c) {
    const ComponentRow& row = machine_.table.components[c];
    const auto& map = *static_cast<const modbus::SafeWrites*>(row.type->device_map);
    modbus::Twin& server = devices_.server(row.device);
    for (const modbus::Row& request : map.rows) {
        if (!request.write) continue;
        for (const modbus::Register& one : map.registers.subspan(request.first, request.values)) {
            const auto whole = [width = one.width()](auto word) {
                std::uint64_t all = 0;
                for (unsigned w = 0; w < width; ++w) all = all << 16 | word(w);
                return all;
            };
            Output output{.driver = c,
                          .is_switch = one.kind == modbus::Kind::bit,
                          .settles = request.every,
                          .recovers = modbus::Backoff{}.most,
                          .goes_in = request.first,
                          .numbers = numbers_of(one)};
            output.physical = [&one](std::uint64_t all) {
                modbus::Words words{static_cast<std::uint16_t>(all), 0};
                if (one.width() == 2)
                    words = {static_cast<std::uint16_t>(all >> 16), static_cast<std::uint16_t>(all)};
                return modbus::to_physical(one, words);
            };
            if (one.says_safe)
                output.safe = whole(
                    [words = modbus::to_words(one, one.safe_value)](unsigned w) { return words.words[w]; });
            output.read = [whole, &server, table = request.run.table, at = request.run.address + one.at] {
                return std::optional<std::uint64_t>{
                    whole([&](unsigned w) { return server.get(table, at + w); })};
            };
            add(std::move(output), std::string{request.name} + "." + std::string{one.name});
        }
    }
}

/// Adds an output with all components that write to its facets, by any row of the table.
void SwarmWires::add(Output output, std::string_view name, const std::vector<std::string>& events) {
    const MachineView& table = machine_.table;
    const std::string driver{table.components[output.driver].name};
    const auto facets = table.components[output.driver].type->facets;
    const auto switches = [&](std::string_view facet) {
        return events.empty() ? facet == name : std::ranges::find(events, facet) != events.end();
    };
    output.name = driver + "." + std::string{name};
    for (std::size_t f = 0; f < facets.size(); ++f)
        if (switches(facets[f].name)) output.facets.push_back({output.driver, f});
    const auto is_meant = [&](End end) {
        return std::ranges::find(output.facets, end) != output.facets.end();
    };
    const auto write = [&](std::size_t component) {
        if (component != output.driver &&
            std::ranges::find(output.writers, component) == output.writers.end())
            output.writers.push_back(component);
    };
    Duration oldest{};
    for (std::size_t x = 0; x < table.connections.size(); ++x) {
        const Link& link = machine_.index.connections[x];
        if (!is_meant(link.to)) continue;
        write(link.from.component);
        oldest = std::max(oldest, table.connections[x].max_age);
    }
    for (std::size_t r = 0; r < table.reactions.size(); ++r)
        if (is_meant(machine_.index.reactions[r].to)) write(machine_.index.reactions[r].from.component);
    for (const BehaviourRow& row : table.behaviours)
        for (const std::string_view operation : row.slot.operations)
            if (operation.starts_with(driver + ".") && switches(operation.substr(driver.size() + 1)))
                write(find_component(table, row.component));
    output.settles += usual_settling + oldest;
    output.grows_stale = oldest > Duration{};
    outputs_.push_back(std::move(output));
}

/// Judges the frames that the machine sends: numbers, within the range of the map.
void SwarmWires::hear(std::string_view device, const can::Frame& frame) {
    for (Axis& axis : axes_) hear_axis(axis, device, frame);
    for (std::size_t at = 0; at < sent_.size(); ++at) {
        Sent& sent = sent_[at];
        const can::FrameRow& row = sent.map->frames[sent.row];
        if (sent.device != device || row.identifier != can::Identifier{frame.id, frame.extended}) continue;
        sent.last = frame;
        for (const can::Signal& signal : sent.map->signals.subspan(row.first, row.values)) {
            if (!is_in(*sent.map, row, signal, frame)) continue;
            const std::uint64_t raw = can::extract(frame.data, signal);
            const double value = can::to_physical(signal, raw);
            const double rounding = std::abs(signal.factor);
            const bool named = can::is_integer(signal) && signal.has_name(can::to_integer(signal, raw));
            const bool is_safe = signal.says_safe && raw == can::to_raw(signal, signal.safe_value).bits;
            if (!std::isfinite(value))
                heard_ = Sentence{
                    "\"", device, "\": ", row.name, ".", signal.name, " is sent and is not a number"};
            else if (signal.has_range && !named && !is_safe &&
                     (value < signal.least - rounding || value > signal.most + rounding))
                heard_ = Sentence{"\"",
                                  device,
                                  "\": ",
                                  row.name,
                                  ".",
                                  signal.name,
                                  " is sent as ",
                                  std::int64_t{std::llround(value)},
                                  ", outside its range"};
        }
    }
}

bool SwarmWires::drives(const Output& output) const {
    return std::ranges::any_of(output.writers, [this](std::size_t c) {
        const ComponentState state = instance_->life().state_of(c);
        return state == ComponentState::running || state == ComponentState::starting ||
               state == ComponentState::stopping;
    });
}

bool SwarmWires::is_forced(const Output& output) const {
    return std::ranges::any_of(output.facets, [this](End end) {
        const Facet& facet = facet_at(machine_.table, end);
        return facet.kind == FacetKind::input && facet.port != nullptr &&
               *facet.port->places(instance_->place_of(end), true).forced;
    });
}

Sentence SwarmWires::told(const Output& output, std::uint64_t value) const {
    Sentence text{"output \"", output.name, "\" is ", value, " at the wire"};
    if (output.safe) text.add(" (safe: ").add(*output.safe).add(")");
    return text;
}

/// A stopped component leaves what its stop() wrote, or the safe value, and moves no output any more.
Sentence SwarmWires::broken(Output& output, Time now) const {
    if (output.writers.empty()) return {};
    const auto value = output.read();
    if (Sentence why = told_otherwise(output, value, now); !why.empty()) return why;
    if (!value) return {};
    if (now >= output.excused && output.safe && *value == *output.safe) output.is_meddled = false;
    if (drives(output)) {
        output.before = value;
        output.left = {};
        output.since = never;
        return {};
    }
    if (output.since == never) output.since = now;
    if (is_forced(output)) output.excused = std::max(output.excused, now + output.settles);
    const bool is_driven = instance_->life().state_of(output.driver) == ComponentState::running;
    if (now < output.excused || !is_driven ||
        struck_.whole_for(output.driver, now) < output.settles + output.recovers) {
        output.before = output.left = {};
        output.since = now;
        return {};
    }
    if (now - output.since < output.settles) return {};
    if (output.is_meddled && !output.left) output.left = value; // as a direct request to the driver left it
    const bool is_safe = output.safe && *value == *output.safe;
    if (!output.left) {
        output.left = value;
        const auto known = left_ == nullptr ? AllLeftBehind::const_iterator{} : left_->find(output.name);
        if (left_ != nullptr && known != left_->end() && !known->second.holds) {
            if (!is_safe && std::ranges::find(known->second.values, *value) == known->second.values.end())
                return told(output, *value)
                    .add(", though no component that drives it runs; its stop leaves another value");
        } else if (!is_safe && output.is_switch && output.before && *output.before != *value) {
            return told(output, *value)
                .add(", though no component that drives it runs: a stopped component switched it");
        }
    } else if (*output.left != *value) {
        if (!is_safe)
            return told(output, *value)
                .add(", though no component that drives it runs: it was ")
                .add(*output.left)
                .add(" when the last of them stopped");
        output.left = value;
    }
    return {};
}

Sentence SwarmWires::broken(Time now) {
    if (!heard_.empty()) return heard_;
    if (instance_ == nullptr) return {};
    now_ = now;
    for (Output& each : outputs_)
        if (Sentence why = broken(each, now); !why.empty()) {
            why.add(" (");
            for (const std::size_t c : each.writers)
                why.add(c == each.writers.front() ? "" : ", ").add(machine_.table.components[c].name);
            return why.add(")");
        }
    return {};
}

Sentence SwarmWires::broken_at_rest(bool by_guardian) const {
    for (const Output& each : outputs_) {
        // The receiver detects by itself when its device could not be reached.
        if (!each.safe || struck_.whole_for(each.driver, never) < Duration{}) continue;
        if (const auto value = each.read(); value && *value != *each.safe)
            return told(each, *value)
                .add(by_guardian ? ", though its guardian made it safe"
                                 : ", though the machine has stopped and reports every device as reached");
    }
    return {};
}

std::vector<std::vector<std::size_t>> SwarmWires::all_writers() const {
    std::vector<std::vector<std::size_t>> all;
    for (const Output& each : outputs_)
        if (!each.writers.empty() && std::ranges::find(all, each.writers) == all.end())
            all.push_back(each.writers);
    return all;
}

Duration SwarmWires::settles(const std::vector<std::size_t>& writers) const {
    Duration longest{};
    for (const Output& each : outputs_)
        if (each.writers == writers) longest = std::max(longest, each.settles);
    return longest;
}

void SwarmWires::note_left(const std::vector<std::size_t>& writers, AllLeftBehind& left) const {
    for (const Output& each : outputs_) {
        const auto value = each.read();
        if (each.writers != writers || !value || drives(each) || !each.left) continue;
        LeftBehind& known = left[each.name];
        if (each.safe && *value == *each.safe) continue;
        known.holds |= !each.safe || (each.before && *each.before == *value);
        known.values.push_back(*value);
    }
}

} // namespace tappet
