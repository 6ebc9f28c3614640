// Opens and makes safe devices of all kinds in the same way.
#include "drivers/hardware/opened.hpp"

#include "kernel/machine/check/traffic.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/sleep.hpp"

#include <algorithm>

namespace tappet {

namespace {

constexpr Duration look_every = 5ms; // period of polling for confirmations

} // namespace

Sentence unknown_kind(const ComponentRow& row, std::string_view list) {
    return Sentence{"device \"",
                    row.device,
                    "\" of component \"",
                    row.name,
                    "\" is of kind ",
                    row.type->device_kind->name,
                    ", for which ",
                    list,
                    " has no class; add one, or write "
                    "is_opened_by_driver = true in its DeviceKind"};
}

std::size_t send_safe_frames(std::span<OpenedDevice> devices, Duration within) noexcept {
    for (OpenedDevice& each : devices) each.device->begin_safe_frames();
    for (const Time end = os::Clock::monotonic() + within;;) {
        std::size_t left = 0;
        for (OpenedDevice& each : devices) {
            each.device->send_safe_frames();
            left += each.device->safe_frames_left();
        }
        if (left == 0 || os::Clock::monotonic() >= end) return left;
        os::sleep_for(look_every);
    }
}

// One thread per device, because a request blocks until its answer: a dead device would otherwise delay all
// devices after it.
std::size_t make_safe_requests(std::span<OpenedDevice> devices, Duration within,
                               const Meanwhile& meanwhile) noexcept {
    const Time end = os::Clock::monotonic() + within;
    const auto waits = [](const OpenedDevice& each) { return !each.thread.running() && !each.is_safe; };
    for (OpenedDevice& each : devices) {
        each.is_safe = !each.device->has_safe_requests();
        if (each.is_safe) continue;
        each.end = end;
        each.plan = {.name = "safe-requests",
                     .fifo_priority = os::ThreadPlan::as_its_starter,
                     .body =
                         [](void* of) noexcept {
                             auto& asked = *static_cast<OpenedDevice*>(of);
                             asked.is_safe = asked.device->make_safe_requests(asked.end, {});
                         },
                     .context = &each};
        static_cast<void>(each.thread.start(each.plan).has_value());
    }
    // When the box refuses threads, these devices share the remaining time.
    while (os::Clock::monotonic() < end && std::ranges::any_of(devices, waits)) {
        std::int64_t left = std::ranges::count_if(devices, waits);
        for (OpenedDevice& each : devices) {
            if (!waits(each)) continue;
            const Time now = os::Clock::monotonic();
            each.is_safe = each.device->make_safe_requests(now + (end - now) / left--, meanwhile);
        }
    }
    for (OpenedDevice& each : devices)
        while (!each.thread.join_within(50)) meanwhile();
    return static_cast<std::size_t>(std::ranges::count(devices, false, &OpenedDevice::is_safe));
}

DevicePlace place_of(const ComponentRow& row, const Board& board, const Binding& binding) noexcept {
    const BoundDevice& bound = *checks::find_named(binding.devices, row.device); // as checked
    const BoardDevice* device = checks::find_named(board.devices, bound.at);
    DevicePlace place{.address = bound.at,
                      .is_on_board = device != nullptr,
                      .bound = binding.facts_of(bound),
                      .map = row.type->device_map,
                      .traffic = row.type->device_traffic};
    if (device == nullptr) return place;
    place.address = device->address;
    place.of_board = device->facts;
    return place;
}

std::expected<void, Sentence> OpenedDevices::open(const AcceptedMachine& machine) {
    give_back_all();
    used_ = 0;
    if (machine.board->simulated && !room_.empty())
        return std::unexpected(Sentence{"board \"", machine.board->name,
                                        "\" is simulated and has no real device; build the firmware for "
                                        "another board"});
    const auto worst =
        checks::worst_responses_ns(machine.table, *machine.board, *machine.binding, machine.index);
    for (std::size_t c = 0; c < machine.table.components.size(); ++c) {
        const ComponentRow& row = machine.table.components[c];
        if (row.type->device_kind == nullptr || row.type->device_map == nullptr) continue;
        RealDevice* const device = take(*row.type->device_kind);
        if (device == nullptr) return std::unexpected(unknown_kind(row, "drivers/hardware/kinds.hpp"));
        DevicePlace place = place_of(row, *machine.board, *machine.binding);
        place.use =
            checks::use_of_device(machine.table, *machine.board, *machine.binding, machine.index, worst, c);
        room_[used_].device = device;
        room_[used_].name = row.device;
        provided_[used_++] = device->provided(row.device);
        if (auto opened = device->open(place); !opened)
            return std::unexpected(Sentence{"board \"", machine.board->name, "\", device \"", row.device,
                                            "\" at \"", place.address, "\": ", opened.error()});
    }
    return {};
}

void OpenedDevices::report(os::ArmingReport& report) {
    for (const OpenedDevice& each : opened()) each.device->report(report, each.name);
}

WireCounters OpenedDevices::counters() const noexcept {
    WireCounters sum;
    for (const OpenedDevice& each : opened()) each.device->count(sum);
    return sum;
}

Bounded<int, 16> OpenedDevices::kept_by_guardian() const noexcept {
    Bounded<int, 16> kept;
    for (const OpenedDevice& each : opened())
        if (const int descriptor = each.device->kept_by_guardian(); descriptor >= 0)
            static_cast<void>(kept.push(descriptor)); // has room for all devices of a binding
    return kept;
}

std::expected<void, Sentence> OpenedDevices::prepare_safe_ending() {
    for (const OpenedDevice& each : opened())
        if (auto prepared = each.device->prepare_safe_ending(); !prepared) return prepared;
    return {};
}

std::size_t OpenedDevices::write_safe_lines() noexcept {
    std::size_t failed = 0;
    for (const OpenedDevice& each : opened()) failed += each.device->write_safe_lines() ? 0u : 1u;
    return failed;
}

} // namespace tappet
