// Writes gnuplot's script with the data in it, and removes the document's parts from the SVG.
#include "tests/figures/report/plots.hpp"

#include "tests/figures/report/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace tappet::figures {

namespace {

/// Distinguishable on white and on black.
constexpr std::array ours_colours{"#2b7de0", "#12a594", "#8e5cd9", "#d6409f", "#3f9142", "#0894b3"};
constexpr std::array peer_colours{"#e5832a", "#d9484f", "#b8860b", "#a0674b", "#c2577a", "#96772b"};
constexpr std::array floor_colours{"#8a9099", "#6f7a88", "#a4a9b0", "#5f6b7a"};

const char* colour(Standing role, std::size_t nth) {
    return role == Standing::ours   ? ours_colours[nth % ours_colours.size()]
           : role == Standing::peer ? peer_colours[nth % peer_colours.size()]
                                    : floor_colours[nth % floor_colours.size()];
}

std::string quoted(const std::string& text) {
    std::string quoted = "'";
    for (const char character : text)
        if (character == '\'')
            quoted += "''";
        else
            quoted += character == '\n' ? ' ' : character;
    return quoted + "'";
}

/// Points that the axes can show.
std::vector<std::pair<double, double>> drawable(const Plot& plot, const Series& series) {
    std::vector<std::pair<double, double>> points;
    for (auto [x, y] : series.points) {
        if (!std::isfinite(x) || !std::isfinite(y) || (plot.log_x && x <= 0)) continue;
        if (plot.log_y && y <= 0) {
            if (!plot.histogram) continue;
            y = 0.5; // an empty bin is drawn below the bins of one
        }
        points.emplace_back(x, y);
    }
    if (plot.histogram && !points.empty()) { // the last bin is as wide as the one before it
        const std::size_t n = points.size();
        const double width = n > 1 ? points[n - 1].first - points[n - 2].first : 1;
        points.emplace_back(points.back().first + width, points.back().second);
    }
    return points;
}

/// Large numbers as 1.5k and 2.0M: long digits would overlap.
const char* format_of(const Plot& plot, int axis) {
    constexpr double many_digits = 1e5;
    for (const Series& series : plot.series)
        for (const auto& [x, y] : series.points)
            if (std::abs(axis == 0 ? x : y) >= many_digits) return "'%.1s%c'";
    return "'%.10g'";
}

} // namespace

std::string gnuplot_script(const Plot& plot, const std::string& name, const std::string& file) {
    std::ostringstream script;
    script.precision(9);
    std::string drawing;
    std::array<std::size_t, 3> seen{};
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const Series& series = plot.series[i];
        const char* const shade = colour(series.role, seen[static_cast<std::size_t>(series.role)]++);
        const auto points = drawable(plot, series);
        if (points.empty()) continue;
        const std::string data = "$" + name + "_" + std::to_string(i);
        script << data << " << END\n";
        for (const auto& [x, y] : points) script << x << ' ' << y << '\n';
        script << "END\n";
        const std::string line = std::string{"lc rgb '"} + shade + "' title " + quoted(series.name);
        if (!drawing.empty()) drawing += ", ";
        if (plot.histogram)
            drawing += data + " with fillsteps fs transparent solid 0.25 noborder lc rgb '" + shade +
                       "' notitle, " + data + " with steps lw 1.5 " + line;
        else
            drawing += data + " with linespoints lw 2 pt 7 ps 0.5 " + line;
    }
    if (drawing.empty()) return {};
    const std::size_t rows_of_key = (plot.series.size() + 2) / 3;
    script << "reset\nset terminal svg size 640," << 320 + 18 * rows_of_key << " dynamic name "
           << quoted(name) << " font 'system-ui,sans-serif,13'\nset output " << quoted(file)
           << "\nset termoption noenhanced\n"
           << "set border 3 lw 0.8\nset tics nomirror out\nset grid lc rgb '#999999' lw 0.3\n"
           << "set key outside top left horizontal Left reverse noenhanced maxcols 3\n"
           << "set xlabel " << quoted(plot.x) << " noenhanced\nset ylabel " << quoted(plot.y)
           << " noenhanced\nset format x " << format_of(plot, 0) << "\nset format y " << format_of(plot, 1)
           << '\n';
    if (plot.log_x) script << "set logscale x\n";
    if (plot.log_y) script << "set logscale y\n";
    if (plot.histogram) script << (plot.log_y ? "set yrange [0.5:*]\n" : "set yrange [0:*]\n");
    script << "plot " << drawing << "\nset output\n";
    return script.str();
}

std::string as_element(const std::string& svg, const std::string& title) {
    std::string element = svg.substr(std::min(svg.find("<svg"), svg.size()));
    const auto cut = [&](const char* from, const std::string& to) {
        const auto begin = element.find(from);
        const auto end = begin == element.npos ? element.npos : element.find(to, begin);
        if (end != element.npos) element.erase(begin, end + to.size() - begin);
    };
    cut("<title>", "</title>");
    cut("<desc>", "</desc>");
    for (const char* black : {"'black'", "\"black\"", "'rgb(  0,   0,   0)'", "\"rgb(  0,   0,   0)\""})
        for (auto at = element.find(black); at != element.npos; at = element.find(black, at + 1))
            element.replace(at, std::string{black}.size(), "\"currentColor\"");
    if (element.starts_with("<svg")) element.insert(4, " role=\"img\" aria-label=\"" + escaped(title) + "\"");
    return element;
}

std::expected<std::vector<std::string>, std::string> draw(const std::vector<const Plot*>& plots,
                                                          const std::string& folder) {
    std::filesystem::create_directories(folder);
    const auto path = [&](std::size_t i) { return folder + "/" + std::to_string(i) + ".svg"; };
    const std::string script = folder + "/plots.gnuplot", log = folder + "/gnuplot.log";
    std::vector<bool> drawn;
    {
        std::ofstream file{script};
        for (std::size_t i = 0; i < plots.size(); ++i) {
            const std::string text = gnuplot_script(*plots[i], "p" + std::to_string(i), path(i));
            drawn.push_back(!text.empty());
            file << text;
        }
    }
    if (std::system(("gnuplot '" + script + "' >'" + log + "' 2>&1").c_str()) != 0) { // NOLINT: our own names
        std::ifstream said{log};
        std::string first;
        while (first.empty() && std::getline(said, first)) {
        }
        return std::unexpected("gnuplot drew nothing: " + first +
                               "; is gnuplot-nox installed? ci/setup does it");
    }
    std::vector<std::string> elements;
    for (std::size_t i = 0; i < plots.size(); ++i) {
        std::ostringstream svg;
        if (drawn[i]) svg << std::ifstream{path(i)}.rdbuf();
        elements.push_back(drawn[i] ? as_element(svg.str(), plots[i]->title) : "");
    }
    return elements;
}

} // namespace tappet::figures
