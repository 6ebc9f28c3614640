// Draws the boards of a run over time and along the lane, the stations' work, and the silent machines.
#include "apps/woodworking_lane/host/lane_run.hpp"
#include "toolchain/svg.hpp"

namespace woodworking {

namespace {

constexpr double left = 90, top = 50, width = 1100, height = 620, right = width - 30; // px
constexpr std::size_t points_apart = 15;                                              // between drawn moments
constexpr std::array<std::string_view, 6> colours{"#5b8def", "#c8202a", "#2e8b57",
                                                  "#b8860b", "#8a2be2", "#444"};

} // namespace

std::string picture_of(const LaneRun& run) {
    Svg svg{width, top + height + 60};
    if (run.moments.empty()) return svg.take();
    const double begin_s = run.moments.front().at_s, end_s = run.moments.back().at_s;
    const auto x = [&](double at_s) { return left + (at_s - begin_s) / (end_s - begin_s) * (right - left); };
    const auto y = [](double mm) { return top + height - mm / Hall::end * height; };
    svg.words(
        left, 25,
        "The lane: boards over time (s) and position (m); bars: a station works; grey: a node is silent");
    for (int metres = 0; metres <= 90; metres += 10) {
        svg.line(left, y(metres * 1000.0), right, y(metres * 1000.0),
                 "stroke=\"#000\" stroke-opacity=\"0.08\"");
        svg.words(left - 40, y(metres * 1000.0) + 4, Sentence{metres, " m"}.view());
    }
    for (int s = static_cast<int>(begin_s) / 10 * 10; s <= static_cast<int>(end_s); s += 10)
        if (s >= begin_s) svg.words(x(s), top + height + 20, Sentence{s}.view());
    constexpr std::array<std::string_view, node_count> names{"conveyor", "saw", "drill", "polish", "glue"};
    for (std::size_t n = 0; n < node_count; ++n) {
        const double row = n == 0 ? y(0) : y(stands_at(static_cast<int>(n) - 1));
        svg.words(8, row + 18, names[n], "fill=\"#666\"");
        const auto bars = [&](double half, std::string_view style, auto is_so) {
            for (std::size_t m = 0; m < run.moments.size(); ++m) {
                const std::size_t first = m;
                while (m < run.moments.size() && is_so(run.moments[m])) ++m;
                if (m > first)
                    svg.rectangle(x(run.moments[first].at_s), row - half,
                                  x(run.moments[m - 1].at_s) - x(run.moments[first].at_s) + 0.5, 2 * half,
                                  style);
            }
        };
        bars(9, "fill=\"#999\" fill-opacity=\"0.5\"", [&](const Moment& each) { return !each.alive[n]; });
        if (n > 0) bars(6, "fill=\"#f0a030\"", [&](const Moment& each) { return each.tools[n - 1]; });
    }
    for (std::size_t b = 0; b < run.hall.boards.size(); ++b) {
        const Workpiece& board = run.hall.boards[b];
        svg.raw("<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"")
            .raw(colours[b % colours.size()])
            .raw("\" points=\"");
        for (std::size_t m = 0; m < run.moments.size(); m += points_apart) {
            const double at = run.moments[m].gone - board.laid_at;
            if (at >= 0 && at <= Hall::end)
                svg.number(x(run.moments[m].at_s)).raw(",").number(y(at)).raw(" ");
        }
        svg.raw("\"/>\n");
    }
    return svg.take();
}

} // namespace woodworking
