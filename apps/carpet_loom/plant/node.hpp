// The loom's CANopen nodes, each with its own clock.
#pragma once

#include "apps/carpet_loom/network.hpp"
#include "apps/carpet_loom/plant/wire.hpp"
#include "kernel/base/random.hpp"

namespace tappet::loom {

/// Its clock is off by up to 50 ppm, and it boots some time after power-on.
template <const canopen::Dictionary& dictionary>
class Node final : public canopen::SimulatedDevice<dictionary> {
public:
    Node(std::uint8_t id, Random& random) noexcept TAPPET_REALTIME
        : canopen::SimulatedDevice<dictionary>{id} {
        this->set_clock_error(random.between(-50, 50));
        this->power_on(at_ns(random.between(20'000'000, 120'000'000)));
    }
};

} // namespace tappet::loom
