// The picture of the watch view, line by line: readable in a terminal of 80 columns and 24 rows, forced
// values marked in words and colour.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tappet::browser {

struct WatchRow {
    std::string name{};
    std::string value{};
    std::string unit{};
    std::string marks{};
    bool forced = false;
    bool changed = false; ///< since the last picture

    bool operator==(const WatchRow&) const = default;
};

struct WatchPicture {
    std::string title{};
    std::string status{};
    std::vector<WatchRow> rows{};
    std::size_t first = 0; ///< row at the top
};

struct Size {
    std::size_t columns = 80;
    std::size_t rows = 24;
};

/// Returns how many of the rows fit.
[[nodiscard]] std::size_t visible_rows(const WatchPicture& picture, Size size);
/// Returns at most `size.rows` lines of at most `size.columns` visible characters; `colour` adds invisible
/// control sequences.
[[nodiscard]] std::vector<std::string> draw(const WatchPicture& picture, Size size, bool colour);

} // namespace tappet::browser
