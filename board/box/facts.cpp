// SPDX-License-Identifier: Apache-2.0
// Splits lines into words.
#include "board/box/facts.hpp"

#include <algorithm>

namespace tappet::box {

Facts::Facts(std::string_view text) {
    while (!text.empty()) {
        std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        Words words;
        while (!line.empty()) {
            const std::string_view word = line.substr(0, line.find(' '));
            line.remove_prefix(std::min(word.size() + 1, line.size()));
            if (!word.empty()) words.emplace_back(word);
        }
        if (!words.empty()) lines_.push_back(std::move(words));
    }
}

std::vector<Words> Facts::all(std::string_view word) const {
    std::vector<Words> found;
    for (const Words& line : lines_)
        if (line[0] == word) found.emplace_back(line.begin() + 1, line.end());
    return found;
}

std::string Facts::one(std::string_view word, std::size_t which, std::string_view otherwise) const {
    for (const Words& line : lines_)
        if (line[0] == word && which + 1 < line.size()) return line[which + 1];
    return std::string{otherwise};
}

} // namespace tappet::box
