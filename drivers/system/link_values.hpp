// The values of a node's end of the wire: from its inputs into frames, and from frames to its outputs, with
// their time stamps.
#pragma once

#include "drivers/can/frame.hpp"
#include "drivers/system/node_rows.hpp"

namespace tappet::systems {

/// The value transfer of a Link. All real-time, in its activity.
template <class Link>
struct LinkValues {
    using Rows = typename Link::Rows;

    static void take(Link& link, std::size_t f, const can::Frame& frame) noexcept TAPPET_REALTIME {
        for (std::size_t p = 0; p < Rows::port_count; ++p) {
            const PortPlace& port = Rows::ports[p];
            if (port.is_input || port.frame != f || !link.state_[port.row].agreed) continue;
            if (port.bit + port.value.bits_in_frame() > 8u * frame.length) continue;
            void* const output = link.storage_.data() + port.at;
            std::array<std::byte, 56> value{};
            const bool is_valid = on_wire::take_bits(frame.data, port.bit, 1) != 0 &&
                                  on_wire::hear(frame.data, port.bit + 1u, port.value, value.data());
            bool& was_valid = link.state_[port.row].was_valid;
            if (!is_valid && (!was_valid || port.max_age == Duration::zero())) continue;
            Duration age = is_valid ? Duration::zero() : port.max_age + 1ns;
            if (is_valid && port.value.has_time && !has_age(link, port, frame, age)) continue;
            if (!is_valid) // a value that was old when sent is old here, too
                static_cast<void>(port.facet->port->read(output, false, false, value.data()));
            port.facet->port->write_at(output, value.data(), frame.stamp - age);
            was_valid = is_valid;
        }
    }
    static void tell(Link& link, std::size_t f, std::span<std::uint8_t> payload) noexcept TAPPET_REALTIME {
        for (std::size_t p = 0; p < Rows::port_count; ++p) {
            const PortPlace& port = Rows::ports[p];
            if (!port.is_input || port.frame != f) continue;
            std::byte* const input = link.storage_.data() + port.at;
            std::array<std::byte, 56> value{};
            const Flow flow = port.facet->port->read(input, true, false, value.data());
            const on_wire::Told told = on_wire::tell(value.data(), port.value, payload, port.bit + 1u);
            if (told != on_wire::Told::well) link.beyond.write(++link.beyond_);
            bool is_valid = (flow == Flow::fresh || flow == Flow::old) && told != on_wire::Told::no_number;
            if (port.value.has_time) {
                is_valid = is_valid && knows_common(link);
                on_wire::put_bits(
                    payload, time_bit(port), time_bits,
                    on_wire::tell_time(common(link, *port.facet->port->places(input, true).stamp)));
            }
            on_wire::put_bits(payload, port.bit, 1, is_valid ? 1 : 0);
        }
    }

private:
    static constexpr std::size_t time_bit(const PortPlace& port) noexcept TAPPET_REALTIME {
        return port.bit + 1u + port.value.bits;
    }
    /// Computes the age of a value at the arrival of its frame. Returns false when it is unknown.
    static bool has_age(Link& link, const PortPlace& port, const can::Frame& frame, Duration& age) noexcept
        TAPPET_REALTIME {
        return knows_common(link) &&
               on_wire::age_of_time(on_wire::take_bits(frame.data, time_bit(port), time_bits),
                                    common(link, frame.stamp), 2 * Link::wire.clock.within, age);
    }
    static bool knows_common([[maybe_unused]] Link& link) noexcept TAPPET_REALTIME {
        if constexpr (Rows::is_told_time) {
            // Until the clock's node has sent its time again, the known clock is of its previous start.
            static_cast<void>(link.exchanges.get());
            return link.knows_time.get() && link.exchanges.stamp() > link.peers_[Rows::teller].begun;
        }
        return true;
    }
    static Time common([[maybe_unused]] Link& link, Time own) noexcept TAPPET_REALTIME {
        if constexpr (Rows::is_told_time) return own + link.ahead.get();
        return own;
    }
};

} // namespace tappet::systems
