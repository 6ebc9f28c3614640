// Makes the twins that a table asks for, and carries frames, levels and registers between them and the plant.
#include "drivers/plant/simulation.hpp"

#include "drivers/can/signal_map.hpp"

#include <algorithm>

namespace tappet {

namespace {

template <class All>
auto& named(All& all, std::string_view device) {
    const auto found = std::ranges::find_if(all, [device](const auto& each) { return each->name == device; });
    TAPPET_CONTRACT(found != all.end(), Contract::index_out_of_range, 0,
                    static_cast<std::int64_t>(all.size()));
    return **found;
}

} // namespace

std::expected<void, Sentence> SimulatedDevices::open(const AcceptedMachine& machine) {
    buses_.clear();
    chips_.clear();
    servers_.clear();
    ports_.clear();
    const std::span<const ProvidedDevice> own = plant_.devices();
    provided_.assign(own.begin(), own.end());
    provided_.insert(provided_.end(), lent_.begin(), lent_.end());
    std::vector<ProvidedDevice> far;
    for (const ComponentRow& row : machine.table.components) {
        if (std::ranges::any_of(lent_, [&](const auto& each) { return each.name == row.device; })) continue;
        if (drives(row, "can")) {
            if (auto added = add_bus(row); !added) return added;
            far.push_back(
                {type_id<can::Device>, row.device, static_cast<can::Device*>(&buses_.back()->plant)});
        } else if (drives(row, "gpio")) {
            if (auto added = add_chip(row); !added) return added;
            far.push_back(
                {type_id<gpio::Wires>, row.device, static_cast<gpio::Wires*>(&chips_.back()->twin)});
        } else if (drives(row, "udp")) {
            udp::Twin& twin = *ports_.emplace_back(std::make_unique<udp::Twin>());
            provided_.push_back({type_id<udp::Device>, row.device, static_cast<udp::Device*>(&twin)});
            far.push_back({type_id<udp::Wires>, row.device, static_cast<udp::Wires*>(&twin)});
        } else if (drives(row, "modbus")) {
            servers_.push_back(std::make_unique<Server>(row, AnswerWithin{300ms}.time));
            modbus::Twin& twin = servers_.back()->twin;
            provided_.push_back(
                {type_id<modbus::Transport>, row.device, static_cast<modbus::Transport*>(&twin)});
            far.push_back(
                {type_id<modbus::ServerTables>, row.device, static_cast<modbus::ServerTables*>(&twin)});
        }
    }
    if (Sentence fault = plant_.connect(far); !fault.empty()) return std::unexpected(fault);
    if (Sentence fault = open_logs(); !fault.empty()) return std::unexpected(fault);
    return {};
}

Sentence SimulatedDevices::open_logs() {
    for (const Replay& each : replays_) {
        const auto found = std::ranges::find(buses_, each.bus, [](const auto& bus) { return bus->name; });
        if (found == buses_.end()) {
            Sentence fault{"--replay-can: the machine has no CAN bus \"", each.bus, "\""};
            for (const auto& bus : buses_)
                fault.add(bus == buses_.front() ? "; it has: " : ", ").add(bus->name);
            return fault;
        }
        Bus& bus = **found;
        if (bus.replay) return Sentence{"--replay-can: \"", each.bus, "\" is given twice; leave one out"};
        bus.replay = std::make_unique<CanReplay>();
        if (Sentence fault = bus.replay->open(bus.name, each.file, each.begins_at, bus.settings.receive,
                                              bus.settings.transmit);
            !fault.empty())
            return fault;
        bus.bus.mute(bus.plant);
    }
    for (const auto& bus : buses_) {
        if (!recorded_in_.empty()) {
            bus->recorder = std::make_unique<CanRecorder>();
            if (Sentence fault = bus->recorder->open(bus->name, recorded_in_); !fault.empty()) return fault;
        }
        if (!bus->recorder && !bus->replay) continue;
        bus->tap = std::make_unique<can::TwinBus::Tap>();
        bus->bus.set_tap(bus->tap.get());
    }
    return {};
}

bool SimulatedDevices::is_done() const {
    if (replays_.empty()) return plant_.is_done();
    return std::ranges::all_of(buses_,
                               [](const auto& each) { return !each->replay || each->replay->is_over(); });
}

bool SimulatedDevices::close_logs(const std::function<void(const Sentence& what, bool good)>& tell) {
    bool all_good = true;
    const auto say = [&](const Sentence& what, bool good) {
        tell(what, good);
        all_good &= good;
    };
    for (const auto& bus : buses_) {
        if (bus->recorder) {
            bool good = false;
            const Sentence what = bus->recorder->close(good);
            say(what, good);
        }
        if (bus->replay) say(bus->replay->report(), true);
        if (bus->replay && !bus->replay->fault().empty()) say(bus->replay->fault(), false);
        if (bus->bus.frames_untapped() != 0)
            say(Sentence{"CAN bus \"", bus->name, "\": ", bus->bus.frames_untapped(),
                         " frames came faster than they could be recorded or compared"},
                false);
    }
    return all_good;
}

CanReplay::Counts SimulatedDevices::replayed(std::string_view bus) {
    const auto& replay = named(buses_, bus).replay;
    return replay ? replay->counts() : CanReplay::Counts{};
}

void SimulatedDevices::look_at_frames(Look look) {
    look_ = std::move(look);
    for (const auto& bus : buses_) {
        if (bus->tap) continue;
        bus->tap = std::make_unique<can::TwinBus::Tap>();
        bus->bus.set_tap(bus->tap.get());
    }
}

void SimulatedDevices::Bus::drain_tap(Time now, const Look& look) {
    if (!tap) return;
    if (recorder) recorder->begin(now);
    for (can::Frame frame; tap->pop(frame);) {
        if (look) look(name, frame);
        if (recorder) recorder->record(frame);
        if (replay) replay->heard(frame);
    }
}

std::expected<void, Sentence> SimulatedDevices::open_again() {
    for (const auto& bus : buses_)
        if (auto opened = bus->machine.open(bus->settings); !opened) return opened;
    return {};
}

void SimulatedDevices::write_safe_lines() noexcept {
    for (const auto& chip : chips_) static_cast<void>(chip->twin.make_safe());
}

void SimulatedDevices::send_safe_frames(Time now) noexcept {
    static_cast<void>(open_again());
    for (const auto& bus : buses_)
        for (can::Frame frame : bus->safe) {
            frame.stamp = now;
            static_cast<void>(bus->machine.send(frame, can::Keep::last));
        }
    for (const auto& bus : buses_) bus->machine.finish(now);
}

void SimulatedDevices::write_safe_registers() noexcept {
    for (const auto& server : servers_) {
        static_cast<void>(server->twin.connect());
        for (const modbus::SafeWrite& each : server->safe->requests)
            static_cast<void>(server->twin.write(each.run.table, static_cast<std::uint16_t>(each.run.address),
                                                 server->safe->words.subspan(each.first, each.run.count)));
        server->twin.disconnect();
    }
}

std::expected<void, Sentence> SimulatedDevices::add_bus(const ComponentRow& row) {
    Bus& bus = *buses_.emplace_back(std::make_unique<Bus>(row.device, seed_));
    bus.bus.set_bit_rates(bit_rates_);
    const auto& map = *static_cast<const can::Identifiers*>(row.type->device_map);
    bus.settings.interface = row.device;
    if (map.restarts_allowed != 0) bus.settings.restarts_allowed = map.restarts_allowed;
    bus.settings.receive = map.receive;
    bus.settings.transmit = map.transmit;
    bus.settings.takes_fd = map.has_fd;
    bus.safe = map.safe;
    if (auto opened = bus.machine.open(bus.settings); !opened) return opened;
    can::Settings settings = bus.settings;
    std::swap(settings.receive, settings.transmit);
    settings.restarts_allowed = ~0u; // nodes try again for ever
    if (auto opened = bus.plant.open(settings); !opened) return opened;
    if (!bus.bus.attach(bus.machine) || !bus.bus.attach(bus.plant))
        return std::unexpected(Sentence{"twin bus: no room for two ends"});
    provided_.push_back({type_id<can::Device>, row.device, static_cast<can::Device*>(&bus.machine)});
    return {};
}

std::expected<void, Sentence> SimulatedDevices::add_chip(const ComponentRow& row) {
    Chip& chip = *chips_.emplace_back(std::make_unique<Chip>(row.device, seed_));
    const auto& map = *static_cast<const std::span<const gpio::LineRow>*>(row.type->device_map);
    gpio::place(
        map, [next = 0u](std::string_view) mutable { return next++; }, chip.lines); // a twin has no board
    provided_.push_back({type_id<gpio::Device>, row.device, static_cast<gpio::Device*>(&chip.twin)});
    return chip.twin.open({row.device, std::span{chip.lines}.first(map.size())});
}

WireCounters SimulatedDevices::counters() const noexcept {
    WireCounters sum;
    for (const auto& bus : buses_) sum.add(bus->machine.counters());
    for (const auto& chip : chips_) sum.add(chip->twin.counters());
    return sum;
}

void SimulatedDevices::advance(Time now) {
    for (const auto& chip : chips_) chip->seen = chip->twin.outputs();
    for (const auto& bus : buses_) {
        bus->bus.deliver_until(now);
        bus->drain_tap(now, look_);
        if (can::faulted(bus->plant.state())) static_cast<void>(bus->plant.restart());
    }
    next_ = std::max(plant_.advance(now), now + 1ns); // a plant that wants the past would stop the time
    for (const auto& bus : buses_) {
        if (bus->replay) bus->replay->play(bus->bus, now);
        bus->bus.deliver_until(now);
        bus->drain_tap(now, look_);
    }
    next_ = std::min(next_, next_on_buses());
    for (const auto& chip : chips_) chip->twin.deliver_until(now);
    for (const auto& server : servers_) server->seen = server->twin.changes();
}

// What a twin puts off may be due: it comes with the plant's next move, whatever brings that about.
bool SimulatedDevices::are_driven() const noexcept {
    return std::ranges::any_of(
               buses_,
               [](const auto& each) { return !each->bus.is_silent() || each->plant.has_arrivals(); }) ||
           std::ranges::any_of(chips_,
                               [](const auto& each) {
                                   return !each->twin.is_still() || each->twin.outputs() != each->seen;
                               }) ||
           std::ranges::any_of(servers_, [](const auto& each) { return each->twin.changes() != each->seen; });
}

void SimulatedDevices::leap(Time until) {
    const bool still = std::ranges::all_of(buses_, [](const auto& each) { return each->bus.is_still(); }) &&
                       std::ranges::all_of(chips_, [](const auto& each) { return each->twin.is_still(); });
    if (!still) return;
    if (const auto next = plant_.leap_ahead(until)) next_ = std::min(*next, next_on_buses());
}

Time SimulatedDevices::next_on_buses() {
    Time next = never;
    for (const auto& bus : buses_) {
        next = std::min(next, bus->bus.next());
        if (bus->replay) next = std::min(next, bus->replay->next());
    }
    return next;
}

can::TwinBus& SimulatedDevices::bus(std::string_view device) { return named(buses_, device).bus; }
can::Twin& SimulatedDevices::controller(std::string_view device) { return named(buses_, device).machine; }
gpio::Twin& SimulatedDevices::lines(std::string_view device) { return named(chips_, device).twin; }
modbus::Twin& SimulatedDevices::server(std::string_view device) { return named(servers_, device).twin; }

} // namespace tappet
