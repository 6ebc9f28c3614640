// The harness head: takes the pattern bits of the next pick when the harnesses cross level, and reports it.
#pragma once

#include "apps/carpet_loom/plant/node.hpp"
#include "apps/carpet_loom/plant/shapes.hpp"

namespace tappet::loom {

class Dobby {
public:
    static constexpr double level_deg = 10.0; // either side of stop_deg

    explicit Dobby(Random& random) noexcept TAPPET_REALTIME : node_(wires::node::dobby, random) {}

    [[nodiscard]] canopen::SimulatedNode& node() noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] const canopen::SimulatedNode& node() const noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] std::uint16_t pattern() const noexcept TAPPET_REALTIME { return pattern_; }
    [[nodiscard]] std::uint32_t taken() const noexcept TAPPET_REALTIME { return taken_; }

    void command() noexcept TAPPET_REALTIME {
        offered_ = static_cast<std::uint32_t>(node_.get(0x2310));
        offered_pattern_ = static_cast<std::uint16_t>(node_.get(0x2311));
    }
    void restart() noexcept TAPPET_REALTIME { offered_ = taken_; }
    /// The harnesses cross level. Returns false when no new pick was offered: the old pattern is woven again.
    bool cross(Time now, Wire& out) noexcept TAPPET_REALTIME {
        const bool fresh = offered_ != taken_;
        taken_ = offered_;
        pattern_ = offered_pattern_;
        tell(now, out);
        return fresh;
    }
    /// Follows the shaft, which is at this angle now; reports each change of level.
    void follow(double angle_deg, Time now, Wire& out) noexcept TAPPET_REALTIME {
        const double off = angle_deg - wires::nominal::stop_deg;
        const bool level = off >= -level_deg && off <= level_deg;
        if (level == level_ && told_) return;
        level_ = level;
        tell(now, out);
    }
    /// Reports its position once after its network was started.
    void introduce(Time now, Wire& out) noexcept TAPPET_REALTIME { tell(now, out); }

private:
    void tell(Time now, Wire& out) noexcept TAPPET_REALTIME {
        told_ = true;
        node_.set(0x2300, taken_);
        node_.set(0x2301, level_ ? 1 : 0);
        node_.send_pdo(0, now, out);
    }

    Node<canopen::dictionary<files::dobby_eds>> node_;
    std::uint32_t offered_ = 0;
    std::uint32_t taken_ = 0;
    std::uint16_t offered_pattern_ = 0;
    std::uint16_t pattern_ = 0;
    bool level_ = false;
    bool told_ = false;
};

} // namespace tappet::loom
