// A bus's signals as the nodes see them, by the names of the machine's map: they send what the machine
// receives.
#pragma once

#include "drivers/can/signal_store.hpp"
#include "drivers/twin/far_end.hpp"
#include "kernel/base/array_of.hpp"

#include <cstdint>
#include <utility>

namespace tappet::can {

/// Returns a machine's map from the nodes' side. The signals they send have no range, because a node may send
/// values that its description forbids.
template <std::size_t F, std::size_t S>
constexpr SignalMap<F, S> seen_from_the_nodes(SignalMap<F, S> map) noexcept {
    for (FrameRow& row : map.frames)
        row.direction = row.direction == Direction::receive ? Direction::transmit : Direction::receive;
    for (Signal& each : map.signals) each.has_range = false;
    std::swap(map.received, map.transmitted);
    std::swap(map.received_count, map.transmitted_count);
    return map;
}

/// The values of the nodes' signals without a wire, for nodes that send and receive frames themselves. The
/// compiler checks the names. Real-time; real-time code must have the names as constants outside of its
/// functions.
template <const auto& map>
class NodeSignals {
    TAPPET_ACCEPTED(map.fault);

protected:
    static constexpr auto nodes = seen_from_the_nodes(map);

    template <Direction direction>
    static constexpr auto frame_names = array_of<nodes.frames.size()>([](std::size_t f) {
        return nodes.frames[f].direction == direction ? MapName{{}, nodes.frames[f].name} : MapName{};
    });
    template <Direction direction>
    static constexpr auto signal_names = array_of<nodes.signals.size()>([](std::size_t s) {
        return nodes.frames[nodes.row_of[s]].direction == direction ? nodes.name_of(s) : MapName{};
    });

public:
    using Received = FarEndName<frame_names<Direction::receive>>;
    using Sent = FarEndName<frame_names<Direction::transmit>>;
    using ReceivedSignal = FarEndName<signal_names<Direction::receive>>;
    using SentSignal = FarEndName<signal_names<Direction::transmit>>;

    [[nodiscard]] double get(ReceivedSignal signal) const noexcept TAPPET_REALTIME {
        return store_.physical(signal.index);
    }
    /// Returns the value before factor and offset: a set of bits, or a counter.
    [[nodiscard]] std::int64_t integer(ReceivedSignal signal) const noexcept TAPPET_REALTIME {
        return store_.integer(signal.index);
    }
    void set(SentSignal signal, double value) noexcept TAPPET_REALTIME {
        store_.set_physical(signal.index, value);
    }
    void set_integer(SentSignal signal, std::uint64_t bits) noexcept TAPPET_REALTIME {
        store_.set_bits(signal.index, bits);
    }
    /// Returns the frame with the present values; `at` becomes its stamp.
    [[nodiscard]] Frame encode(Sent frame, Time at) const noexcept TAPPET_REALTIME {
        return store_.encode(frame.index, at);
    }
    /// Takes the values of a frame from the machine, all or none; `which` becomes its row.
    [[nodiscard]] Decoded decode(const Frame& frame, std::size_t& which) noexcept TAPPET_REALTIME {
        return store_.decode(frame, which);
    }

protected:
    SignalStore<nodes.frames.size(), nodes.signals.size()> store_{nodes};
};

} // namespace tappet::can
