// Drives the readers of datagrams under virtual time: executes the steps of an input, and holds the twins
// that must agree with them.
#pragma once

#include "drivers/udp/twin.hpp"
#include "kernel/component/component.hpp"
#include "tests/fuzz/input.hpp"

#include <array>

namespace tappet::fuzz {

using Bytes = std::span<const std::byte>;

inline Bytes bytes_of(Script& script, std::size_t most) { return std::as_bytes(script.next(most)); }
inline std::int64_t number_of(Script& script) {
    std::int64_t value = 0;
    std::ranges::copy(bytes_of(script, sizeof value), std::as_writable_bytes(std::span{&value, 1}).begin());
    return value;
}

struct Rig {
    os::Clock clock{os::Clock::Kind::virtual_time};
    Cycle cycle{};
    std::array<std::byte, udp::most_bytes> room{};
    Bytes last{}; ///< the last datagram
    std::int64_t arrived = 0;

    template <class Component>
    void set_up(Component& component, udp::Twin& twin) {
        const std::array<ProvidedDevice, 1> devices{
            {{type_id<udp::Device>, "it", static_cast<udp::Device*>(&twin)}}};
        Setup setup{.device_name = "it", .devices = devices, .clock = &clock};
        demand(component.configure(setup).empty());
        component.start(cycle);
    }
    void wait(Duration time) {
        clock.advance_to(clock.now() + time);
        cycle.now = cycle.release = clock.now();
    }
    void tell(udp::Twin& to, Bytes datagram) {
        if (datagram.data() != room.data()) std::ranges::copy(datagram, room.begin());
        last = std::span{room}.first(datagram.size());
        if (to.tell(last) && !last.empty()) ++arrived;
    }
};

} // namespace tappet::fuzz
