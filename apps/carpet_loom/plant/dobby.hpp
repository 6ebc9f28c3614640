// The harness head: takes the pattern bits of the next pick when the harnesses cross level, and says so.
#pragma once

#include "apps/carpet_loom/plant/node.hpp"
#include "apps/carpet_loom/plant/shapes.hpp"

namespace tappet::loom {

class Dobby {
public:
    static constexpr double level_deg = 10.0; // either side of stop_deg

    explicit Dobby(Random& random) noexcept TAPPET_REALTIME : node_(wires::node::dobby, 0, random) {}

    [[nodiscard]] Node& node() noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] const Node& node() const noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] std::uint16_t pattern() const noexcept TAPPET_REALTIME { return pattern_; }
    [[nodiscard]] std::uint32_t taken() const noexcept TAPPET_REALTIME { return taken_; }

    void command(const Wire& wire) noexcept TAPPET_REALTIME {
        if (!node_.alive() || !node_.operational()) return;
        offered_ = static_cast<std::uint32_t>(wire.signals.integer(pick));
        offered_pattern_ = static_cast<std::uint16_t>(wire.signals.integer(pattern_bits));
    }
    void restart() noexcept TAPPET_REALTIME { offered_ = taken_; }
    /// The harnesses cross level. False when no new pick was offered: the old pattern is woven again.
    bool cross(Time now, Wire& out) noexcept TAPPET_REALTIME {
        const bool fresh = offered_ != taken_;
        taken_ = offered_;
        pattern_ = offered_pattern_;
        tell(now, out);
        return fresh;
    }
    /// The shaft stands at an angle at this moment.
    void follow(double angle_deg, Time now, Wire& out) noexcept TAPPET_REALTIME {
        const double off = angle_deg - wires::nominal::stop_deg;
        const bool level = off >= -level_deg && off <= level_deg;
        if (level == level_ && told_) return;
        level_ = level;
        tell(now, out);
    }
    /// After its network was started it says once where it stands.
    void introduce(Time now, Wire& out) noexcept TAPPET_REALTIME { tell(now, out); }

private:
    static constexpr Wire::Signals::ReceivedSignal pick{"dobby_command.pick"};
    static constexpr Wire::Signals::ReceivedSignal pattern_bits{"dobby_command.pattern"};
    static constexpr Wire::Signals::Sent status{"dobby"};
    static constexpr Wire::Signals::SentSignal pick_taken{"dobby.pick_taken"}, is_level{"dobby.level"};

    void tell(Time now, Wire& out) noexcept TAPPET_REALTIME {
        told_ = true;
        if (!node_.alive() || !node_.operational()) return;
        out.signals.set_integer(pick_taken, taken_);
        out.signals.set_integer(is_level, level_ ? 1 : 0);
        out.send(status, now);
    }

    Node node_;
    std::uint32_t offered_ = 0;
    std::uint32_t taken_ = 0;
    std::uint16_t offered_pattern_ = 0;
    std::uint16_t pattern_ = 0;
    bool level_ = false;
    bool told_ = false;
};

} // namespace tappet::loom
