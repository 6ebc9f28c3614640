// Encoders: convert the counts of a register that wraps to a position in units.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/unwrapped_count.hpp"
#include "kernel/component/component.hpp"

#include <cmath>
#include <cstdint>

namespace tappet::instruments {

/// Sensor of a position: Encoder<"m">, Encoder<"rad", 16>. An absolute encoder provides its zero; with one
/// that counts from power-on, zero is the position at power-on. While the counts are stale or give no number,
/// the last position stays and `good` is false; after stale counts it continues from the register. Real-time.
template <text unit, int bits = 32>
struct Encoder {
    static_assert(bits >= 2 && bits <= 63);

    Input<std::int64_t> counts;
    Output<double> position;
    Output<bool> good;
    Property<double> counts_per_unit{1.0};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        unwrapped_.lose();
        step(cycle);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        std::int64_t code = 0;
        const Flow flow = counts.read(code);
        const bool is_counted = flow == Flow::fresh || flow == Flow::old;
        if (!is_counted) unwrapped_.lose();
        if (flow == Flow::fresh || (is_counted && !unwrapped_.is_known())) {
            const double now = static_cast<double>(unwrapped_.take(code, bits)) / counts_per_unit.get();
            means_place_ = is_number(now);
            if (means_place_) position.write(now, counts.stamp());
        }
        good.write(is_counted && means_place_);
    }

    static constexpr auto interface() {
        return facets(input<&Encoder::counts>("counts", "", "of the encoder's register"),
                      output<&Encoder::position>("position", unit.view(), "of the axis"),
                      output<&Encoder::good>("good", "", "the position is current", while_stopped(false)),
                      property<&Encoder::counts_per_unit>("counts_per_unit", "",
                                                          "negative: it is mounted the other "
                                                          "way round",
                                                          range(-1e12, 1e12)));
    }
    /// With almost no counts per unit a position would have no limit.
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        if (std::abs(proposal.of(counts_per_unit)) >= 1e-9) return {};
        return Sentence{"less than 1e-9 counts for a unit: no encoder is so coarse; write how many there "
                        "are"};
    }

private:
    UnwrappedCount unwrapped_;
    bool means_place_ = false;
};

} // namespace tappet::instruments
