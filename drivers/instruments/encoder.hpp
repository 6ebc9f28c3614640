// Encoders: counts of a register that wraps become a way, in units.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/component/component.hpp"

#include <cstdint>

namespace tappet::instruments {

/// What a register of so many bits counts, unwrapped: between two samples it moves by less than half of its
/// range. The first one after a begin, or after it was lost, counts from the register itself, taken as
/// signed.
template <int bits>
class EncoderCounts {
    static_assert(bits >= 2 && bits <= 63);

public:
    /// The whole way, in counts. Real-time.
    constexpr std::int64_t take(std::int64_t code) noexcept TAPPET_REALTIME {
        travelled_ = is_known_ ? travelled_ + as_signed(code - last_) : as_signed(code);
        last_ = code;
        is_known_ = true;
        return travelled_;
    }
    /// Samples were missed: nobody knows how often it wrapped. Real-time.
    constexpr void lose() noexcept TAPPET_REALTIME { is_known_ = false; }
    [[nodiscard]] constexpr bool is_known() const noexcept TAPPET_REALTIME { return is_known_; }

    /// The lowest bits, with the sign of the highest of them.
    static constexpr std::int64_t as_signed(std::int64_t code) noexcept TAPPET_REALTIME {
        constexpr int above = 64 - bits;
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(code) << above) >> above;
    }

private:
    std::int64_t travelled_ = 0, last_ = 0;
    bool is_known_ = false;
};

/// Sensor of a position: Encoder<"m">, Encoder<"rad", 16>. Of an absolute encoder it has its zero; of
/// one that counts from its power-on, that place. While the counts are stale the last position stays and
/// `good` is false; it counts on from the register afterwards. Real-time.
template <text unit, int bits = 32>
struct Encoder {
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
            const auto way = static_cast<double>(unwrapped_.take(code));
            position.write(way / counts_per_unit.get(), counts.stamp());
        }
        good.write(is_good);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { good.write(false); }

    static constexpr auto interface() {
        return facets(input<&Encoder::counts>("counts", "", "of the encoder's register"),
                      output<&Encoder::position>("position", unit.view(), "of the axis"),
                      output<&Encoder::good>("good", "", "the position is that of now"),
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
    EncoderCounts<bits> unwrapped_;
};

} // namespace tappet::instruments
