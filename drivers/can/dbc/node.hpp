// What a machine says of its own node beside a DBC file: which one it is, and what such a file cannot say.
#pragma once

#include "drivers/can/signal_map.hpp"

namespace tappet::can {

/// As often as its file says (GenMsgCycleTime).
inline constexpr Rate as_in_file{Duration{-1}, Duration{-1}, {}};

/// receive("drive", every(2ms)): the rate where the file has no cycle time. A message that does not name this
/// node as a receiver is taken all the same, alone all of its signals, otherwise those named.
template <std::same_as<Signal>... Signals>
constexpr auto receive(std::string_view name, Rate rate, const Signals&... signals) noexcept {
    return detail::row({}, name, Direction::receive, Bytes{}, rate, signals...);
}
/// transmit("command", every(2ms), signal("speed").safe(0))
template <std::same_as<Signal>... Signals>
constexpr auto transmit(std::string_view name, Rate rate, const Signals&... signals) noexcept {
    return detail::row({}, name, Direction::transmit, Bytes{}, rate, signals...);
}
/// Likewise with the file's cycle time.
template <std::same_as<Signal>... Signals>
constexpr auto receive(std::string_view name, const Signals&... signals) noexcept {
    return receive(name, as_in_file, signals...);
}
template <std::same_as<Signal>... Signals>
constexpr auto transmit(std::string_view name, const Signals&... signals) noexcept {
    return transmit(name, as_in_file, signals...);
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

/// node("controller", rows...): sends what the file says that it sends, and receives what names it as a
/// receiver. Each message that it sends has a row, with safe values.
template <std::size_t... N>
constexpr auto node(std::string_view name, const FrameWithSignals<N>&... rows) noexcept {
    Node<sizeof...(N), (N + ... + 0)> node;
    node.name = name;
    detail::flatten(node, rows...);
    return node;
}

} // namespace tappet::can
