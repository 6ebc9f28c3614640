// Plots, drawn by gnuplot as SVG that stands inside a page.
#pragma once

#include "tests/figures/measure/result.hpp"

#include <expected>
#include <string>
#include <vector>

namespace tappet::figures {

/// What gnuplot is told for one plot, writing to `file`. `name` is unique on the page.
std::string gnuplot_script(const Plot& plot, const std::string& name, const std::string& file);

/// The SVG as an element: without prologue, with the page's own colour where gnuplot drew in black.
std::string as_element(const std::string& svg, const std::string& title);

/// One element for each plot, drawn in one start of gnuplot, with its files in `folder`. An empty one for a
/// plot without a point. Or one sentence: why nothing was drawn.
std::expected<std::vector<std::string>, std::string> draw(const std::vector<const Plot*>& plots,
                                                          const std::string& folder);

} // namespace tappet::figures
