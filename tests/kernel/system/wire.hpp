// A CAN wire as a resource of event chains: how its analysis answers for steps.
#pragma once

#include "drivers/can/bus_analysis.hpp"
#include "kernel/system/end_to_end.hpp"

namespace tappet::test {

constexpr TimeTerm term_of(can::Part part) noexcept {
    switch (part) {
    case can::Part::jitter: return TimeTerm::jitter;
    case can::Part::blocking: return TimeTerm::blocking;
    case can::Part::others: return TimeTerm::others;
    case can::Part::errors: return TimeTerm::errors;
    default: return TimeTerm::own;
    }
}

/// Each step is of another node than this machine, which sends its most urgent frame first.
constexpr void analyse_wire(std::span<const TaskTiming> by_rank, std::span<ChainStepResponse> into,
                            std::int64_t bit_ns) noexcept {
    std::array<can::FrameTiming, can::BusAnalysis::most_frames> frames{};
    for (std::size_t i = 0; i < by_rank.size() && i < frames.size(); ++i)
        frames[i] = {.wire_ns = by_rank[i].budget_ns,
                     .period_ns = by_rank[i].period_ns,
                     .jitter_ns = by_rank[i].jitter_ns};
    const can::BusAnalysis bus{std::span{frames}.first(std::min(by_rank.size(), frames.size())),
                               {.bit_ns = bit_ns}};
    for (std::size_t i = 0; i < by_rank.size(); ++i) {
        const can::FrameResponse found = bus.of(i);
        into[i] = {found.response, term_of(found.largest), found.of, found.largest_ns};
    }
}

} // namespace tappet::test
