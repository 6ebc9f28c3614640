// A machine's rows about its own node next to a DBC file: its name, and facts that such a file cannot state.
#pragma once

#include "drivers/can/signal_map.hpp"

namespace tappet::can {

/// The rate of the file (GenMsgCycleTime).
inline constexpr Rate as_in_file{Duration{-1}, Duration{-1}, {}};

/// receive("drive", every(2ms)): states the rate where the file has no cycle time, or says that the message
/// is sent on demand too. The message is received whether or not it names this node as a receiver: with all
/// of its signals if no signals are given, otherwise only with those and their multiplexors.
template <std::same_as<Signal>... Signals>
constexpr auto receive(std::string_view name, Rate rate, const Signals&... signals) noexcept {
    return detail::row({}, name, Direction::receive, Bytes{}, rate, signals...);
}
/// transmit("command", every(2ms), signal("speed").safe(0))
template <std::same_as<Signal>... Signals>
constexpr auto transmit(std::string_view name, Rate rate, const Signals&... signals) noexcept {
    return detail::row({}, name, Direction::transmit, Bytes{}, rate, signals...);
}
/// The same with the file's cycle time.
template <std::same_as<Signal>... Signals>
constexpr auto receive(std::string_view name, const Signals&... signals) noexcept {
    return receive(name, as_in_file, signals...);
}
template <std::same_as<Signal>... Signals>
constexpr auto transmit(std::string_view name, const Signals&... signals) noexcept {
    return transmit(name, as_in_file, signals...);
}

/// without("diagnosis"): the node neither sends nor receives this message, whatever the file says.
constexpr auto without(std::string_view name) noexcept {
    return detail::row({}, name, Direction::passing, Bytes{}, as_in_file);
}

/// A signal that is wrong in the file: place, sign, scale and range are as written here,
/// despite(signal("load", 24, 16).times(0.1)). So is its multiplexor, if .when(..) names one.
constexpr Signal despite(const Signal& signal) noexcept {
    return copy_with(signal, &Signal::despite_file, true);
}
/// A message whose identifier is wrong in the file: despite(extended(0x18FEF101), receive("engine")).
template <std::size_t N>
constexpr auto despite(Identifier identifier, FrameWithSignals<N> message) noexcept {
    message.row.identifier = identifier;
    message.row.despite_file = message.row.despite_identifier = true;
    return message;
}
/// A message whose length or format is wrong in the file: despite(fd_bytes(16), receive("scan")).
template <std::size_t N> constexpr auto despite(Bytes length, FrameWithSignals<N> message) noexcept {
    message.row.length = length.count;
    message.row.format = length.format;
    message.row.despite_file = true;
    return message;
}

struct NodeView {
    std::string_view name{};
    std::span<const FrameRow> frames{};
    std::span<const Signal> signals{};
};

template <std::size_t F, std::size_t S> struct Node {
    std::string_view name{};
    std::array<FrameRow, F> frames{};
    std::array<Signal, S> signals{};

    [[nodiscard]] constexpr NodeView view() const noexcept { return {name, frames, signals}; }
};

/// node("controller", rows...): sends the messages that the file says it sends, and receives those that name
/// it as a receiver. Each message that it sends must have a row, with safe values. node("", rows...) sends
/// and receives what its rows say.
template <std::size_t... N>
constexpr auto node(std::string_view name, const FrameWithSignals<N>&... rows) noexcept {
    Node<sizeof...(N), (N + ... + 0)> node;
    node.name = name;
    flatten(node.frames, node.signals, rows...);
    return node;
}

} // namespace tappet::can
