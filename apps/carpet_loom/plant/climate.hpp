// The climate and lubrication unit behind Modbus: slow physics and the unit's registers with their limits.
#pragma once

#include "apps/carpet_loom/plant/shapes.hpp"
#include "apps/carpet_loom/wires.hpp"
#include "kernel/base/random.hpp"
#include "kernel/base/time.hpp"

#include <array>
#include <expected>

namespace tappet::loom {

/// Modbus exception codes the unit answers with.
enum class ModbusError : std::uint8_t { illegal_address = 2, illegal_value = 3 };
template <class T> using ModbusAnswer = std::expected<T, ModbusError>;

class Climate {
public:
    static constexpr Duration period = 10ms; // of its slow physics

    explicit Climate(Random& random) noexcept TAPPET_REALTIME {
        temperature_c_ = 21.0 + 4.0 * random.unit();
        humidity_percent_ = 55.0 + 15.0 * random.unit();
        oil_c_ = temperature_c_;
    }

    void step() noexcept TAPPET_REALTIME {
        ++steps_;
        const double set_point =
            0.1 * static_cast<double>(holding_[wires::modbus::holding_register::humidity_set_point]);
        humidity_percent_ += (set_point - humidity_percent_) * (period_s / 60.0);
        const bool pumped = pump_ && !oil_lost_;
        const double wanted_bar = pumped ? wires::nominal::oil_pressure_bar : 0.0;
        oil_bar_ += (wanted_bar - oil_bar_) * (period_s / (pumped ? 0.7 : 2.0));
        oil_c_ += ((pump_ ? temperature_c_ + 20.0 : temperature_c_) - oil_c_) * (period_s / 600.0);
    }
    [[nodiscard]] std::uint64_t steps() const noexcept TAPPET_REALTIME { return steps_; }
    void lose_oil(bool lost) noexcept TAPPET_REALTIME { oil_lost_ = lost; }
    void set_oil_level_low(bool low) noexcept TAPPET_REALTIME { oil_level_low_ = low; }
    [[nodiscard]] bool oil_lost() const noexcept TAPPET_REALTIME { return oil_lost_; }
    [[nodiscard]] double oil_bar() const noexcept TAPPET_REALTIME { return oil_bar_; }
    [[nodiscard]] bool pump() const noexcept TAPPET_REALTIME { return pump_; }

    [[nodiscard]] ModbusAnswer<std::uint16_t> input_register(std::uint16_t address) const noexcept
        TAPPET_REALTIME {
        namespace at = wires::modbus::input_register;
        switch (address) {
        case at::room_temperature: return word(temperature_c_ * 10.0);
        case at::humidity: return word(humidity_percent_ * 10.0);
        case at::oil_pressure: return word(oil_bar_ * 100.0);
        case at::oil_temperature: return word(oil_c_ * 10.0);
        default: return std::unexpected(ModbusError::illegal_address);
        }
    }
    [[nodiscard]] ModbusAnswer<std::uint16_t> holding_register(std::uint16_t address) const noexcept
        TAPPET_REALTIME {
        if (address >= holding_.size()) return std::unexpected(ModbusError::illegal_address);
        return holding_[address];
    }
    [[nodiscard]] ModbusAnswer<bool> coil(std::uint16_t address) const noexcept TAPPET_REALTIME {
        if (address != wires::modbus::coil::lubrication_pump)
            return std::unexpected(ModbusError::illegal_address);
        return pump_;
    }
    [[nodiscard]] ModbusAnswer<bool> discrete_input(std::uint16_t address) const noexcept TAPPET_REALTIME {
        if (address != wires::modbus::discrete_input::oil_level_low)
            return std::unexpected(ModbusError::illegal_address);
        return oil_level_low_;
    }
    static ModbusAnswer<void> check_holding_register(std::uint16_t address, std::uint16_t value) noexcept
        TAPPET_REALTIME {
        if (address >= limits_of.size()) return std::unexpected(ModbusError::illegal_address);
        const Limits limits = limits_of[address];
        if (value < limits.low || value > limits.high) return std::unexpected(ModbusError::illegal_value);
        return {};
    }
    ModbusAnswer<void> write_holding_register(std::uint16_t address, std::uint16_t value) noexcept
        TAPPET_REALTIME {
        const auto answer = check_holding_register(address, value);
        if (answer) holding_[address] = value;
        return answer;
    }
    ModbusAnswer<void> write_coil(std::uint16_t address, bool on) noexcept TAPPET_REALTIME {
        if (address != wires::modbus::coil::lubrication_pump)
            return std::unexpected(ModbusError::illegal_address);
        pump_ = on;
        return {};
    }

private:
    struct Limits {
        std::uint16_t low, high;
    };
    static constexpr std::array<Limits, wires::modbus::holding_register::count> limits_of{
        {{300, 900}, {10, 3600}}};
    static constexpr double period_s = to_seconds(period);

    static std::uint16_t word(double value) noexcept TAPPET_REALTIME {
        return static_cast<std::uint16_t>(round_to_int(value < 0.0 ? 0.0 : value));
    }

    std::uint64_t steps_ = 0;
    double temperature_c_ = 23.0;
    double humidity_percent_ = 60.0;
    double oil_bar_ = 0.0;
    double oil_c_ = 23.0;
    bool pump_ = false;
    bool oil_lost_ = false;
    bool oil_level_low_ = false;
    std::array<std::uint16_t, wires::modbus::holding_register::count> holding_{650, 120};
};

} // namespace tappet::loom
