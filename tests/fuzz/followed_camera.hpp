// The camera of the tool's robot, and an estimator that follows its data.
#pragma once

#include "apps/two_robots/tool/body_estimator.hpp"
#include "apps/two_robots/tool/camera.hpp"
#include "tests/fuzz/datagram_rig.hpp"

namespace tappet::fuzz {

using namespace two_robots;

template <class Estimator> struct FollowedCamera : Rig {
    udp::Twin twin;
    LedCamera camera;
    Estimator body;
    std::uint16_t exposure = 0, given = 0;
    std::int64_t late = 0, received = 0;

    FollowedCamera() {
        wait(1s);
        const auto& port = PortAccess::data<Leds>;
        port.set_clock(&camera.leds, false, &cycle.now);
        port.set_clock(&body.leds, true, &cycle.now);
        port.link_local(&body.leds, &camera.leds, nullptr);
        port.set_policy(&body.leds, {.max_age = 300ms});
        set_up(camera, twin);
        body.start(cycle);
    }
    /// The packet of a body 1 m in front of the robot.
    static auto packet(std::uint16_t number) {
        Leds leds{.at = leds_on_body, .cycle = number, .seen = 0b111111};
        for (auto& place : leds.at) place[0] += 1.0;
        return led_packet::write(leds, false);
    }
    void step(Duration time = 2ms) {
        wait(time);
        camera.step(cycle);
        const std::int64_t told = received;
        judge();
        body.step(cycle);
        const Duration before = cycle.now - camera.latency.get() - body.leds.stamp();
        if (received > told) demand(before >= 0ns && before <= 10 * camera.period.get());
        const BodyModel& model = body.model.last();
        demand(model.frame.position.allFinite() && model.frame.rotation.allFinite());
        demand(model.twist.linear.allFinite() && model.twist.angular.allFinite());
    }
    void judge() {
        const Leds& leds = camera.leds.last();
        for (std::size_t i = 0; i < led_count; ++i)
            for (const double place : leds.at[i])
                demand((leds.seen >> i & 1U) == 0 || std::abs(place) <= 10.0);
        demand(camera.late.last() >= late && camera.received.last() >= received);
        if (camera.received.last() == received) return;
        // After that many late packets, the reader accepts one that is not ahead of the one before.
        const bool is_ahead = static_cast<std::int16_t>(leds.cycle - given) > 0;
        demand(received == 0 || is_ahead || camera.late.last() - late >= 5 ||
               camera.received.last() - received > 1);
        received = camera.received.last(), late = camera.late.last(), given = leds.cycle;
    }
    void take(std::uint8_t what, Script& script) {
        switch (what >> 4 & 7) {
        case 0: tell(twin, packet(++exposure)); break;
        case 1:
            tell(twin, packet(exposure = static_cast<std::uint16_t>(number_of(script))));
            break; // restarts
        case 2: tell(twin, last); break;
        case 3: tell(twin, bytes_of(script, what & 0xF)); break;
        case 4: { // another content
            auto changed = packet(++exposure);
            const Bytes place = bytes_of(script, 1), by = bytes_of(script, 8);
            for (std::size_t i = 0; i < by.size(); ++i)
                changed[(std::to_integer<std::size_t>(place[0]) + i) % changed.size()] = by[i];
            tell(twin, changed);
            break;
        }
        case 5: tell(twin, std::array<std::byte, udp::most_bytes>{}); break;
        default: step(Duration{1ms} * (1 << (what & 0xF)));
        }
        if ((what & 0x80) != 0) step();
    }
    void come_back() {
        for (int steps = 0; steps < 32; ++steps) step(); // reads all waiting packets, also an empty one
        demand(camera.received.last() + camera.late.last() + camera.invalid.last() == arrived);
        for (int exposures = 0; exposures < 60; ++exposures) {
            const std::int64_t before = camera.received.last();
            tell(twin, packet(++exposure));
            for (int steps = 0; steps < 2; ++steps) step(10ms);
            demand(exposures < 10 || camera.received.last() == before + 1);
        }
        const BodyFrame& frame = body.model.last().frame;
        demand(body.good.last() && (frame.position - Eigen::Vector3d{1, 0, 0}).norm() < 1e-3);
        demand((frame.rotation - Eigen::Matrix3d::Identity()).norm() < 1e-3);
    }
};

} // namespace tappet::fuzz
