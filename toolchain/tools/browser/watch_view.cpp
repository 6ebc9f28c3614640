// Columns: the name, the value (whose end is kept when it is too long), the unit, the marks.
#include "toolchain/tools/browser/watch_view.hpp"

#include <algorithm>

namespace tappet::browser {

namespace {

constexpr std::size_t unit_width = 6;
constexpr std::size_t marks_width = 14;
constexpr std::size_t least_name = 12;

std::string fitted(const std::string& text, std::size_t width, bool right) {
    if (text.size() > width) return width < 2 ? text.substr(0, width) : text.substr(0, width - 1) + "~";
    const std::string blanks(width - text.size(), ' ');
    return right ? blanks + text : text + blanks;
}

std::string painted(const std::string& text, const char* sequence, bool colour) {
    return colour ? std::string{sequence} + text + "\x1b[0m" : text;
}

} // namespace

std::size_t visible_rows(const WatchPicture& picture, Size size) {
    const std::size_t room = size.rows > 2 ? size.rows - 2 : 0; // title and status
    return std::min(room, picture.rows.size() - std::min(picture.first, picture.rows.size()));
}

std::vector<std::string> draw(const WatchPicture& picture, Size size, bool colour) {
    std::size_t name_width = least_name;
    for (const WatchRow& row : picture.rows) name_width = std::max(name_width, row.name.size());
    const std::size_t rest = unit_width + marks_width + 3;
    const std::size_t widest =
        size.columns > rest + least_name ? size.columns - rest - least_name : least_name;
    name_width = std::min(name_width, widest);
    const std::size_t value_width =
        size.columns > rest + name_width ? std::min<std::size_t>(size.columns - rest - name_width, 32) : 0;

    std::vector<std::string> lines;
    lines.push_back(painted(fitted(picture.title, size.columns, false), "\x1b[7m", colour));
    const std::size_t count = visible_rows(picture, size);
    for (std::size_t i = picture.first; i < picture.first + count; ++i) {
        const WatchRow& row = picture.rows[i];
        std::string line = fitted(row.name, name_width, false) + " ";
        line += painted(fitted(row.value, value_width, true), row.changed ? "\x1b[1m" : "",
                        colour && row.changed);
        line += " " + fitted(row.unit, unit_width, false) + " ";
        std::string marks = row.marks.substr(0, marks_width);
        line += painted(marks, row.forced ? "\x1b[7;31m" : "\x1b[33m", colour && !marks.empty());
        if (!colour) line = line.substr(0, size.columns);
        lines.push_back(std::move(line));
    }
    std::string status = picture.status;
    if (picture.rows.size() > count)
        status = std::to_string(picture.first + 1) + "-" + std::to_string(picture.first + count) + " of " +
                 std::to_string(picture.rows.size()) + ", arrows turn; " + status;
    if (size.rows >= 2) lines.push_back(fitted(status, size.columns, false));
    return lines;
}

} // namespace tappet::browser
