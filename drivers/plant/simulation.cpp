// Makes the twins that a table needs, and transfers frames, levels and registers between them and the plant.
#include "drivers/plant/simulation.hpp"

#include <algorithm>

namespace tappet {

namespace {

/// Visits each device of every kind.
template <class Kinds, class Visit>
void for_each(Kinds& kinds, const Visit& visit) {
    std::apply([&](auto&... list) { (std::ranges::for_each(list, [&](auto& each) { visit(*each); }), ...); },
               kinds);
}
template <class Kinds, class Asked>
bool any_of(const Kinds& kinds, const Asked& asked) {
    bool found = false;
    for_each(kinds, [&](const auto& each) { found = found || asked(each); });
    return found;
}

} // namespace

template <class Kind>
Kind& SimulatedDevices::named(std::string_view device) {
    auto& all = std::get<std::vector<std::unique_ptr<Kind>>>(kinds_);
    const auto found = std::ranges::find_if(all, [device](const auto& each) { return each->name == device; });
    TAPPET_CONTRACT(found != all.end(), Contract::index_out_of_range, 0,
                    static_cast<std::int64_t>(all.size()));
    return **found;
}

template <class Kind>
std::expected<void, Sentence> SimulatedDevices::add(const ComponentRow& row,
                                                    std::vector<ProvidedDevice>& plants_ends) {
    if (!drives(row, Kind::kind.name)) return {};
    auto& all = std::get<std::vector<std::unique_ptr<Kind>>>(kinds_);
    Kind& device = *all.emplace_back(std::make_unique<Kind>(row.device, seed_));
    provided_.push_back(device.machine_end());
    plants_ends.push_back(device.plant_end());
    return device.open(row.type->device_map);
}

std::expected<void, Sentence> SimulatedDevices::open(const AcceptedMachine& machine) {
    logs_.clear();
    kinds_ = {};
    const std::span<const ProvidedDevice> own = plant_.devices();
    provided_.assign(own.begin(), own.end());
    provided_.insert(provided_.end(), lent_.begin(), lent_.end());
    std::vector<ProvidedDevice> plants_ends;
    for (const ComponentRow& row : machine.table.components) {
        if (std::ranges::any_of(lent_, [&](const auto& each) { return each.name == row.device; })) continue;
        std::expected<void, Sentence> added{};
        [&]<class... Kind>(const std::tuple<std::vector<std::unique_ptr<Kind>>...>&) {
            static_cast<void>(((added = add<Kind>(row, plants_ends)) && ...));
        }(kinds_);
        if (!added) return added;
        if (row.type->device_map != nullptr &&
            std::ranges::none_of(provided_, [&](const auto& each) { return each.name == row.device; }))
            return std::unexpected(unknown_kind(row, "drivers/plant/simulated_kinds.hpp"));
    }
    for (const auto& bus : buses()) {
        bus->wire.set_bit_rates(bit_rates_);
        logs_.emplace_back(*bus);
    }
    if (Sentence fault = plant_.connect(plants_ends); !fault.empty()) return std::unexpected(fault);
    if (Sentence fault = open_logs(); !fault.empty()) return std::unexpected(fault);
    return {};
}

Sentence SimulatedDevices::open_logs() {
    for (const Replay& each : replays_) {
        const auto found =
            std::ranges::find(logs_, each.bus, [](const Log& log) { return std::string_view{log.bus.name}; });
        if (found == logs_.end()) {
            Sentence fault{"--replay-can: the machine has no CAN bus \"", each.bus, "\""};
            for (std::size_t i = 0; i < logs_.size(); ++i)
                fault.add(i == 0 ? "; it has: " : ", ").add(logs_[i].bus.name);
            return fault;
        }
        if (found->replay) return Sentence{"--replay-can: \"", each.bus, "\" is given twice; leave one out"};
        found->replay = std::make_unique<CanReplay>();
        const can::Settings& settings = found->bus.settings;
        if (Sentence fault = found->replay->open(found->bus.name, each.file, each.begins_at, settings.receive,
                                                 settings.transmit);
            !fault.empty())
            return fault;
        found->bus.wire.mute(found->bus.plant);
    }
    for (Log& log : logs_) {
        if (!recorded_in_.empty()) {
            log.recorder = std::make_unique<CanRecorder>();
            if (Sentence fault = log.recorder->open(log.bus.name, recorded_in_); !fault.empty()) return fault;
        }
        if (log.recorder || log.replay) log.begin();
    }
    return {};
}

bool SimulatedDevices::is_done() const {
    if (replays_.empty()) return plant_.is_done();
    return std::ranges::all_of(logs_, [](const Log& log) { return !log.replay || log.replay->is_over(); });
}

bool SimulatedDevices::close_logs(const std::function<void(const Sentence& what, bool good)>& tell) {
    bool all_good = true;
    const auto say = [&](const Sentence& what, bool good) {
        tell(what, good);
        all_good &= good;
    };
    for (const Log& log : logs_) {
        if (log.recorder) {
            bool good = false;
            const Sentence what = log.recorder->close(good);
            say(what, good);
        }
        if (log.replay) say(log.replay->report(), true);
        if (log.replay && !log.replay->fault().empty()) say(log.replay->fault(), false);
        if (log.bus.wire.frames_untapped() != 0)
            say(Sentence{"CAN bus \"", log.bus.name, "\": ", log.bus.wire.frames_untapped(),
                         " frames came faster than they could be recorded or compared"},
                false);
    }
    return all_good;
}

CanReplay::Counts SimulatedDevices::replayed(std::string_view bus) {
    for (const Log& log : logs_)
        if (log.bus.name == bus && log.replay) return log.replay->counts();
    return {};
}

void SimulatedDevices::look_at_frames(Look look) {
    look_ = std::move(look);
    for (Log& log : logs_) log.begin();
}

void SimulatedDevices::Log::begin() {
    if (tap) return;
    tap = std::make_unique<can::TwinBus::Tap>();
    bus.wire.set_tap(tap.get());
}

void SimulatedDevices::Log::drain(Time now, const Look& look) {
    if (!tap) return;
    if (recorder) recorder->begin(now);
    for (can::Frame frame; tap->pop(frame);) {
        if (look) {
            bus.sent.hear(frame);
            look(bus.name, frame);
        }
        if (recorder) recorder->record(frame);
        if (replay) replay->heard(frame);
    }
}

std::expected<void, Sentence> SimulatedDevices::open_again() {
    std::expected<void, Sentence> opened{};
    for_each(kinds_, [&](auto& each) {
        if (opened) opened = each.open_again();
    });
    return opened;
}

void SimulatedDevices::write_safe_lines() noexcept {
    for_each(kinds_, [](auto& each) { each.write_safe_lines(); });
}

void SimulatedDevices::send_safe_frames(Time now) noexcept {
    for_each(kinds_, [now](auto& each) { each.send_safe_frames(now); });
}

void SimulatedDevices::write_safe_registers() noexcept {
    for_each(kinds_, [](auto& each) { each.write_safe_registers(); });
}

WireCounters SimulatedDevices::counters() const noexcept {
    WireCounters sum;
    for_each(kinds_, [&](const auto& each) { each.count(sum); });
    return sum;
}

void SimulatedDevices::advance(Time now) {
    for_each(kinds_, [now](auto& each) { each.bring_to_plant(now); });
    for (Log& log : logs_) log.drain(now, look_);
    next_ = std::max(plant_.advance(now), now + 1ns); // a plant that returns a past time would stop the clock
    for (Log& log : logs_)
        if (log.replay) log.replay->play(log.bus.wire, now);
    for_each(kinds_, [now](auto& each) { each.bring_to_machine(now); });
    for (Log& log : logs_) log.drain(now, look_);
    next_ = std::min(next_, next_on_wires());
}

// An event that a twin holds back may be due: it is delivered with the plant's next move().
bool SimulatedDevices::are_driven() const noexcept {
    return any_of(kinds_, [](const auto& each) { return each.is_driven(); });
}

void SimulatedDevices::leap(Time until) {
    if (any_of(kinds_, [](const auto& each) { return !each.is_still(); })) return;
    if (const auto next = plant_.leap_ahead(until)) next_ = std::min(*next, next_on_wires());
}

Time SimulatedDevices::next_on_wires() {
    Time next = never;
    for_each(kinds_, [&](auto& each) { next = std::min(next, each.next()); });
    for (const Log& log : logs_)
        if (log.replay) next = std::min(next, log.replay->next());
    return next;
}

bool SimulatedDevices::is_judged(const ComponentRow& driver) noexcept {
    return []<class... Kind>(const ComponentRow& row, std::type_identity<Lists<Kind...>>) {
        return ((Kind::is_judged && drives(row, Kind::kind.name)) || ...);
    }(driver, std::type_identity<decltype(kinds_)>{});
}

std::vector<WireOutput> SimulatedDevices::outputs(std::string_view device) const {
    std::vector<WireOutput> all;
    for_each(kinds_, [&](const auto& each) {
        if constexpr (std::remove_cvref_t<decltype(each)>::is_judged)
            if (each.name == device) all = each.outputs();
    });
    return all;
}

TwinFault SimulatedDevices::strike(std::string_view device, Random& random, Time now, bool with_any_values) {
    TwinFault struck;
    for_each(kinds_, [&](auto& each) {
        if constexpr (std::remove_cvref_t<decltype(each)>::is_judged)
            if (each.name == device) struck = each.strike(random, now, with_any_values);
    });
    return struck;
}

Sentence SimulatedDevices::broken() const {
    Sentence why;
    for_each(kinds_, [&](const auto& each) {
        if (why.empty()) why = each.broken();
    });
    return why;
}

bool SimulatedDevices::is_off(std::string_view device) const noexcept {
    return any_of(kinds_, [device](const auto& each) { return each.name == device && each.is_off(); });
}

void SimulatedDevices::repair_all() {
    for_each(kinds_, [](auto& each) { each.repair(); });
}

can::TwinBus& SimulatedDevices::bus(std::string_view device) { return named<can::SimulatedBus>(device).wire; }
can::Twin& SimulatedDevices::controller(std::string_view device) {
    return named<can::SimulatedBus>(device).machine;
}
gpio::Twin& SimulatedDevices::lines(std::string_view device) {
    return named<gpio::SimulatedChip>(device).twin;
}
modbus::Twin& SimulatedDevices::server(std::string_view device) {
    return named<modbus::SimulatedServer>(device).twin;
}

} // namespace tappet
