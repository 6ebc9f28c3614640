// Checks whether a bus can carry its map at its bit rate and with its send queue: the message of the table's
// check, and the rows of charts and summaries.
#pragma once

#include "drivers/can/bus_analysis.hpp"
#include "drivers/can/frame_time.hpp"
#include "drivers/can/kind.hpp"
#include "drivers/can/signal_map.hpp"
#include "drivers/can/transmitter.hpp"
#include "kernel/component/device_traffic.hpp"

namespace tappet::can {

namespace detail {

constexpr Sentence us(std::int64_t ns) { return Sentence{ns / 1000, " us"}; }

constexpr Sentence largest_part(const FrameResponse& found, std::string_view of, std::uint32_t bit_rate) {
    const Sentence most{"the largest part, ", us(found.largest_ns), ", "};
    switch (found.largest) {
    case Part::jitter:
        return Sentence{most, "is how late it may enter its queue; shorten the response of the activity that "
                              "drives the bus, or the jitter in its every(...)"};
    case Part::own_time:
        return Sentence{most, "is its own time on the wire; lengthen its period, or run the bus faster than ",
                        bit_rate, " bit/s"};
    case Part::blocking:
        return Sentence{most, "is \"", of,
                        "\", which may just have begun; shorten that, or lengthen the period"};
    case Part::in_flight:
        return Sentence{
            most,
            "is caused by less urgent frames of this machine that the controller holds already; shorten "
            "those, or lengthen the period"};
    case Part::handing_over:
        return Sentence{most, "is the time until the next frames follow those in flight; shorten the "
                              "response of the activity that drives the bus"};
    case Part::others:
        return Sentence{most, "is \"", of,
                        "\", which wins the bus before it; send that less often, or give this "
                        "one a lower identifier"};
    case Part::errors:
        return Sentence{most, "is caused by errors on the wire; lengthen the period, or state fewer errors "
                              "with bus_errors(...) of the board's device"};
    }
    return {};
}

/// Returns the message about a frame that may be late. `of`: its largest delay.
constexpr Sentence late_fault(const FrameRow& row, const FrameResponse& found, std::string_view of,
                              std::int64_t deadline_ns, std::int64_t load_ppm, std::uint32_t bit_rate) {
    if (!found.response.bounded && found.largest_ns > 0)
        return Sentence("frame \"", row.name, "\" may still wait when the next one follows, ",
                        us(row.apart.count()), " later; ", largest_part(found, of, bit_rate));
    if (!found.response.bounded)
        return Sentence("frame \"", row.name,
                        "\" may never be sent: it and more urgent frames fill the bus, which all frames "
                        "together load by ",
                        load_ppm / 10'000, " % at ", bit_rate,
                        " bit/s; send less often, or run the bus faster");
    return Sentence("frame \"", row.name, "\" may take ", us(found.response.worst_ns), " but is due within ",
                    us(deadline_ns), "; ", largest_part(found, of, bit_rate));
}

} // namespace detail

/// The bit rates that frames of a bus were proven for; 0: any. Empty: those of the bus.
struct ProvenRates {
    std::uint32_t nominal = 0, data = 0;
};
constexpr Sentence bit_rate_fault(const ProvenRates& proven, const BusFacts& bus) {
    if (proven.nominal != 0 && proven.nominal != bus.bit_rate)
        return Sentence{"it runs at ", bus.bit_rate, " bit/s, but its wire was checked for ", proven.nominal,
                        "; correct one of them"};
    if (proven.data != 0 && proven.data != bus.data_bit_rate)
        return Sentence("its data phase runs at ", bus.data_bit_rate, " bit/s, but its wire was checked for ",
                        proven.data, "; write bit_rate(", proven.nominal, ", ", proven.data,
                        ") at the device, or correct the wire");
    return {};
}

/// Analyses the frames of a map without a fault, and the others on its bus. `response`: that of the activity
/// that drives the bus.
template <std::size_t F>
constexpr Sentence bus_traffic(const std::array<FrameRow, F>& crossing, const BusFacts& bus,
                               Duration response, std::span<TrafficRow> rows) {
    if (F > BusAnalysis::most_frames)
        return Sentence{"its map has ", F, " frames, more than ", BusAnalysis::most_frames,
                        " that the analysis takes; make it two buses"};
    for (const FrameRow& row : crossing)
        if (row.format != Format::classical && bus.data_bit_rate == 0)
            return Sentence{
                "frame \"", row.name,
                "\" is CAN FD, but the board states no bit rate for CAN FD's data phase; add it to the "
                "device's row, bit_rate(",
                bus.bit_rate, ", 2'000'000), or make the frame a classical one, bytes(8)"};
    constexpr Settings sending;
    std::array<std::size_t, F> by_rank{};
    std::array<FrameTiming, F> frames{};
    const auto rank = [&](std::size_t f) {
        return arbitration(
            Frame{.id = crossing[f].identifier.id, .extended = crossing[f].identifier.extended});
    };
    for (std::size_t f = 0; f < F; ++f) by_rank[f] = f;
    std::ranges::sort(by_rank, {}, rank);
    std::int64_t load_ppm = 0;
    for (std::size_t i = 0; i < F; ++i) {
        const FrameRow& row = crossing[by_rank[i]];
        const bool own = row.direction == Direction::transmit;
        const std::int64_t apart = row.apart.count();
        frames[i] = {
            frame_time_ns(row.format, row.identifier.extended, row.length, {bus.bit_rate, bus.data_bit_rate}),
            apart,
            own ? response.count() : row.jitter.count(),
            own ? std::min(apart, sending.max_age.count()) : apart,
            own,
            own && row.every > Duration::zero()};
        load_ppm += frames[i].wire_ns * 1'000'000 / apart;
    }
    Duration shortest_sent = Duration::max();
    for (const FrameTiming& frame : frames)
        if (frame.own) shortest_sent = std::min(shortest_sent, Duration{frame.wire_ns});
    const BusAnalysis analysis{frames,
                               {(1'000'000'000 + bus.bit_rate - 1) / bus.bit_rate,
                                frames_in_flight(response, shortest_sent), response.count(), bus.errors,
                                bus.errors_every.count()}};
    Sentence fault;
    for (std::size_t i = 0; i < F; ++i) {
        const FrameRow& row = crossing[by_rank[i]];
        const FrameResponse found = analysis.of(i);
        if (i < rows.size())
            rows[i] = {row.name,
                       frames[i].own,
                       row.apart,
                       Duration{frames[i].wire_ns},
                       Duration{frames[i].deadline_ns},
                       found.response.bounded ? Duration{found.response.worst_ns} : Duration::max()};
        if (!fault.empty() || found.response.within(frames[i].deadline_ns)) continue;
        if (row.is_proven && found.response.bounded) continue;
        fault = detail::late_fault(row, found, crossing[by_rank[found.of]].name, frames[i].deadline_ns,
                                   load_ppm, bus.bit_rate);
    }
    return fault;
}

} // namespace tappet::can
