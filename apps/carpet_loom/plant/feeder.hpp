// The weft feeder (similar to CiA 414-2): winds yarn in stock ahead of the picks, until its bobbin is empty.
#pragma once

#include "apps/carpet_loom/plant/node.hpp"

namespace tappet::loom {

class Feeder {
public:
    explicit Feeder(Random& random) noexcept TAPPET_REALTIME : node_(wires::node::feeder, random) {}

    [[nodiscard]] canopen::SimulatedNode& node() noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] const canopen::SimulatedNode& node() const noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] bool fed() const noexcept TAPPET_REALTIME {
        return windings_ >= wires::nominal::windings_per_pick;
    }
    [[nodiscard]] bool empty() const noexcept TAPPET_REALTIME { return empty_; }
    [[nodiscard]] std::uint8_t colour() const noexcept TAPPET_REALTIME { return colour_; }

    void command() noexcept TAPPET_REALTIME {
        colour_ = static_cast<std::uint8_t>(node_.get(0x2210));
        per_minute_ = static_cast<std::uint32_t>(node_.get(0x2211));
    }
    void restart() noexcept TAPPET_REALTIME { per_minute_ = 0; }
    void run_out() noexcept TAPPET_REALTIME { empty_ = true; }
    void new_bobbin() noexcept TAPPET_REALTIME {
        empty_ = false;
        windings_ = std::max<std::uint32_t>(windings_, wires::nominal::windings_per_pick);
    }
    void draw() noexcept TAPPET_REALTIME {
        const auto wanted = static_cast<std::uint32_t>(wires::nominal::windings_per_pick);
        windings_ -= std::min(wanted, windings_);
    }
    /// Call once per status period: winds by the commanded speed, then sends its status.
    void send_status(Wire& out) noexcept TAPPET_REALTIME {
        if (!empty_ && windings_ < drum) {
            wound_ += per_minute_ * static_cast<std::uint32_t>(wires::feeder_status_period / 1ms); // 1/60000
            const std::uint32_t whole = wound_ / 60'000;
            wound_ -= whole * 60'000;
            windings_ = std::min(drum, windings_ + whole);
        }
        std::uint8_t status = 0;
        if (fed() && !empty_) status |= wires::feeder_bit::ready;
        if (empty_) status |= wires::feeder_bit::empty;
        node_.set(0x2200, status);
        node_.set(0x2201, windings_);
        node_.send_due(out);
    }

private:
    static constexpr std::uint32_t drum = 20; // windings it holds

    Node<canopen::dictionary<files::feeder_eds>> node_;
    std::uint8_t colour_ = 0;
    std::uint32_t per_minute_ = 0;
    std::uint32_t wound_ = 0;
    std::uint32_t windings_ = 6;
    bool empty_ = false;
};

} // namespace tappet::loom
