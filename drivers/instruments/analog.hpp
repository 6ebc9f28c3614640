// Analog inputs and outputs: convert between a converter's counts or a transmitter's current and a quantity.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/text.hpp"
#include "kernel/component/component.hpp"

#include <algorithm>
#include <string_view>

namespace tappet::instruments {

/// A straight line through two points: 4 mA is 0 bar, 20 mA is 16 bar.
struct AnalogScale {
    double raw_low = 4.0, raw_high = 20.0;
    double low = 0.0, high = 1.0;

    [[nodiscard]] constexpr double value(double raw) const noexcept TAPPET_REALTIME {
        return low + (raw - raw_low) / (raw_high - raw_low) * (high - low);
    }
    [[nodiscard]] constexpr double raw(double value) const noexcept TAPPET_REALTIME {
        return raw_low + (value - low) / (high - low) * (raw_high - raw_low);
    }
    /// Returns whether the signal is plausible. For a live zero: below 3.6 mA the wire is broken, above 21 mA
    /// the sensor has failed (NAMUR NE 43). For other signals the same share of the range.
    [[nodiscard]] constexpr bool is_alive(double raw) const noexcept TAPPET_REALTIME {
        const double share = (raw - raw_low) / (raw_high - raw_low);
        return share >= -0.4 / 16.0 && share <= 17.0 / 16.0; // false when it is not a number
    }
};

namespace detail {

/// Checks the properties that both have; returns what is wrong with them.
template <class Analog>
constexpr Sentence check_scale(const Analog& self, const Proposal& proposal) noexcept TAPPET_REALTIME {
    if (proposal.of(self.raw_low) != proposal.of(self.raw_high) &&
        proposal.of(self.low) != proposal.of(self.high))
        return {};
    return Sentence{"both ends of the range are the same, so that there is no scale; write two points"};
}
template <class Analog>
AnalogScale scale_of(const Analog& self) noexcept TAPPET_REALTIME {
    return {self.raw_low.get(), self.raw_high.get(), self.low.get(), self.high.get()};
}
inline constexpr std::string_view of_low = "at raw_low", of_high = "at raw_high";

} // namespace detail

/// Sensor of a quantity: AnalogInput<"bar">. While the signal is stale or the wire is broken, the last value
/// stays and `good` is false. Real-time.
template <text unit>
struct AnalogInput {
    Input<double> raw;
    Output<double> value;
    Output<bool> good;
    Property<double> raw_low{4.0}, raw_high{20.0}, low{0.0}, high{1.0};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME { step(cycle); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const AnalogScale scale = detail::scale_of(*this);
        double now = 0.0;
        const Flow flow = raw.read(now);
        const bool is_good = (flow == Flow::fresh || flow == Flow::old) && scale.is_alive(now);
        if (is_good) value.write(scale.value(now), raw.stamp());
        good.write(is_good);
    }
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        return detail::check_scale(*this, proposal);
    }

    static constexpr auto interface() {
        return facets(
            input<&AnalogInput::raw>("raw", "", "of the converter: mA, V or counts"),
            output<&AnalogInput::value>("value", unit.view(), "the quantity"),
            output<&AnalogInput::good>("good", "", "the wire is intact and the value is current",
                                       while_stopped(false)),
            property<&AnalogInput::raw_low>("raw_low", "", "one end of the signal", range(-1e9, 1e9)),
            property<&AnalogInput::raw_high>("raw_high", "", "the other end", range(-1e9, 1e9)),
            property<&AnalogInput::low>("low", unit.view(), detail::of_low, range(-1e9, 1e9)),
            property<&AnalogInput::high>("high", unit.view(), detail::of_high, range(-1e9, 1e9)));
    }
};

/// Effector of a quantity, limited to its range. Sends `low` in place of a value that is not a number, or
/// that a force hid while its writer stopped, and when it stops itself. Real-time.
template <text unit>
struct AnalogOutput {
    Input<double> value;
    Output<double> raw, sent;
    Property<double> raw_low{4.0}, raw_high{20.0}, low{0.0}, high{1.0};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME { stop(cycle); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const AnalogScale scale = detail::scale_of(*this);
        const double wanted = value.get();
        const auto [least, most] = std::minmax(scale.low, scale.high);
        const bool is_wanted = is_number(wanted) && !value.is_abandoned();
        send(scale, is_wanted ? std::clamp(wanted, least, most) : scale.low);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        const AnalogScale scale = detail::scale_of(*this);
        send(scale, scale.low);
    }
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        return detail::check_scale(*this, proposal);
    }

    static constexpr auto interface() {
        return facets(
            input<&AnalogOutput::value>("value", unit.view(), "the quantity that is wanted"),
            output<&AnalogOutput::raw>("raw", "", "to the converter: mA, V or counts"),
            output<&AnalogOutput::sent>("sent", unit.view(), "the quantity, within its range"),
            property<&AnalogOutput::raw_low>("raw_low", "", "one end of the signal", range(-1e9, 1e9)),
            property<&AnalogOutput::raw_high>("raw_high", "", "the other end", range(-1e9, 1e9)),
            property<&AnalogOutput::low>("low", unit.view(), detail::of_low, range(-1e9, 1e9)),
            property<&AnalogOutput::high>("high", unit.view(), detail::of_high, range(-1e9, 1e9)));
    }

private:
    void send(const AnalogScale& scale, double quantity) noexcept TAPPET_REALTIME {
        raw.write(scale.raw(quantity));
        sent.write(quantity);
    }
};

} // namespace tappet::instruments
