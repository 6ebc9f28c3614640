// Numbers and words for a reader, on the page and in the terminal.
#pragma once

#include "tests/figures/measure/result.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tappet::figures {

/// Escapes text for the content and the attributes of a page.
std::string escaped(const std::string& text);

/// Three to four significant digits: 0.36, 20.4, 1 234; a dash for NaN and infinity.
std::string number_text(double value);
/// With the unit: "1.13 x", "48 ns".
std::string quantity(double value, const std::string& unit);

/// The ratio of one of ours to a floor or a peer of the same figure.
struct Beside {
    std::string name;
    Standing role;
    double median, p99; ///< ours / the other
    std::optional<double> instructions = {};
};
/// The figure's floors and peers, in its order; none when the row is not ours. When several of ours are
/// called "high, one" and "low", a floor called "high, its load" belongs to the first alone.
std::vector<Beside> beside(const Figure& figure, const Row& row);
/// The row of ours that belongs to a floor or a peer; the figure has one of ours.
const Row& ours_beside(const Figure& figure, const Row& other);

} // namespace tappet::figures
