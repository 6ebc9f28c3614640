// A machine with one CAN bus under virtual time, and the other end of its wire. Uses no test framework.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/can/twin_bus.hpp"
#include "drivers/canopen/simulated_node.hpp"
#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"
#include "tests/drivers/components/board.hpp"

#include <vector>

namespace tappet::test {

/// `Bus` is the type of the machine's bus, on its device "wire".
template <const auto& table, class Bus> struct WireRig : canopen::FrameSink {
    static constexpr Duration tick = 100us;

    explicit WireRig(std::uint32_t bit_rate) {
        good &= twin.open({.interface = "machine",
                           .receive = Bus::device_map.receive,
                           .transmit = Bus::device_map.transmit})
                    .has_value();
        good &= far_end
                    .open({.interface = "nodes",
                           .receive = Bus::device_map.transmit,
                           .transmit = Bus::device_map.receive})
                    .has_value();
        good &= wire.attach(twin) && wire.attach(far_end);
        wire.set_bit_rates({bit_rate, 0});
        const ProvidedDevice provided{type_id<can::Device>, "wire", static_cast<can::Device*>(&twin)};
        good &= instance.configure({&provided, 1}).has_value();
    }

    void run_until(Duration end) {
        if (!started) {
            world.add({this, [](void* self) { return static_cast<WireRig*>(self)->next_tick; },
                       [](void* self, Time now) { static_cast<WireRig*>(self)->carry(now); }});
            world.start();
        }
        started = true;
        good &= world.run_until(Time{end});
    }
    void run(Duration time) { run_until(clock.now().time_since_epoch() + time); }

    /// A frame of the machine's.
    virtual void hear(const can::Frame& frame, Time now) = 0;
    /// Each tick, after them.
    virtual void pass(Time now) = 0;
    void send(const can::Frame& frame) noexcept override {
        can::Frame stamped = frame;
        stamped.stamp = clock.now();
        refused += far_end.send(stamped, can::Keep::every) == can::Send::queued ? 0 : 1;
    }
    void carry(Time now) {
        next_tick = now + tick;
        wire.deliver_until(now);
        can::Frame frame;
        while (far_end.receive(frame).what != can::Received::none) hear(frame, now);
        pass(now);
        far_end.service(now);
        wire.deliver_until(now);
    }

    os::Clock clock{os::Clock::Kind::virtual_time};
    can::TwinBus wire{1};
    can::Twin twin, far_end;
    MachineInstance instance{AtRunTime<table, board>::machine(), clock};
    VirtualWorld world{instance};
    bool good = true; ///< conditions without which nothing can be tested
    int refused = 0;  ///< frames of the nodes that found no room
    bool started = false;
    Time next_tick{};
};

} // namespace tappet::test
