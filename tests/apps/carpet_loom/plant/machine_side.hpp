// The machine's end of the loom's bus, for tests of its nodes: frames made and read by the names of its map.
#pragma once

#include "apps/carpet_loom/maps.hpp"
#include "drivers/can/signal_store.hpp"

#include <initializer_list>
#include <string_view>
#include <utility>

namespace tappet::loom {

class MachineSide {
public:
    /// Of the map's frame, with these signals of it.
    can::Frame frame(std::string_view name,
                     std::initializer_list<std::pair<std::string_view, std::int64_t>> signals) {
        const std::size_t row = map.frame(name);
        for (const auto& [signal, value] : signals)
            store_.set_bits(index(name, signal), static_cast<std::uint64_t>(value));
        return store_.encode(row, Time{});
    }
    can::Frame network(std::int64_t command, std::int64_t node) {
        return frame("nmt", {{"command", command}, {"node", node}});
    }
    /// The frame's name; empty: none of the map's.
    std::string_view take(const can::Frame& frame) {
        std::size_t row = can::no_such;
        return store_.decode(frame, row) == can::Decoded::yes ? map.frames[row].name : std::string_view{};
    }
    /// Of the frame of that name that was taken last; before factor and offset.
    [[nodiscard]] std::int64_t integer(std::string_view frame, std::string_view signal) const {
        return store_.integer(index(frame, signal));
    }
    [[nodiscard]] double get(std::string_view frame, std::string_view signal) const {
        return store_.physical(index(frame, signal));
    }

private:
    static constexpr const auto& map = carpet::can_signals;
    static std::size_t index(std::string_view frame, std::string_view signal) {
        return map.signal(Sentence{frame, ".", signal}.view());
    }
    can::SignalStore<carpet::can_signals.frames.size(), carpet::can_signals.signals.size()> store_{map};
};

/// What a drive's emergency message says; the machine's map has none of it.
struct Emergency {
    std::int64_t code = 0, error_register = 0;
    bool operator==(const Emergency&) const = default;
};
inline Emergency emergency_of(const can::Frame& frame) {
    return {frame.data[0] | frame.data[1] << 8, frame.data[2]};
}

} // namespace tappet::loom
