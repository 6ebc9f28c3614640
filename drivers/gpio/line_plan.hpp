// Derived from the list of lines in both worlds: masks, safe values, and whether the list is valid.
#pragma once

#include "drivers/gpio/device.hpp"
#include "kernel/base/text.hpp"

#include <array>
#include <expected>

namespace tappet::gpio {

/// The lines of one chip as they are requested; they must not move while the chip is open.
using PlacedLines = std::array<Line, most_lines>;

struct LinePlan {
    Mask outputs = 0;
    Mask safe = 0;
};

/// Derives the plan. Not real-time. The error names the line and the cure.
constexpr std::expected<LinePlan, Sentence> plan(const Settings& settings) {
    const Sentence who{"GPIO chip \"", settings.chip, "\""};
    if (settings.lines.size() < 2)
        return std::unexpected{
            Sentence{who, ": fewer than two lines are requested, and lost edges of a single line are "
                          "invisible; add another line, used or not"}};
    if (settings.lines.size() > most_lines)
        return std::unexpected{
            Sentence{who, ": ", settings.lines.size(),
                     " lines are requested, but one request holds 64; use a second device"}};
    LinePlan result;
    for (std::size_t i = 0; i < settings.lines.size(); ++i) {
        const Line& line = settings.lines[i];
        for (std::size_t other = 0; other < i; ++other)
            if (settings.lines[other].offset == line.offset)
                return std::unexpected{Sentence{who, ": lines \"", settings.lines[other].name, "\" and \"",
                                                line.name, "\" are both line ", line.offset,
                                                "; correct the board"}};
        if (line.debounce < 0ns || line.debounce > 1s)
            return std::unexpected{Sentence{who, ": line \"", line.name, "\" is to be debounced for ",
                                            line.debounce.count() / 1000, " us; choose 0 to 1000000"}};
        if (line.role == Role::output) {
            result.outputs |= Mask{1} << i;
            if (line.safe_value) result.safe |= Mask{1} << i;
        }
    }
    return result;
}

/// Finds lost edges by the sequence numbers of the delivered ones: the kernel counts every interrupt of the
/// request.
class EdgeSequence {
public:
    /// Returns the number of edges lost before this one. Real-time.
    constexpr std::uint32_t missed_before(std::uint32_t seqno) noexcept TAPPET_REALTIME {
        const std::uint32_t missed = seqno - last_ - 1; // wraps like the kernel's own count
        last_ = seqno;
        return missed;
    }

private:
    std::uint32_t last_ = 0; // the first edge of a request is number 1
};

/// Common part of real and simulated lines: safe values and edge counting.
class PlannedLines : public Device {
public:
    bool make_safe() noexcept TAPPET_REALTIME final { return write(plan_.outputs, plan_.safe); }
    [[nodiscard]] Counters counters() const noexcept TAPPET_REALTIME final { return count_; }

protected:
    /// Counts these edges, read oldest first, and the lost ones between them.
    EdgeBatch judge(std::span<Edge> edges) noexcept TAPPET_REALTIME {
        EdgeBatch batch{.count = edges.size()};
        for (Edge& edge : edges) {
            edge.missed = sequence_.missed_before(edge.seqno);
            batch.gap.missed += edge.missed;
        }
        count_.edges += batch.count;
        if (batch.gap.missed == 0) return batch;
        ++count_.gaps;
        count_.missed += batch.gap.missed;
        const Levels now = levels();
        batch.gap.levels_known = now.known;
        batch.gap.levels = now.mask;
        return batch;
    }

    LinePlan plan_{};
    EdgeSequence sequence_{};
    Counters count_{};
};

} // namespace tappet::gpio
