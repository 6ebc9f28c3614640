// Reading the firmware's lines: words of the form name=value, the value with its unit.
#include "apps/carpet_loom/demo/status.hpp"

#include <charconv>
#include <map>

namespace tappet::demo {

namespace {

std::optional<std::int64_t> whole(std::string_view text) {
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (text.empty() || error != std::errc{} || at != end) return std::nullopt;
    return value;
}

/// The number in front of exactly this unit.
std::optional<std::int64_t> whole(std::string_view text, std::string_view unit) {
    if (!text.ends_with(unit)) return std::nullopt;
    text.remove_suffix(unit.size());
    return whole(text);
}

/// The words after the first one, if that is `kind`. Nothing when a word is no pair or is there twice.
using Pairs = std::vector<std::pair<std::string_view, std::string_view>>;
std::optional<Pairs> pairs_of(std::string_view line, std::string_view kind) {
    if (!line.starts_with(kind) || line.size() == kind.size() || line[kind.size()] != ' ')
        return std::nullopt;
    line.remove_prefix(kind.size());
    Pairs pairs;
    while (!line.empty()) {
        line.remove_prefix(1); // the blank
        const std::string_view word = line.substr(0, line.find(' '));
        line.remove_prefix(word.size());
        const std::size_t equals = word.find('=');
        if (equals == word.npos || equals == 0) return std::nullopt;
        for (const auto& [name, value] : pairs)
            if (name == word.substr(0, equals)) return std::nullopt;
        pairs.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    }
    return pairs;
}

/// Takes values out of the pairs; remembers when one was missing or wrong.
class Words {
public:
    explicit Words(const Pairs& pairs) : values_(pairs.begin(), pairs.end()) {}

    void take(std::string& to, std::string_view name) {
        if (const auto found = values_.find(name); found != values_.end() && !found->second.empty())
            to = found->second;
        else
            good_ = false;
    }
    void take(std::int64_t& to, std::string_view name, std::string_view unit) {
        const auto found = values_.find(name);
        const auto value = found == values_.end() ? std::nullopt : whole(found->second, unit);
        if (value)
            to = *value;
        else
            good_ = false;
    }
    void take(double& to, std::string_view name, std::string_view unit, double scale) {
        std::int64_t value = 0;
        take(value, name, unit);
        to = static_cast<double>(value) * scale;
    }
    [[nodiscard]] bool good() const { return good_; }

private:
    std::map<std::string_view, std::string_view> values_;
    bool good_ = true;
};

} // namespace

std::optional<Status> parse_status(std::string_view line) {
    const auto pairs = pairs_of(line, "loom");
    if (!pairs) return std::nullopt;
    Words words{*pairs};
    Status status;
    words.take(status.time_ms, "t", "ms");
    words.take(status.state, "state");
    words.take(status.speed_rpm, "speed", "rpm");
    words.take(status.angle_deg, "angle", "deg");
    words.take(status.picks, "picks", "");
    words.take(status.tension_n, "tension", "N");
    words.take(status.oil_bar, "oil", "cbar", 0.01);
    words.take(status.stops, "stops", "");
    words.take(status.cause, "cause");
    words.take(status.stop_error_deg, "stop_error", "ddeg", 0.1);
    words.take(status.bus_state, "bus", "");
    words.take(status.frames_lost, "frames_lost", "");
    words.take(status.edges_lost, "edges_lost", "");
    words.take(status.outages, "outages", "");
    if (!words.good()) return std::nullopt;
    return status;
}

std::optional<Timing> parse_timing(std::string_view line) {
    const auto pairs = pairs_of(line, "timing");
    if (!pairs) return std::nullopt;
    Timing timing;
    bool complete = false; // the line's last word has come
    for (const auto& [name, value] : *pairs) {
        if (name == "misses") {
            const auto misses = whole(value);
            if (!misses) return std::nullopt;
            timing.misses = *misses;
            complete = true;
            continue;
        }
        const std::size_t slash = value.find('/');
        if (slash == value.npos) return std::nullopt;
        const auto worst = whole(value.substr(0, slash));
        const auto deadline = whole(value.substr(slash + 1), "us");
        if (!worst || !deadline || *deadline <= 0) return std::nullopt;
        timing.responses.push_back({std::string{name}, *worst, *deadline});
    }
    if (!complete || timing.responses.empty()) return std::nullopt;
    return timing;
}

} // namespace tappet::demo
