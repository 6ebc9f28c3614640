// The faults of a machine of the swarm, from without and within: its devices, its components, its activities.
#include "drivers/can/signal_map.hpp"
#include "drivers/gpio/line_map.hpp"
#include "drivers/modbus/register_map.hpp"
#include "toolchain/machine/swarm.hpp"

#include <algorithm>

namespace tappet {

namespace {

constexpr Duration longest_fault = 5s; // of faults that end by themselves

} // namespace

void SwarmRun::strike() {
    const Duration lasts{std::min<std::int64_t>(
        random_.between(1, std::int64_t{1} << random_.between(17, 33)), longest_fault.count())};
    if (anything_goes_ && service_ != nowhere && (only_people_ || random_.one_in(3)))
        return strike_people(lasts);
    const std::uint64_t what = random_.below(100);
    if (what < 16) {
        if (const Sentence trouble = rules_->trouble(random_, lasts); !trouble.empty()) {
            ++verdict_.faults["plant"];
            say(trouble.view());
        }
    } else if (what < 38 && !drivers_.empty()) {
        const std::size_t c = drivers_[random_.below(drivers_.size())];
        const ComponentRow& row = of_.machine.table.components[c];
        if (drives(row, "can")) strike_bus(c, lasts);
        if (drives(row, "gpio")) strike_chip(c, lasts);
        if (drives(row, "modbus")) strike_server(c, lasts);
    } else if (what < 50) {
        strike_component(lasts);
    } else if (what < 74) {
        strike_activity(lasts);
    } else if (what < 97 && service_ != nowhere) {
        strike_people(lasts);
    } else {
        restart(random_.one_in(2));
    }
}

std::vector<std::size_t> SwarmRun::components_on(std::string_view device) const {
    std::vector<std::size_t> found;
    for (const std::size_t c : drivers_)
        if (of_.machine.table.components[c].device == device) found.push_back(c);
    return found;
}

std::vector<std::size_t> SwarmRun::components_of(std::size_t activity) const {
    std::vector<std::size_t> found;
    for (std::size_t c = 0; c < of_.machine.index.activity.size(); ++c)
        if (of_.machine.index.activity[c] == activity) found.push_back(c);
    return found;
}

void SwarmRun::strike_bus(std::size_t c, Duration lasts) {
    const ComponentRow& row = of_.machine.table.components[c];
    can::TwinBus& bus = run_.devices().bus(row.device);
    const auto& map = *static_cast<const can::Identifiers*>(row.type->device_map);
    if (anything_goes_ && random_.one_in(3)) return garble_bus(row.device, map);
    Sentence text{"bus \"", row.device, "\" "};
    const std::uint64_t what = random_.below(7);
    if (what == 4) {
        bus.set_acknowledged(false);
        return begin("bus unacknowledged", text.add("acknowledges nothing"), lasts, components_on(row.device),
                     [&bus] { return bus.set_acknowledged(true), true; });
    }
    if (what == 5) {
        bus.bus_off(run_.devices().controller(row.device));
        return begin(
            "bus off", text.add("goes off"), lasts, components_on(row.device),
            [this, device = row.device] { return !can::faulted(run_.devices().controller(device).state()); });
    }
    const auto often = static_cast<std::uint32_t>(random_.between(1, 100));
    if (what == 6) {
        bus.overflow(run_.devices().controller(row.device), often);
        return begin("bus overflow", text.add("overflows by ").add(often), lasts, components_on(row.device),
                     [] { return true; });
    }
    constexpr std::array<std::string_view, 4> names{"bus loses", "bus doubles", "bus corrupts", "bus delays"};
    const std::array<can::Chance*, 4> chances{&bus.faults.lose, &bus.faults.duplicate,
                                              &bus.faults.corrupt_length, &bus.faults.delay};
    can::Chance* const chance = chances[what];
    chance->one_in = often;
    bus.faults.only = {};
    text.add(names[what].substr(4)).add(" one frame in ").add(often);
    if (chance == &bus.faults.delay) bus.faults.delay_by = Duration{random_.between(10'000, 20'000'000)};
    const std::size_t all = map.receive.size() + map.transmit.size();
    if (const std::size_t one = random_.below(2 * all); one < all) {
        bus.faults.only =
            one < map.receive.size() ? map.receive[one] : map.transmit[one - map.receive.size()];
        text.add(" of identifier ").add(bus.faults.only->id);
    }
    begin(names[what], text, lasts, components_on(row.device), [chance] { return chance->one_in = 0, true; });
}

/// Sends the machine values that no node would send: not-a-number, ends of ranges, anything.
void SwarmRun::garble_bus(std::string_view device, const can::Identifiers& map) {
    const auto is_received = [](const can::FrameRow& row) {
        return row.direction == can::Direction::receive;
    };
    std::vector<const can::FrameRow*> rows;
    for (const can::FrameRow& row : map.frames)
        if (is_received(row)) rows.push_back(&row);
    if (rows.empty()) return;
    const can::FrameRow& row = *rows[random_.below(rows.size())];
    can::Frame frame;
    frame.id = row.identifier.id;
    frame.extended = row.identifier.extended;
    frame.length = row.length;
    can::set_format(frame, row.format);
    const std::uint64_t how = random_.below(4);
    constexpr std::array<unsigned, 3> patterns{0xFF, 0x00, 0x7F};
    for (std::size_t i = 0; i < row.length; ++i)
        frame.data[i] = static_cast<std::uint8_t>(how < 3 ? patterns[how] : random_.below(256));
    ++verdict_.faults["bus says anything"];
    wires_.excuse_axes(run_.now() + 50ms); // an axis that starts takes its position from the wire
    say(Sentence{"bus \"", device, "\" says ",
                 how == 3   ? "anything"
                 : how == 0 ? "ones"
                 : how == 1 ? "zeros"
                            : "0x7F",
                 " in ", row.name}
            .view());
    for (std::int64_t n = random_.between(1, 3); n > 0; --n)
        run_.devices().bus(device).put(frame, run_.now());
}

/// Garbles the registers that the machine reads, until the plant writes them again.
void SwarmRun::garble_server(std::string_view device, modbus::Twin& server, const modbus::SafeWrites& map) {
    ++verdict_.faults["server says anything"];
    for (const modbus::Row& row : map.rows) {
        if (row.write) continue;
        const bool is_bit = modbus::holds_bits(row.run.table);
        const std::uint16_t word = static_cast<std::uint16_t>(is_bit              ? random_.below(2)
                                                              : random_.one_in(2) ? 0x7FFF + random_.below(3)
                                                                                  : random_.below(65536));
        for (std::size_t i = 0; i < row.run.count; ++i) server.set(row.run.table, row.run.address + i, word);
        say(Sentence{"server \"", device, "\" says ", std::uint64_t{word}, " in ", row.name}.view());
    }
}

void SwarmRun::strike_chip(std::size_t c, Duration lasts) {
    const ComponentRow& row = of_.machine.table.components[c];
    gpio::Twin& chip = run_.devices().lines(row.device);
    const auto& map = *static_cast<const std::span<const gpio::LineRow>*>(row.type->device_map);
    Sentence text{"lines \"", row.device, "\": "};
    const std::uint64_t what = random_.below(7);
    std::vector<std::size_t> inputs;
    for (std::size_t i = 0; i < map.size(); ++i)
        if (map[i].line.role == gpio::Role::input) inputs.push_back(i);
    if (what == 0 || inputs.empty()) {
        chip.set_removed(true);
        return begin("chip removed", text.add("the chip is gone"), lasts, components_on(row.device),
                     [&chip] { return chip.set_removed(false), true; });
    }
    if (what == 1) {
        const auto calls = static_cast<std::uint32_t>(random_.between(1, 3));
        chip.refuse(calls);
        return begin("chip refuses", text.add("the chip refuses ").add(calls).add(" calls"), lasts,
                     components_on(row.device), [&chip] { return chip.refuse(0), true; });
    }
    const std::size_t line = inputs[random_.below(inputs.size())];
    gpio::LineFaults& faults = chip.faults(line);
    const auto many = static_cast<std::uint32_t>(random_.between(1, 4));
    text.add("\"").add(map[line].line.name).add("\" ");
    const auto heal = [&faults] { return faults = {}, true; };
    switch (what) {
    case 2:
        faults.lose_next = many;
        return begin("line loses edges", text.add("loses ").add(many).add(" edges"), lasts, {}, heal);
    case 3:
        faults.lose_one_in = many;
        return begin("line loses edges", text.add("loses one edge in ").add(many), lasts, {}, heal);
    case 4:
        faults.bounces = many;
        return begin("line bounces", text.add("bounces ").add(many).add(" times"), lasts, {}, heal);
    case 5:
        faults.delay = Duration{random_.between(1'000, 10'000'000)};
        return begin("line is late", text.add("is ").add(faults.delay / 1us).add(" us late"), lasts, {},
                     heal);
    default: {
        const bool level = random_.one_in(2);
        chip.stick(line, level, run_.now());
        return begin("line sticks", text.add(level ? "sticks active" : "sticks inactive"), lasts, {},
                     [this, &chip, line] { return chip.release(line, run_.now()), true; });
    }
    }
}

void SwarmRun::strike_server(std::size_t c, Duration lasts) {
    const ComponentRow& row = of_.machine.table.components[c];
    modbus::Twin& server = run_.devices().server(row.device);
    if (anything_goes_ && random_.one_in(3))
        return garble_server(row.device, server,
                             *static_cast<const modbus::SafeWrites*>(row.type->device_map));
    constexpr std::array<std::string_view, 6> names{
        "is silent", "is slow", "answers exceptions", "answers wrong ones", "answers garbage", "is down"};
    const std::size_t what = random_.below(names.size());
    const auto requests = static_cast<std::uint32_t>(random_.between(1, 20));
    server.set_slow_by(Duration{random_.between(1'000'000, 1'000'000'000)});
    server.inject(static_cast<modbus::Fault>(what + 1), requests);
    begin("server faults", Sentence{"server \"", row.device, "\" ", names[what], " ", requests, " times"},
          lasts, components_on(row.device), [&server] { return server.inject(modbus::Fault::none), true; });
}

void SwarmRun::strike_component(Duration lasts) {
    const std::size_t c = random_.below(of_.machine.table.components.size());
    const Sentence text{"component \"", of_.machine.table.components[c].name, "\" "};
    const bool restarts = random_.one_in(2);
    const auto ticket = std::make_shared<LifeTicket>(
        run_.instance().life().ask_component(c, restarts ? LifeChange::restart : LifeChange::stop));
    const auto is_over = [this, c, ticket] {
        MachineLife& life = run_.instance().life();
        return life.answer_of_component(c, *ticket).outcome != LifeOutcome::pending &&
               life.state_of(c) == ComponentState::running;
    };
    begin(restarts ? "component restarted" : "component stopped",
          Sentence{text}.add(restarts ? "restarts" : "stops"), restarts ? 1ms : lasts, {c},
          [this, c, ticket, is_over] {
              if (is_over()) return true;
              MachineLife& life = run_.instance().life();
              const LifeAnswer answer = life.answer_of_component(c, *ticket);
              if (answer.outcome == LifeOutcome::refused)
                  refusal_ = life.describe(of_.machine.index.activity[c], answer);
              *ticket = life.ask_component(c, LifeChange::start);
              return false;
          });
    faults_.back().is_over = is_over;
}

void SwarmRun::hang(std::size_t a, Duration lasts) {
    const auto is_same = [of = components_of(a)](const Fault& each) {
        return each.of_activity && each.components == of;
    };
    if (std::ranges::any_of(faults_, is_same)) return; // one would end the other
    run_.world().hang(a, run_.now() + lasts);
    begin("activity hangs", Sentence{"activity \"", of_.machine.table.activities[a].name, "\" hangs"}, lasts,
          components_of(a), [this, a] { return run_.world().hang(a, run_.now()), true; });
}

void SwarmRun::strike_activity(Duration lasts) {
    const std::size_t a = random_.below(of_.machine.table.activities.size());
    Sentence text{"activity \"", of_.machine.table.activities[a].name, "\" "};
    const auto runs = [this, a] {
        if (run_.instance().engines()[a].is_active()) return true;
        refusal_ = run_.world().change_activity(a, LifeChange::start);
        return refusal_.empty();
    };
    switch (random_.below(4)) {
    case 0:
    case 1: // as long as watchdogs wait
        return hang(a, std::max(lasts, Duration{std::int64_t{1} << random_.between(20, 32)}));
    case 2:
        begin("activity restarted", text.add("restarts"), 1ms, components_of(a), runs);
        return static_cast<void>(run_.world().change_activity(a, LifeChange::restart));
    default:
        begin("activity stopped", text.add("stops"), lasts, components_of(a), runs);
        faults_.back().is_over = [this, a] { return run_.instance().engines()[a].is_active(); };
        return static_cast<void>(run_.world().change_activity(a, LifeChange::stop));
    }
}

} // namespace tappet
