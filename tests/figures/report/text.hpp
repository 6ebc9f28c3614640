// Numbers and words as a reader sees them, on the page and in the terminal.
#pragma once

#include "tests/figures/measure/result.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tappet::figures {

/// Safe in the text and in the attributes of a page.
std::string escaped(const std::string& text);

/// Three to four digits that mean something: 0.36, 20.4, 1 234; a dash for what is no number.
std::string number_text(double value);
/// With the unit: "1.13 x", "48 ns".
std::string quantity(double value, const std::string& unit);

/// What one of ours takes beside a floor or a peer of the same figure.
struct Beside {
    std::string name;
    Standing role;
    double median, p99; ///< ours / the other
    std::optional<double> instructions = {};
};
/// Of the figure's floors and peers, in its order; none when the row is not ours. Where several of ours are
/// called "high, one" and "low", a floor called "high, its load" stands beside the first alone.
std::vector<Beside> beside(const Figure& figure, const Row& row);
/// The row of ours that a floor or a peer stands beside; the figure has one of ours.
const Row& ours_beside(const Figure& figure, const Row& other);

} // namespace tappet::figures
