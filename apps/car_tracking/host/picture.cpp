// Writes the picture as SVG: lines, circles and characters only, so that any browser shows it.
#include "apps/car_tracking/host/picture.hpp"

#include "toolchain/svg.hpp"

#include <algorithm>

namespace tappet::car_tracking {

namespace {

constexpr double left = 130.0; // left edge of all drawings, px
constexpr double map_top = 60.0;
constexpr double map_scale = 190.0; // px/m
constexpr double map_far = 3.6;     // m, the map's upper edge
constexpr double map_near = -0.75;
constexpr double map_width = room::width * map_scale;
constexpr double map_bottom = map_top + (map_far - map_near) * map_scale;
constexpr double time_top = map_bottom + 50.0;
constexpr double row_height = 20.0;
constexpr double error_height = 90.0;
constexpr double worst_error_m = 0.05; // at the error strip's upper edge

struct StateColour {
    std::string_view state;
    std::string_view colour;
};
constexpr std::array<StateColour, 7> states{{{"Startup", "#9aa5b1"},
                                             {"Waiting", "#c9a227"},
                                             {"Positioning", "#5b8def"},
                                             {"Calibration", "#8e5bd0"},
                                             {"ReadyForLocalisation", "#3aa6a0"},
                                             {"LocaliseCar", "#3f9b4f"},
                                             {"Shutdown", "#444444"}}};
constexpr double error_top = time_top + static_cast<double>(states.size() + 1) * row_height + 25.0;
constexpr double height = error_top + error_height + 45.0;
constexpr double width = left + map_width + 230.0;

double map_x(double x) { return left + x * map_scale; }
double map_y(double y) { return map_top + (map_far - y) * map_scale; }

void draw_room(Svg& svg) {
    svg.rectangle(map_x(0), map_y(room::depth), map_width, room::depth * map_scale,
                  "fill=\"#f3f1ec\" stroke=\"#888\"");
    const auto& tunnel = room::tunnel;
    svg.rectangle(map_x(tunnel.left), map_y(tunnel.far), (tunnel.right - tunnel.left) * map_scale,
                  (tunnel.far - tunnel.near) * map_scale, "fill=\"#b9ac95\" fill-opacity=\"0.6\"");
    svg.words(map_x(tunnel.left) + 6, map_y(tunnel.far) + 16, "tunnel", "fill=\"#6b5f49\"");
    for (const auto& ball : room::balls)
        svg.circle(map_x(ball.x), map_y(ball.y), ball.radius * map_scale,
                   ball.colour.red > ball.colour.blue ? "fill=\"#d88\"" : "fill=\"#88d\"");
    svg.circle(map_x(room::mark.x), map_y(room::mark.y), room::mark.radius * map_scale,
               "fill=\"#fff\" stroke=\"#888\"");
    svg.words(map_x(room::mark.x) + 30, map_y(room::mark.y) + 4, "calibration mark", "fill=\"#888\"");
    const Eigen::Vector3d eye = room::eye();
    svg.circle(map_x(eye.x()), map_y(eye.y()), 7, "fill=\"#335\"");
    svg.words(map_x(eye.x()) + 12, map_y(eye.y()) + 5, "camera");
}

/// Draws a line through all moments, interrupted where `broken` returns true.
template <class Broken>
void draw_path(Svg& svg, std::span<const Moment> moments, double Moment::* x, double Moment::* y,
               std::string_view style, Broken broken) {
    bool is_open = false;
    for (std::size_t i = 0; i < moments.size(); i += 5) {
        if (broken(i)) {
            if (is_open) svg.raw("\"/>\n");
            is_open = false;
            continue;
        }
        if (!is_open) svg.raw("<polyline fill=\"none\" ").raw(style).raw(" points=\"");
        is_open = true;
        svg.number(map_x(moments[i].*x)).raw(",").number(map_y(moments[i].*y)).raw(" ");
    }
    if (is_open) svg.raw("\"/>\n");
}

void draw_map(Svg& svg, std::span<const Moment> moments, std::span<const Look> looks) {
    draw_room(svg);
    draw_path(svg, moments, &Moment::looks_x, &Moment::looks_y, "stroke=\"#5b8def\" stroke-opacity=\"0.45\"",
              [&](std::size_t i) {
                  return std::abs(moments[i].looks_x - 2.0) > 2.6 || moments[i].looks_y > map_far ||
                         moments[i].looks_y < map_near;
              });
    draw_path(svg, moments, &Moment::car_x, &Moment::car_y, "stroke=\"#999\" stroke-width=\"3\"",
              [&](std::size_t i) {
                  return i >= 5 && std::hypot(moments[i].car_x - moments[i - 5].car_x,
                                              moments[i].car_y - moments[i - 5].car_y) > 0.3;
              });
    for (const Look& look : looks)
        if (look.located) svg.circle(map_x(look.x), map_y(look.y), 3.0, "fill=\"#c8202a\"");
}

void draw_legend(Svg& svg) {
    const double x = left + map_width + 30.0;
    svg.line(x, map_top + 20, x + 30, map_top + 20, "stroke=\"#999\" stroke-width=\"3\"");
    svg.words(x + 40, map_top + 25, "true position of the car");
    svg.circle(x + 15, map_top + 45, 3.0, "fill=\"#c8202a\"");
    svg.words(x + 40, map_top + 50, "located position of the car");
    svg.line(x, map_top + 70, x + 30, map_top + 70, "stroke=\"#5b8def\"");
    svg.words(x + 40, map_top + 75, "where the camera looks");
}

class TimeAxis {
public:
    explicit TimeAxis(std::span<const Moment> moments)
        : end_s_{moments.empty() ? 1.0 : std::max(1.0, moments.back().at_s)} {}
    [[nodiscard]] double x(double at_s) const { return left + at_s / end_s_ * map_width; }
    [[nodiscard]] double end_s() const { return end_s_; }

private:
    double end_s_;
};

void draw_states(Svg& svg, std::span<const Moment> moments, const TimeAxis& time) {
    for (std::size_t i = 0; i < moments.size();) {
        std::size_t end = i;
        while (end < moments.size() && moments[end].state == moments[i].state) ++end;
        const double until = end < moments.size() ? moments[end].at_s : time.end_s();
        for (std::size_t row = 0; row < states.size(); ++row)
            if (states[row].state == moments[i].state)
                svg.rectangle(time.x(moments[i].at_s), time_top + static_cast<double>(row) * row_height + 3,
                              std::max(1.5, time.x(until) - time.x(moments[i].at_s)), row_height - 6,
                              std::string{"fill=\""}.append(states[row].colour).append("\""));
        i = end;
    }
    for (std::size_t row = 0; row < states.size(); ++row)
        svg.words(left - 8, time_top + static_cast<double>(row) * row_height + 14, states[row].state,
                  "text-anchor=\"end\" font-size=\"11\"");
}

/// Draws each image as a tick: green: car located; red: not; grey below: the car was hidden.
void draw_looks(Svg& svg, std::span<const Moment> moments, std::span<const Look> looks,
                const TimeAxis& time) {
    const double top = time_top + static_cast<double>(states.size()) * row_height;
    svg.words(left - 8, top + 14, "car in the image", "text-anchor=\"end\" font-size=\"11\"");
    for (std::size_t i = 0; i < moments.size();) {
        std::size_t end = i;
        while (end < moments.size() && moments[end].car_hidden == moments[i].car_hidden) ++end;
        const double until = end < moments.size() ? moments[end].at_s : time.end_s();
        if (moments[i].car_hidden)
            svg.rectangle(time.x(moments[i].at_s), top + 2, time.x(until) - time.x(moments[i].at_s),
                          row_height - 4, "fill=\"#ddd\"");
        i = end;
    }
    for (const Look& look : looks)
        svg.line(time.x(look.at_s), top + 3, time.x(look.at_s), top + row_height - 3,
                 look.located ? "stroke=\"#3f9b4f\"" : "stroke=\"#c8202a\"");
    svg.line(left, error_top + error_height, left + map_width, error_top + error_height, "stroke=\"#888\"");
    svg.words(left - 8, error_top + 10, "5 cm", "text-anchor=\"end\" font-size=\"11\"");
    svg.words(left - 8, error_top + error_height, "error 0", "text-anchor=\"end\" font-size=\"11\"");
    for (const Look& look : looks) {
        if (!look.located) continue;
        const double share = std::min(1.0, look.error_m() / worst_error_m);
        svg.circle(time.x(look.at_s), error_top + error_height * (1.0 - share), 2.0, "fill=\"#c8202a\"");
    }
    for (double at = 0; at <= time.end_s(); at += 10.0) {
        svg.line(time.x(at), time_top, time.x(at), error_top + error_height,
                 "stroke=\"#000\" stroke-opacity=\"0.12\"");
        svg.words(time.x(at), error_top + error_height + 18, Sentence{static_cast<int>(at), " s"}.view(),
                  "text-anchor=\"middle\" font-size=\"11\"");
    }
}

} // namespace

std::string picture_of(std::span<const Moment> moments, std::span<const Look> looks) {
    Svg svg{width, height};
    svg.words(left, 35, "A camera tracks a car", "font-size=\"20\"");
    draw_map(svg, moments, looks);
    draw_legend(svg);
    const TimeAxis time{moments};
    draw_states(svg, moments, time);
    draw_looks(svg, moments, looks, time);
    return svg.take();
}

} // namespace tappet::car_tracking
