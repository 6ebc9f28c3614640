// The loom's end of the CAN bus: the frames of its nodes, in the order in which they are due.
#pragma once

#include "apps/carpet_loom/plant/outbox.hpp"
#include "drivers/canopen/simulated_node.hpp"
#include "kernel/base/digest.hpp"

#include <array>
#include <cstdint>
#include <cstring>

namespace tappet::loom {

/// Keeps a digest of every frame sent, fetched or not. A frame's time stamp is when its node requests the
/// bus.
class Wire final : public Outbox<can::Frame, 256>, public canopen::FrameSink {
public:
    void send(const can::Frame& frame) noexcept TAPPET_REALTIME override {
        note(frame, frame.stamp, log_);
        push(frame);
    }
    [[nodiscard]] const Digest& log() const noexcept TAPPET_REALTIME { return log_; }

    /// Adds a frame of either direction to the digest.
    static void note(const can::Frame& frame, Time at, Digest& log) noexcept TAPPET_REALTIME {
        log.add(to_ns(at));
        log.add((std::uint64_t{frame.id} << 8) | frame.length);
        std::array<std::uint64_t, sizeof(frame.data) / sizeof(std::uint64_t)> words{};
        std::memcpy(words.data(), frame.data.data(), sizeof frame.data);
        for (std::size_t i = 0; i == 0 || 8 * i < frame.length; ++i) log.add(words[i]);
    }

private:
    Digest log_;
};

} // namespace tappet::loom
