// Draws one row per frame: dark its time on the wire, light its longest response, a mark at its deadline.
#include "toolchain/tools/chart/bus.hpp"

#include "drivers/can/kind.hpp"
#include "kernel/machine/check/traffic.hpp"
#include "toolchain/svg.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tappet::chart {

namespace {

constexpr double left = 230, right = 300, top = 60, row_height = 24, width = 1000;

Sentence in_us(Duration time) {
    return time == Duration::max() ? Sentence{"no bound"} : Sentence{time.count() / 1000, " us"};
}

} // namespace

std::string draw_bus(const AcceptedMachine& machine, std::size_t component, std::uint32_t bit_rate,
                     std::uint32_t data_bit_rate) {
    const ComponentRow& row = machine.table.components[component];
    const auto worst =
        checks::worst_responses_ns(machine.table, *machine.board, *machine.binding, machine.index);
    const std::array rates{tappet::bit_rate(bit_rate, data_bit_rate)};
    const DeviceUse use{row.device, rates, Duration{worst[machine.index.activity[component]]}};
    std::vector<TrafficRow> frames(row.type->device_traffic.rows);
    const Sentence fault = row.type->device_traffic.analyse(use, frames);
    double load = 0;
    Duration longest{1us};
    for (const TrafficRow& frame : frames) {
        load += static_cast<double>(frame.wire_time.count()) / static_cast<double>(frame.period.count());
        longest = std::max({longest, frame.deadline, frame.worst == Duration::max() ? 0ns : frame.worst});
    }
    Svg picture{width, top + row_height * static_cast<double>(frames.size()) + 40};
    picture.words(20, 25,
                  Sentence{machine.table.name, ", \"", row.device, "\" at ", bit_rate, " bit/s: load ",
                           static_cast<std::int64_t>(load * 100 + 0.5), " %"}
                      .view(),
                  "font-size=\"16\"");
    picture.words(20, 45,
                  fault.empty() ? std::string_view{"each frame comes through in time"} : fault.view());
    // Deadlines range from hundreds of microseconds to seconds: a logarithmic scale, starting at the shortest
    // frame.
    Duration shortest = longest;
    for (const TrafficRow& frame : frames) shortest = std::min(shortest, frame.wire_time);
    const double decades = std::max(1.0, std::log10(static_cast<double>(longest.count()) /
                                                    (0.5 * static_cast<double>(shortest.count()))));
    const auto place = [&](Duration time) {
        const double ratio =
            static_cast<double>(time.count()) / (0.5 * static_cast<double>(shortest.count()));
        return left +
               (width - left - right) * std::clamp(std::log10(std::max(1.0, ratio)) / decades, 0.0, 1.0);
    };
    double y = top;
    for (const TrafficRow& frame : frames) {
        picture.words(20, y + 16, Sentence{frame.sent ? "\u2192 " : "\u2190 ", frame.name}.view());
        const bool held = frame.worst <= frame.deadline;
        const Duration shown = frame.worst == Duration::max() ? longest : frame.worst;
        picture.rectangle(left, y + 5, place(shown) - left, 14,
                          held ? "fill=\"#9ec5e8\"" : "fill=\"#e8a09e\"");
        picture.rectangle(left, y + 5, place(frame.wire_time) - left, 14, "fill=\"#1f5f99\"");
        picture.line(place(frame.deadline), y + 2, place(frame.deadline), y + 22,
                     "stroke=\"#222\" stroke-width=\"2\"");
        picture.words(
            width - right + 15, y + 16,
            Sentence{in_us(frame.worst), " of ", in_us(frame.deadline), ", each ", in_us(frame.period)}
                .view());
        y += row_height;
    }
    picture.words(left, y + 22,
                  "dark: on the wire; light: the longest response; mark: deadline; logarithmic");
    return picture.take();
}

} // namespace tappet::chart
