// Plots, drawn by gnuplot as SVG inside a page.
#pragma once

#include "tests/figures/measure/result.hpp"

#include <expected>
#include <string>
#include <vector>

namespace tappet::figures {

/// The script of gnuplot for one plot, which writes `file`. `name` is unique on the page.
std::string gnuplot_script(const Plot& plot, const std::string& name, const std::string& file);

/// The SVG as an element: without prologue, and with the page's own colour instead of gnuplot's black.
std::string as_element(const std::string& svg, const std::string& title);

/// One element for each plot, drawn in one run of gnuplot, with its files in `folder`. A plot without a point
/// gives an empty one. Otherwise one sentence: the reason why nothing was drawn.
std::expected<std::vector<std::string>, std::string> draw(const std::vector<const Plot*>& plots,
                                                          const std::string& folder);

} // namespace tappet::figures
