// Parses lines, and interprets the difference between two of them.
#include "apps/carpet_loom/demo/story.hpp"

#include "apps/carpet_loom/wires.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace tappet::demo {

Words words_of(std::string_view line, std::string_view kind, std::string_view last) {
    if (!line.starts_with(kind)) return {};
    line.remove_prefix(kind.size());
    Words words;
    while (!line.empty()) {
        if (line.front() != ' ') return {};
        line.remove_prefix(1);
        const std::string_view word = line.substr(0, line.find(' '));
        line.remove_prefix(word.size());
        const std::size_t equals = std::min(word.find('='), word.size());
        const std::string_view name = word.substr(0, equals);
        if (equals == 0 || equals + 1 >= word.size() || !text_of(words, name).empty()) return {};
        words.emplace_back(name, word.substr(equals + 1));
    }
    return words.empty() || words.back().first != last ? Words{} : words;
}

std::string_view text_of(const Words& words, std::string_view name) {
    const auto found = std::ranges::find(words, name, &Words::value_type::first);
    return found == words.end() ? std::string_view{} : std::string_view{found->second};
}

std::int64_t number_of(std::string_view value) {
    std::int64_t number = 0;
    std::from_chars(value.data(), value.data() + value.size(), number);
    return number;
}

Story::Kind Story::take(std::string_view line) {
    if (const Words words = words_of(line, "timing", "misses"); !words.empty()) {
        double most = -1.0;
        for (const auto& [activity, response] : words) {
            const std::size_t slash = response.find('/');
            if (slash == response.npos) continue;
            const auto deadline =
                static_cast<double>(number_of(std::string_view{response}.substr(slash + 1)));
            const double part = static_cast<double>(number_of(response)) / std::max(deadline, 1.0);
            if (part > most) timing_ = activity + "=" + response, most = part;
        }
        timing_ += " misses=" + words.back().second;
        return Kind::timing;
    }
    Words now = words_of(line, "loom", "waits_for");
    if (now.empty()) {
        if (!line.empty()) messages_.emplace_back(line);
        if (messages_.size() > most_messages) messages_.erase(messages_.begin());
        return Kind::message;
    }
    if (!status_.empty()) note_stop(now);
    const bool wove = status_.empty() || text_of(now, "picks") != text_of(status_, "picks");
    status_ = std::move(now);
    if (wove) last_pick_ms_ = number("t");
    return Kind::status;
}

void Story::note_stop(const Words& now) {
    const auto after = [&now](std::string_view name) { return number_of(text_of(now, name)); };
    const std::string_view cause = text_of(now, "cause");
    const bool at_stop_angle = after("stops") > number("stops");
    // All other stops are counted by the machine once the shaft stands at the stop angle.
    const bool wherever = cause == "emergency" || cause == "fault";
    const bool came_to_stand = wherever && number("speed") != 0 && after("speed") == 0;
    if (!at_stop_angle && !came_to_stand) return;
    const double error = 0.1 * static_cast<double>(after("stop_error"));
    const double angle =
        at_stop_angle ? loom::wires::nominal::stop_deg + error : static_cast<double>(after("angle"));
    char where[64];
    std::snprintf(where, sizeof where, at_stop_angle ? "at %.1f deg, error %+.1f deg" : "at %.1f deg", angle,
                  error);
    stops_.emplace_back("stop after pick " + std::to_string(after("picks")) + ", " + std::string{cause},
                        where);
}

} // namespace tappet::demo
