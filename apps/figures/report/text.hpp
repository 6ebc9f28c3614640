// Numbers and words as a reader sees them, on the page and in the terminal.
#pragma once

#include "apps/figures/measure/result.hpp"

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
    Role role;
    double median, p99; ///< ours / the other
    std::optional<double> instructions = {};
};
/// Of the figure's floors and peers, in its order; none when the row is not ours.
std::vector<Beside> beside(const Figure& figure, const Row& row);

} // namespace tappet::figures
