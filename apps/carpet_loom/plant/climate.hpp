// The climate and lubrication unit behind Modbus: slow physics.
#pragma once

#include "apps/carpet_loom/wires.hpp"
#include "kernel/base/random.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet::loom {

class Climate {
public:
    static constexpr Duration period = 10ms; // step of its slow physics

    explicit Climate(Random& random) noexcept TAPPET_REALTIME {
        temperature_c_ = 21.0 + 4.0 * random.unit();
        humidity_percent_ = 55.0 + 15.0 * random.unit();
        oil_c_ = temperature_c_;
    }

    void step() noexcept TAPPET_REALTIME {
        ++steps_;
        humidity_percent_ += (wanted_humidity_percent_ - humidity_percent_) * (period_s / 60.0);
        const bool pumped = pump_ && !oil_lost_;
        const double wanted_bar = pumped ? wires::nominal::oil_pressure_bar : 0.0;
        oil_bar_ += (wanted_bar - oil_bar_) * (period_s / (pumped ? 0.7 : 2.0));
        oil_c_ += ((pump_ ? temperature_c_ + 20.0 : temperature_c_) - oil_c_) * (period_s / 600.0);
    }
    [[nodiscard]] std::uint64_t steps() const noexcept TAPPET_REALTIME { return steps_; }
    void lose_oil(bool lost) noexcept TAPPET_REALTIME { oil_lost_ = lost; }
    void set_oil_level_low(bool low) noexcept TAPPET_REALTIME { oil_level_low_ = low; }
    [[nodiscard]] bool oil_lost() const noexcept TAPPET_REALTIME { return oil_lost_; }
    void set_pump(bool on) noexcept TAPPET_REALTIME { pump_ = on; }
    void want_humidity(double percent) noexcept TAPPET_REALTIME { wanted_humidity_percent_ = percent; }
    [[nodiscard]] double temperature_c() const noexcept TAPPET_REALTIME { return temperature_c_; }
    [[nodiscard]] double humidity_percent() const noexcept TAPPET_REALTIME { return humidity_percent_; }
    [[nodiscard]] double oil_bar() const noexcept TAPPET_REALTIME { return oil_bar_; }
    [[nodiscard]] double oil_c() const noexcept TAPPET_REALTIME { return oil_c_; }
    [[nodiscard]] bool oil_level_low() const noexcept TAPPET_REALTIME { return oil_level_low_; }

private:
    static constexpr double period_s = to_seconds(period);

    std::uint64_t steps_ = 0;
    double temperature_c_ = 23.0;
    double humidity_percent_ = 60.0;
    double oil_bar_ = 0.0;
    double oil_c_ = 23.0;
    bool pump_ = false;
    bool oil_lost_ = false;
    bool oil_level_low_ = false;
    double wanted_humidity_percent_ = 65.0;
};

} // namespace tappet::loom
