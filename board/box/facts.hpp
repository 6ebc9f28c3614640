// SPDX-License-Identifier: Apache-2.0
// The facts that a box needs to start: the lines of the firmware's --board, stored in the image.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tappet::box {

using Words = std::vector<std::string>;

/// "device can can0 500000" is the word "device" with three values.
class Facts {
public:
    explicit Facts(std::string_view text);

    /// Returns the values of each line with this word, in their order.
    [[nodiscard]] std::vector<Words> all(std::string_view word) const;
    /// Returns one value of the first line with this word; `otherwise` when there is none.
    [[nodiscard]] std::string one(std::string_view word, std::size_t which = 0,
                                  std::string_view otherwise = {}) const;

    [[nodiscard]] const std::vector<Words>& lines() const { return lines_; }

private:
    std::vector<Words> lines_;
};

} // namespace tappet::box
