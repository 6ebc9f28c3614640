// Encoders: counts of a register that wraps become a way, in units.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/unwrapped_count.hpp"
#include "kernel/component/component.hpp"

#include <cstdint>

namespace tappet::instruments {

/// Sensor of a position: Encoder<"m">, Encoder<"rad", 16>. Of an absolute encoder it has its zero; of
/// one that counts from its power-on, that place. While the counts are stale the last position stays and
/// `good` is false; it counts on from the register afterwards. Real-time.
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
        const bool is_good = flow == Flow::fresh || flow == Flow::old;
        if (!is_good) unwrapped_.lose();
        if (flow == Flow::fresh || (is_good && !unwrapped_.is_known())) {
            const auto way = static_cast<double>(unwrapped_.take(code, bits));
            position.write(way / counts_per_unit.get(), counts.stamp());
        }
        good.write(is_good);
    }

    static constexpr auto interface() {
        return facets(input<&Encoder::counts>("counts", "", "of the encoder's register"),
                      output<&Encoder::position>("position", unit.view(), "of the axis"),
                      output<&Encoder::good>("good", "", "the position is that of now", while_stopped(false)),
                      property<&Encoder::counts_per_unit>("counts_per_unit", "",
                                                          "negative: it is mounted the other "
                                                          "way round",
                                                          range(-1e12, 1e12)));
    }
    /// A way of no length has no counts.
    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        if (proposal.of(counts_per_unit) != 0.0) return {};
        return Sentence{"no counts for a unit: a position would be infinite; write how many there are"};
    }

private:
    UnwrappedCount unwrapped_;
};

} // namespace tappet::instruments
