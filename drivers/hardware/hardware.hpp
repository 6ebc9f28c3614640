// The real devices of one machine, opened where its binding says they stand on the board. Kinds of devices
// that its table does not name cost nothing: neither memory nor their library.
#pragma once

#include "drivers/can/signal_map.hpp"
#include "drivers/hardware/devices.hpp"
#include "drivers/hardware/open.hpp"
#include "kernel/machine/check/traffic.hpp"

#include <array>

namespace tappet {

/// Of the machine's own kinds, those that no driver here knows, it opens none.
template <const auto& table>
class Hardware final : public GuardedDevices {
public:
    static constexpr DeviceCounts count = count_devices(table.view());

    std::expected<void, Sentence> open(const AcceptedMachine& machine) override {
        n_ = {};
        if (machine.board->simulated && count.all() != 0)
            return std::unexpected(Sentence{"board \"", machine.board->name,
                                            "\" is simulated and has no real device; build the firmware for "
                                            "another board"});
        const auto worst =
            checks::worst_responses_ns(machine.table, *machine.board, *machine.binding, machine.index);
        for (std::size_t c = 0; c < machine.table.components.size(); ++c) {
            const ComponentRow& row = machine.table.components[c];
            if (row.type->device_map == nullptr) continue;
            const BoundDevice* bound = checks::find_named(machine.binding->devices, row.device); // as checked
            const BoundTo to{row, *bound, checks::find_named(machine.board->devices, bound->at),
                             checks::use_of_device(machine.table, *machine.board, *machine.binding,
                                                   machine.index, worst, c)};
            if (auto opened = open(to); !opened)
                return std::unexpected(Sentence{"board \"", machine.board->name, "\", device \"", row.device,
                                                "\" at \"", to.address(), "\": ", opened.error()});
        }
        return {};
    }
    [[nodiscard]] std::span<const ProvidedDevice> provided() const noexcept override {
        return std::span{provided_}.first(n_.all());
    }
    void report(os::ArmingReport& report) override {
        for (const auto& bus : can_) report.passed("can-bus", bus.found());
        for (std::size_t i = 0; i < n_.modbus; ++i) {
            if (servers_[i].is_serial) continue; // a line opens, whoever is at its end
            const Sentence who{"Modbus server \"", servers_[i].name, "\" at \"", servers_[i].at, "\""};
            if (modbus_[i].connect().outcome == modbus::Outcome::ok)
                report.passed("modbus-server", Sentence{who, " answers"});
            else
                report.warning("modbus-server", Sentence{who, " does not answer"},
                               Sentence{"switch it on, or correct its address in the binding; the machine "
                                        "goes on asking"});
            modbus_[i].disconnect();
        }
    }
    [[nodiscard]] WireCounters counters() const noexcept override {
        WireCounters sum;
        for (const auto& bus : can_) sum.add(bus.counters());
        for (const auto& chip : gpio_) sum.add(chip.counters());
        return sum;
    }

    [[nodiscard]] Bounded<int, 16> kept_by_guardian() const noexcept override {
        Bounded<int, 16> kept;
        for (const auto& chip : gpio_) static_cast<void>(kept.push(chip.wait_handle()));
        return kept;
    }
    std::expected<void, Sentence> prepare_safe_ending() override {
        for (std::size_t i = 0; i < n_.can; ++i)
            if (auto opened = safe_can_[i].open(buses_[i].at, buses_[i].map->safe); !opened) return opened;
        rehearse(safe_can_);
        if (write_safe_lines() != 0)
            return std::unexpected(
                Sentence{"a GPIO chip does not take the safe values of its lines; see that it is "
                         "still there"});
        return {};
    }
    std::size_t write_safe_lines() noexcept override {
        std::size_t failed = 0;
        for (auto& chip : gpio_) failed += chip.make_safe() ? 0u : 1u;
        return failed;
    }
    std::size_t send_safe_frames(Duration within) noexcept override {
        return count.can == 0 ? 0 : tappet::send_safe_frames(safe_can_, within);
    }
    std::size_t write_safe_registers(Duration within, const Meanwhile& meanwhile) noexcept override {
        if constexpr (count.modbus == 0) return 0;
        for (std::size_t i = 0; i < n_.modbus; ++i) {
            safe_modbus_[i].server = &modbus_[i];
            safe_modbus_[i].writes = *servers_[i].safe;
        }
        return tappet::write_safe_registers(std::span{safe_modbus_}.first(n_.modbus), within, meanwhile);
    }

private:
    template <class Device>
    void provide(std::string_view name, Device& device) {
        provided_[n_.all()] = {type_id<Device>, name, &device};
    }
    std::expected<void, Sentence> open(const BoundTo& to) {
        if constexpr (count.can > 0)
            if (drives(to.row, "can")) {
                provide<can::Device>(to.bound.name, can_[n_.can]);
                buses_[n_.can] = {to.address(),
                                  static_cast<const can::Identifiers*>(to.row.type->device_map)};
                return open_device(can_[n_.can++], to);
            }
        if constexpr (count.gpio > 0)
            if (drives(to.row, "gpio")) {
                provide<gpio::Device>(to.bound.name, gpio_[n_.gpio]);
                const std::size_t i = n_.gpio++;
                return open_device(gpio_[i], lines_of_[i], to);
            }
        if constexpr (count.modbus > 0)
            if (drives(to.row, "modbus")) {
                provide<modbus::Transport>(to.bound.name, modbus_[n_.modbus]);
                servers_[n_.modbus] = {to.bound.name, to.address(), to.device != nullptr,
                                       static_cast<const modbus::SafeWrites*>(to.row.type->device_map)};
                return open_device(modbus_[n_.modbus++], to);
            }
        if constexpr (count.udp > 0)
            if (drives(to.row, "udp")) {
                provide<udp::Device>(to.bound.name, udp_[n_.udp]);
                return open_device(udp_[n_.udp++], to);
            }
        return {};
    }

    DeviceCounts n_{}; // opened so far
    std::array<can::SocketCan, count.can> can_{};
    std::array<can::SafeSender, count.can> safe_can_{}; // open in the guardian's process only
    std::array<gpio::Lines, count.gpio> gpio_{};
    std::array<PlacedLines, count.gpio> lines_of_{};
    std::array<modbus::LibmodbusTransport, count.modbus> modbus_{};
    std::array<SafeServer, count.modbus> safe_modbus_{}; // used in the guardian's process only
    std::array<udp::Socket, count.udp> udp_{};
    struct Bus {
        std::string_view at;
        const can::Identifiers* map;
    };
    std::array<Bus, count.can> buses_{};
    struct Server {
        std::string_view name, at;
        bool is_serial = false;
        const modbus::SafeWrites* safe = nullptr;
    };
    std::array<Server, count.modbus> servers_{};
    std::array<ProvidedDevice, count.all()> provided_{};
};

} // namespace tappet
