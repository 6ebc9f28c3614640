// Checks that all frames of a system cross its CAN wire in time: each is analysed with the real send queue of
// its own node, and frames of other nodes with the delay that their own queues allow.
#pragma once

#include "drivers/can/bus_analysis.hpp"
#include "drivers/can/frame_time.hpp"
#include "drivers/can/transmitter.hpp"
#include "kernel/system/plan.hpp"

namespace tappet::systems {

/// Returns the format; the clock is sent in classical frames on every wire.
constexpr can::Format format_of(const WireRow& wire, const WireFrame& frame) noexcept TAPPET_REALTIME {
    return wire.is_fd() && !frame.is_of_clock() ? can::Format::flexible_faster : can::Format::classical;
}
constexpr can::Identifier identifier_of(const WireRow& wire, const WireFrame& frame) noexcept
    TAPPET_REALTIME {
    return {frame.id, wire.fixed_identifiers};
}

/// Implements WireAnalysis for CAN.
constexpr std::size_t analyse_can(const SystemView& s, std::span<WireFrame> frames) {
    constexpr std::size_t most = can::BusAnalysis::most_frames;
    if (frames.size() > most) return 0;
    std::array<can::FrameTiming, most> timing{};
    std::array<std::int64_t, most> late{}; // delay behind less urgent frames of its own node in flight
    const std::uint32_t rate = s.wire.rate.bits_per_second;
    std::array<std::int64_t, most> brought{}; // of an answer: the jitter of its request
    std::array<std::size_t, most> answers{};
    for (std::size_t f = 0; f < frames.size(); ++f) {
        answers[f] = frames.size();
        for (std::size_t m = 0; m < frames.size(); ++m)
            if (frames[m].crossing == frames[f].crossing &&
                ((frames[f].kind == WireFrameKind::answer && frames[m].kind == WireFrameKind::message) ||
                 (frames[f].kind == WireFrameKind::received && frames[m].kind == WireFrameKind::reply) ||
                 (frames[f].kind == WireFrameKind::follow_up && frames[m].kind == WireFrameKind::sync)))
                answers[f] = m;
        frames[f].bytes = static_cast<std::uint8_t>(can::padded_length((frames[f].bits + 7u) / 8u));
        timing[f].wire_ns = can::frame_time_ns(format_of(s.wire, frames[f]), s.wire.fixed_identifiers,
                                               frames[f].bytes, {rate, s.wire.rate.in_data_phase});
        frames[f].on_wire = Duration{timing[f].wire_ns};
        timing[f].period_ns = frames[f].apart.count();
        timing[f].deadline_ns = frames[f].deadline.count();
    }
    const std::int64_t served = s.wire.service.deadline.count();
    // A frame's delay at one node adds to its jitter for the others; repeat until nothing grows.
    for (bool again = true; again;) {
        again = false;
        for (std::size_t n = 0; n < s.nodes.size(); ++n) {
            std::int64_t shortest = std::numeric_limits<std::int64_t>::max();
            for (std::size_t f = 0; f < frames.size(); ++f) {
                timing[f].own = frames[f].node == n;
                timing[f].jitter_ns = served + brought[f] + (timing[f].own ? 0 : late[f]);
                if (timing[f].own) shortest = std::min(shortest, timing[f].wire_ns);
            }
            const can::BusAnalysis bus{std::span{timing}.first(frames.size()),
                                       {(1'000'000'000 + rate - 1) / rate,
                                        can::frames_in_flight(s.wire.service.deadline, Duration{shortest}),
                                        served, s.wire.errors.at_once, s.wire.errors.every.count()}};
            for (std::size_t f = 0; f < frames.size(); ++f) {
                if (!timing[f].own) continue;
                const can::FrameResponse found = bus.of(f);
                // Measured from its own release; an answer is released when its request ends.
                frames[f].worst =
                    found.response.bounded ? Duration{found.response.worst_ns - brought[f]} : Duration::max();
                if (!found.response.bounded) return f;
                for (std::size_t k = 0; k < frames.size(); ++k)
                    if (answers[k] == f)
                        if (const std::int64_t ns = found.response.worst_ns - timing[f].wire_ns;
                            ns > brought[k])
                            brought[k] = ns, again = true;
                if (const std::int64_t behind = bus.late_ns(f); behind > late[f])
                    late[f] = behind, again = true;
            }
        }
    }
    for (std::size_t f = 0; f < frames.size(); ++f)
        frames[f].jitter = Duration{served + brought[f] + late[f]};
    for (std::size_t f = 0; f < frames.size(); ++f)
        if (frames[f].worst > frames[f].deadline) return f;
    return frames.size();
}

} // namespace tappet::systems
