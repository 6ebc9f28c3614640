// Draws the tip's path above, and the events over time below.
#include "apps/two_robots/host/picture.hpp"

#include "kernel/base/text.hpp"
#include "toolchain/svg.hpp"

#include <algorithm>
#include <vector>

namespace two_robots {

namespace {

using tappet::Svg;

constexpr double left = 130.0, width = 960.0, right = width - 30.0; // px
constexpr double path_top = 60.0, path_scale = 7.5;                 // px/mm
constexpr double path_mm = 26.0;                                    // from the middle to each side
constexpr double path_size = 2 * path_mm * path_scale;
constexpr double strip_height = 90.0, row_height = 18.0;
constexpr double beside_top = path_top + path_size + 50.0;
constexpr double body_top = beside_top + strip_height + 30.0;
constexpr double states_top = body_top + strip_height + 40.0;
constexpr double most_beside_mm = 0.5, most_body_mm = 6.0;

constexpr std::string_view of_tool = "#c8202a", of_body = "#5b8def",
                           faint = "stroke=\"#000\" stroke-opacity=\"0.15\"";

struct TimeAxis {
    double end_s;
    [[nodiscard]] double x(double at_s) const { return left + at_s / end_s * (right - left); }
};

double path_x(double mm) { return left + (mm + path_mm) * path_scale; }
double path_y(double mm) { return path_top + (path_mm - mm) * path_scale; }

/// Draws a line through `place` of each moment, interrupted where it returns nothing.
template <class Place>
void draw_line(Svg& svg, std::span<const Moment> moments, std::string_view colour, Place place) {
    bool is_open = false;
    const auto close = [&] {
        if (is_open) svg.raw("\"/>\n");
        is_open = false;
    };
    for (const Moment& each : moments) {
        double x = 0.0, y = 0.0;
        if (!place(each, x, y)) {
            close();
            continue;
        }
        if (!is_open) svg.raw("<polyline fill=\"none\" stroke=\"").raw(colour).raw("\" points=\"");
        is_open = true;
        svg.number(x).raw(",").number(y).raw(" ");
    }
    close();
}

void draw_path(Svg& svg, std::span<const Moment> moments) {
    svg.rectangle(left, path_top, path_size, path_size, "fill=\"#f7f3ee\" stroke=\"#888\"");
    svg.circle(path_x(0), path_y(0), 20.0 * path_scale,
               "fill=\"none\" stroke=\"#999\" stroke-width=\"5\" stroke-opacity=\"0.4\"");
    svg.circle(path_x(0), path_y(0), 12.0 * path_scale,
               "fill=\"none\" stroke=\"#333\" stroke-dasharray=\"4 4\"");
    draw_line(svg, moments, of_tool, [](const Moment& each, double& x, double& y) {
        x = path_x(each.tip.x() * 1e3);
        y = path_y(each.tip.y() * 1e3);
        return each.is_inside;
    });
    const double x = left + path_size + 30.0;
    svg.line(x, path_top + 20, x + 30, path_top + 20,
             "stroke=\"#999\" stroke-width=\"5\" stroke-opacity=\"0.4\"");
    svg.words(x + 40, path_top + 25, "the path that was recorded, 20 mm from its middle");
    svg.line(x, path_top + 45, x + 30, path_top + 45, "stroke=\"#c8202a\"");
    svg.words(x + 40, path_top + 50, "the tip inside, as the body sees it");
    svg.line(x, path_top + 70, x + 30, path_top + 70, "stroke=\"#333\" stroke-dasharray=\"4 4\"");
    svg.words(x + 40, path_top + 75, "the hole, 150 mm above it");
}

void label(Svg& svg, double y, std::string_view text) {
    svg.words(left - 8, y, text, "text-anchor=\"end\" font-size=\"11\"");
}

void draw_strips(Svg& svg, std::span<const Moment> moments, const TimeAxis& time) {
    label(svg, beside_top + 10, "0.5 mm");
    label(svg, beside_top + strip_height, "beside the hole");
    label(svg, body_top + 10, "+6 mm");
    label(svg, body_top + strip_height / 2, "the body");
    label(svg, body_top + strip_height, "-6 mm");
    for (const double y : {beside_top + strip_height, body_top + strip_height / 2})
        svg.line(left, y, right, y, "stroke=\"#888\"");
    draw_line(svg, moments, of_tool, [&](const Moment& each, double& x, double& y) {
        x = time.x(each.at_s);
        y = beside_top + strip_height * (1.0 - std::min(1.0, each.beside_hole * 1e3 / most_beside_mm));
        return each.is_inside;
    });
    const Eigen::Vector3d rests = [&] { // centre of the breathing motion
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        int count = 0;
        for (const Moment& each : moments)
            if (each.body_robot == "Simulating") sum += each.body, ++count;
        return count > 0 ? Eigen::Vector3d{sum / count} : sum;
    }();
    for (const int axis : {1, 2})
        draw_line(svg, moments, axis == 1 ? of_body : std::string_view{"#8e5bd0"},
                  [&](const Moment& each, double& x, double& y) {
                      x = time.x(each.at_s);
                      y = body_top +
                          strip_height / 2 *
                              (1.0 - std::clamp((each.body - rests)[axis] * 1e3 / most_body_mm, -1.0, 1.0));
                      return each.body_robot == "Simulating";
                  });
}

/// Draws a row for each state that was entered.
double draw_states(Svg& svg, std::span<const Moment> moments, std::string_view Moment::* state,
                   std::string_view colour, const TimeAxis& time, double top) {
    std::vector<std::string_view> rows;
    for (std::size_t i = 0; i < moments.size();) {
        std::size_t end = i;
        while (end < moments.size() && moments[end].*state == moments[i].*state) ++end;
        auto row = std::ranges::find(rows, moments[i].*state);
        if (row == rows.end()) row = rows.insert(rows.end(), moments[i].*state);
        const double until = end < moments.size() ? moments[end].at_s : time.end_s;
        svg.rectangle(time.x(moments[i].at_s), top + static_cast<double>(row - rows.begin()) * row_height + 3,
                      std::max(1.5, time.x(until) - time.x(moments[i].at_s)), row_height - 6,
                      std::string{"fill=\""}.append(colour).append("\""));
        i = end;
    }
    for (std::size_t row = 0; row < rows.size(); ++row)
        label(svg, top + static_cast<double>(row) * row_height + 13, rows[row]);
    return top + static_cast<double>(rows.size()) * row_height + 14.0;
}

} // namespace

std::string picture_of(std::span<const Moment> moments) {
    const TimeAxis time{moments.empty() ? 1.0 : std::max(1.0, moments.back().at_s)};
    Svg states{0, 0}; // to measure their height
    const double between = draw_states(states, moments, &Moment::tool_robot, of_tool, time, states_top);
    const double bottom = draw_states(states, moments, &Moment::body_robot, of_body, time, between);
    Svg svg{width, bottom + 30.0};
    svg.words(left, 35, "A robot operates on a body that another one moves", "font-size=\"20\"");
    draw_path(svg, moments);
    draw_strips(svg, moments, time);
    static_cast<void>(draw_states(svg, moments, &Moment::tool_robot, of_tool, time, states_top));
    static_cast<void>(draw_states(svg, moments, &Moment::body_robot, of_body, time, between));
    for (double at = 0; at <= time.end_s; at += 10.0) {
        svg.line(time.x(at), beside_top, time.x(at), bottom, faint);
        svg.words(time.x(at), bottom + 14, tappet::Sentence{static_cast<int>(at), " s"}.view(),
                  "text-anchor=\"middle\" font-size=\"11\"");
    }
    return svg.take();
}

} // namespace two_robots
