// Sensor of the tool's loop: the packets of the 3D camera become places of LEDs at the time of their
// exposure.
#pragma once

#include "apps/two_robots/tool/leds.hpp"
#include "kernel/component/component.hpp"

namespace two_robots {

/// Where datagrams come in. Real-time, from one activity.
class Datagrams {
public:
    virtual ~Datagrams() = default;
    /// The next one; nothing: none is there. What is longer than `into` is cut, and then has its size.
    virtual std::size_t receive(std::span<std::byte> into) noexcept TAPPET_REALTIME = 0;

protected:
    Datagrams() = default;
    Datagrams(const Datagrams&) = default;
    Datagrams& operator=(const Datagrams&) = default;
};

/// Packets that are lost leave a gap, those that come after a later one are left out; both are counted.
/// Real-time.
struct LedCamera {
    static constexpr std::string_view device_kind = "led-camera";

    Output<Leds> leds;
    Output<std::int64_t> received, lost, late, invalid;
    Property<Duration> latency{60ms};

    Sentence configure(Setup& setup) {
        datagrams_ = setup.device<Datagrams>();
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
            take(std::span{packet}.first(size), cycle.now);
        }
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {}

    static constexpr auto interface() {
        return facets(output<&LedCamera::leds>("leds", "m", "at the time of their exposure"),
                      output<&LedCamera::received>("received", "", "packets"),
                      output<&LedCamera::lost>("lost", "", "packets that never came, or came too late"),
                      output<&LedCamera::late>("late", "", "packets that came after a later one"),
                      output<&LedCamera::invalid>("invalid", "", "datagrams that are no measurement"),
                      property<&LedCamera::latency>(
                          "latency", "s", "from the exposure to the packet's arrival", range(0.0, 0.5)));
    }

private:
    static constexpr int most_in_a_step = 4;

    void take(std::span<const std::byte> packet, Time now) noexcept TAPPET_REALTIME {
        Leds seen;
        if (!led_packet::read(packet, seen)) {
            invalid.write(invalid.last() + 1);
            return;
        }
        const auto ahead = static_cast<std::int16_t>(seen.cycle - cycle_);
        if (has_seen_ && ahead <= 0) {
            late.write(late.last() + 1);
            return;
        }
        if (has_seen_ && ahead > 1) lost.write(lost.last() + ahead - 1);
        cycle_ = seen.cycle;
        has_seen_ = true;
        received.write(received.last() + 1);
        leds.write(seen, now - latency.get());
    }

    Datagrams* datagrams_ = nullptr;
    std::uint16_t cycle_ = 0;
    bool has_seen_ = false;
};

} // namespace two_robots
