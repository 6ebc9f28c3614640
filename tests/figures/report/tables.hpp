// The parts of the page in rows and columns.
#pragma once

#include "tests/figures/report/run.hpp"
#include "tests/figures/report/text.hpp"

#include <string>

namespace tappet::figures {

/// `<name attributes>inside</name>`; `inside` is already escaped.
inline std::string element(const std::string& name, const std::string& inside,
                           const std::string& attributes = {}) {
    return "<" + name + (attributes.empty() ? "" : " " + attributes) + ">" + inside + "</" + name + ">";
}
/// A number in a row.
inline std::string cell(double value) { return element("td", number_text(value)); }

/// One goal in five cells; its detail links to the figure that it names.
std::string goal_row(const Goal& goal, const Run& run);
/// All statements of a program; empty: it has none.
std::string statements(const Result& result);
/// All figures of a program; many of them are grouped by the prefix of their ids.
std::string tables(const Result& result);

} // namespace tappet::figures
