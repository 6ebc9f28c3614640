// Opens both controllers by the machine's map, the plant's with sent and received frames exchanged.
#include "drivers/can/simulated_bus.hpp"

#include <array>
#include <utility>

namespace tappet::can {

std::expected<void, Sentence> SimulatedBus::open(const void* device_map) {
    const auto& map = *(map_ = static_cast<const Identifiers*>(device_map));
    settings.interface = name;
    if (map.restarts_allowed != 0) settings.restarts_allowed = map.restarts_allowed;
    settings.receive = map.receive;
    settings.transmit = map.transmit;
    settings.takes_fd = map.has_fd;
    safe_ = map.safe;
    sent = {name, map};
    if (auto opened = machine.open(settings); !opened) return opened;
    Settings others = settings;
    std::swap(others.receive, others.transmit);
    others.restarts_allowed = ~0u; // nodes retry without limit
    if (auto opened = plant.open(others); !opened) return opened;
    if (!wire.attach(machine) || !wire.attach(plant))
        return std::unexpected(Sentence{"twin bus: no room for two ends"});
    return {};
}

void SimulatedBus::bring_to_plant(Time now) {
    wire.deliver_until(now);
    if (faulted(plant.state())) static_cast<void>(plant.restart());
}

void SimulatedBus::send_safe_frames(Time now) noexcept {
    static_cast<void>(open_again());
    for (Frame frame : safe_) {
        frame.stamp = now;
        static_cast<void>(machine.send(frame, Keep::last));
    }
    machine.finish(now);
}

TwinFault SimulatedBus::strike(Random& random, Time now, bool with_any_values) {
    if (with_any_values && random.one_in(3)) return say_anything(random, now);
    Sentence text{"bus \"", name, "\" "};
    const std::uint64_t what = random.below(7);
    if (what < 4) return disturb_frames(random, what);
    if (what == 4) {
        wire.set_acknowledged(false);
        return {"bus unacknowledged", {text.add("acknowledges nothing")}, [this](Time) {
                    return wire.set_acknowledged(true), true;
                }};
    }
    if (what == 5) {
        wire.bus_off(machine);
        return {"bus off", {text.add("goes off")}, [this](Time) { return !is_off(); }};
    }
    const auto often = static_cast<std::uint32_t>(random.between(1, 100));
    wire.overflow(machine, often);
    return {"bus overflow", {text.add("overflows by ").add(often)}, [](Time) { return true; }};
}

TwinFault SimulatedBus::disturb_frames(Random& random, std::size_t what) {
    const auto often = static_cast<std::uint32_t>(random.between(1, 100));
    constexpr std::array<std::string_view, 4> names{"bus loses", "bus doubles", "bus corrupts", "bus delays"};
    Chance* const chance = std::array{&wire.faults.lose, &wire.faults.duplicate, &wire.faults.corrupt_length,
                                      &wire.faults.delay}[what];
    chance->one_in = often;
    wire.faults.only = {};
    Sentence text{"bus \"", name, "\" ", names[what].substr(4), " one frame in ", often};
    if (chance == &wire.faults.delay) wire.faults.delay_by = Duration{random.between(10'000, 20'000'000)};
    const std::size_t received = map_->receive.size(), all = received + map_->transmit.size();
    if (const std::size_t one = random.below(2 * all); one < all) {
        wire.faults.only = one < received ? map_->receive[one] : map_->transmit[one - received];
        text.add(" of identifier ").add(wire.faults.only->id);
    }
    return {names[what], {text}, [chance](Time) { return chance->one_in = 0, true; }};
}

/// Sends the machine values that no node would send: not-a-number, ends of ranges, anything.
TwinFault SimulatedBus::say_anything(Random& random, Time now) {
    std::vector<const FrameRow*> rows;
    for (const FrameRow& row : map_->frames)
        if (row.direction == Direction::receive) rows.push_back(&row);
    if (rows.empty()) return {};
    const FrameRow& row = *rows[random.below(rows.size())];
    Frame frame;
    frame.id = row.identifier.id;
    frame.extended = row.identifier.extended;
    frame.length = row.length;
    set_format(frame, row.format);
    const std::uint64_t how = random.below(4);
    constexpr std::array<unsigned, 3> patterns{0xFF, 0x00, 0x7F};
    constexpr std::array<std::string_view, 4> names{"ones", "zeros", "0x7F", "anything"};
    for (std::size_t i = 0; i < row.length; ++i)
        frame.data[i] = static_cast<std::uint8_t>(how < 3 ? patterns[how] : random.below(256));
    for (std::int64_t n = random.between(1, 3); n > 0; --n) wire.put(frame, now);
    // An axis that starts takes its position from the wire.
    return {.kind = "bus says anything",
            .texts = {Sentence{"bus \"", name, "\" says ", names[how], " in ", row.name}},
            .misleads = 50ms};
}

} // namespace tappet::can
