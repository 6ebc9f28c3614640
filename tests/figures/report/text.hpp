// Numbers for a reader in the terminal, as on the page.
#pragma once

#include <string>

namespace tappet::figures {

/// Three to four significant digits: 0.36, 20.4, 1 234; a dash for NaN and infinity.
std::string number_text(double value);
/// With the unit: "1.13 x", "48 ns".
std::string quantity(double value, const std::string& unit);

} // namespace tappet::figures
