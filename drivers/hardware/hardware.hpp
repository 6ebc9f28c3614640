// The real devices of one machine, opened where its binding says they stand on the board. Kinds of devices
// that its table does not name cost nothing: neither memory nor their library.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "drivers/hardware/open.hpp"
#include "kernel/machine/check/board.hpp"

#include <array>

namespace tappet {

/// Of the machine's own kinds, those that no driver here knows, it opens none.
template <const auto& table>
class Hardware final : public Devices {
public:
    static constexpr DeviceCounts count = count_devices(table.view());

    std::expected<void, Sentence> open(const AcceptedMachine& machine) override {
        n_ = {};
        if (machine.board->simulated && count.all() != 0)
            return std::unexpected(Sentence{"board \"", machine.board->name,
                                            "\" is simulated and has no real device; build the firmware for "
                                            "another board"});
        for (const ComponentRow& row : machine.table.components) {
            if (row.type->device_map == nullptr) continue;
            const BoundDevice* bound = checks::find_named(machine.binding->devices, row.device); // as checked
            const BoundTo to{row, *bound, checks::find_named(machine.board->devices, bound->at)};
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

private:
    template <class Device>
    void provide(std::string_view name, Device& device) {
        provided_[n_.all()] = {type_id<Device>, name, &device};
    }
    std::expected<void, Sentence> open(const BoundTo& to) {
        if constexpr (count.can > 0)
            if (drives(to.row, "can")) {
                provide<can::Device>(to.bound.name, can_[n_.can]);
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
                servers_[n_.modbus] = {to.bound.name, to.address(), to.device != nullptr};
                return open_device(modbus_[n_.modbus++], to);
            }
        return {};
    }

    DeviceCounts n_{}; // opened so far
    std::array<can::SocketCan, count.can> can_{};
    std::array<gpio::Lines, count.gpio> gpio_{};
    std::array<PlacedLines, count.gpio> lines_of_{};
    std::array<modbus::LibmodbusTransport, count.modbus> modbus_{};
    struct Place {
        std::string_view name, at;
        bool is_serial = false;
    };
    std::array<Place, count.modbus> servers_{};
    std::array<ProvidedDevice, count.all()> provided_{};
};

} // namespace tappet
