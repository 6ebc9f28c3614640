// Sensor of the tool's loop: converts the packets of the 3D camera to places of LEDs at the time of their
// exposure.
#pragma once

#include "apps/two_robots/tool/leds.hpp"
#include "drivers/udp/device.hpp"
#include "kernel/component/component.hpp"

#include <algorithm>

namespace two_robots {

/// A lost packet leaves a gap; a packet that comes after a later one is dropped; both are counted. The camera
/// exposes at even intervals, so the fastest packets tell the time of all exposures: a delayed packet was not
/// exposed later. A camera that restarts begins its count anew; it is accepted when several packets in order
/// are late by the old count. Real-time.
struct LedCamera {
    static constexpr const DeviceKind& device_kind = udp::device_kind;
    static constexpr udp::Longest device_map{led_packet::most};
    static_assert(led_packet::most <= udp::most_bytes, "the twin has no room for it");

    Output<Leds> leds;
    Output<std::int64_t> received, lost, late, invalid;
    Property<Duration> latency{60ms}, period{20ms};

    Sentence configure(Setup& setup) {
        datagrams_ = setup.device<udp::Device>();
        return datagrams_ == nullptr ? setup.no_device() : Sentence{};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        has_seen_ = false;
        received.write(0);
        lost.write(0);
        late.write(0);
        invalid.write(0);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        for (int i = 0; i < most_in_a_step; ++i) {
            std::array<std::byte, led_packet::most + 1> packet;
            const std::size_t size = datagrams_->receive(packet);
            if (size == 0) return;
            take(std::span{packet}.first(std::min(size, packet.size())), cycle.now);
        }
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {}
    [[nodiscard]] bool stopped_safely() const noexcept TAPPET_REALTIME { return true; } // it drives nothing

    static constexpr auto interface() {
        return facets(output<&LedCamera::leds>("leds", "m", "at the time of their exposure"),
                      output<&LedCamera::received>("received", "", "packets"),
                      output<&LedCamera::lost>("lost", "", "packets that never came, or came too late"),
                      output<&LedCamera::late>("late", "", "packets that came after a later one"),
                      output<&LedCamera::invalid>("invalid", "", "datagrams that are no measurement"),
                      property<&LedCamera::latency>("latency", "s",
                                                    "from the exposure to the packet's arrival, at the least",
                                                    range(0.0, 0.5)),
                      property<&LedCamera::period>("period", "s", "of the exposures", range(0.001, 1.0)));
    }

private:
    static constexpr int most_in_a_step = 4;
    static constexpr int held_up = 10;        ///< periods by which a packet may be delayed
    static constexpr int restarted_after = 8; ///< consecutive late packets in their order
    static constexpr Duration drift = 5us;    ///< per period: how much slower than ours its clock may run

    void take(std::span<const std::byte> packet, Time now) noexcept TAPPET_REALTIME {
        Leds seen;
        if (!led_packet::read(packet, seen)) {
            invalid.write(invalid.last() + 1);
            return;
        }
        const auto ahead = static_cast<std::int16_t>(seen.cycle - cycle_);
        if (has_seen_ && ahead <= 0) {
            late.write(late.last() + 1);
            // Merely delayed packets never come in such a long consecutive order.
            late_in_order_ = seen.cycle == static_cast<std::uint16_t>(late_ + 1) ? late_in_order_ + 1 : 0;
            late_ = seen.cycle;
            if (late_in_order_ == restarted_after) has_seen_ = false;
            return;
        }
        late_in_order_ = 0;
        if (has_seen_ && ahead > 1) lost.write(lost.last() + ahead - 1);
        even_ = has_seen_
                    ? std::clamp(even_ + ahead * (period.get() + drift), now - held_up * period.get(), now)
                    : now;
        cycle_ = seen.cycle;
        has_seen_ = true;
        received.write(received.last() + 1);
        leds.write(seen, even_ - latency.get());
    }

    udp::Device* datagrams_ = nullptr;
    std::uint16_t cycle_ = 0;
    Time even_{}; ///< arrival of the last packet, had it not been delayed
    bool has_seen_ = false;
    std::uint16_t late_ = 0; ///< the last packet that came late
    int late_in_order_ = 0;
};

} // namespace two_robots
