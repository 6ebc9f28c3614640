// The frames that a machine sends on a simulated bus: its outputs at the wire, and the rules for them.
#pragma once

#include "drivers/can/signal_map.hpp"
#include "drivers/twin/simulated_outputs.hpp"

#include <string_view>
#include <vector>

namespace tappet::can {

/// Not real-time; only the plant's thread.
class SentFrames {
public:
    SentFrames() = default;
    SentFrames(std::string_view bus, const Identifiers& map);

    /// Returns the outputs; each reads the last frame here.
    [[nodiscard]] std::vector<WireOutput> outputs() const;
    /// Stores the frame and judges it: numbers, within the range of the map.
    void hear(const Frame& frame);
    /// Returns what was wrong with a frame; empty: nothing.
    [[nodiscard]] const Sentence& fault() const noexcept { return fault_; }

private:
    struct Sent {
        const FrameRow* row = nullptr;
        std::optional<Frame> last{};
    };
    [[nodiscard]] std::span<const Signal> signals_of(const FrameRow& row) const {
        return map_->signals.subspan(row.first, row.values);
    }
    [[nodiscard]] bool is_in(const FrameRow& row, const Signal& signal, const Frame& frame) const;
    [[nodiscard]] std::optional<std::uint64_t> read(const Sent& sent, const Signal& signal, Time now) const;
    void judge(const FrameRow& row, const Signal& signal, const Frame& frame);

    std::string_view bus_{};
    const Identifiers* map_ = nullptr;
    std::vector<Sent> sent_{};
    Sentence fault_{};
};

} // namespace tappet::can
