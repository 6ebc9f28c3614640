// Levels between a plant and gpio-sim. The files hold wire levels, the plant uses logical ones: active-low
// lines are inverted here.
#include "drivers/gpio/bench_lines.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::gpio {

BenchLines::BenchLines() { files_.fill(-1); }

BenchLines::~BenchLines() {
    for (const int file : files_)
        if (file >= 0) ::close(file);
}

std::expected<void, Sentence> BenchLines::open(const DevicePlace& place) {
    const std::string name{place.address.substr(place.address.rfind('/') + 1)};
    return open_at("/sim/" + name, *static_cast<const std::span<const LineRow>*>(place.map), place.bound);
}

std::expected<void, Sentence> BenchLines::open_at(const std::string& folder, std::span<const LineRow> map,
                                                  std::span<const Fact> bound) {
    map_ = map;
    for (std::size_t i = 0; i < map.size(); ++i) {
        const bool input = map[i].line.role == Role::input;
        const unsigned offset = offset_of(bound, map[i].line.name);
        const std::string path = folder + "/sim_gpio" + std::to_string(offset) + (input ? "/pull" : "/value");
        files_[i] = ::open(path.c_str(), (input ? O_WRONLY : O_RDONLY) | O_CLOEXEC);
        if (files_[i] < 0)
            return std::unexpected(Sentence{"line \"", map[i].line.name, "\" at \"", path,
                                            "\": ", std::string_view{std::strerror(errno)},
                                            "; the bench wants a simulated chip with more than ", offset,
                                            " lines: --gpio-chip NAME:LINES"});
        if (input) static_cast<void>(pull(i, false));
    }
    return {};
}

bool BenchLines::pull(std::size_t line, bool active) noexcept {
    const std::string_view word = active != map_[line].line.active_low ? "pull-up" : "pull-down";
    const bool done =
        ::pwrite(files_[line], word.data(), word.size(), 0) == static_cast<ssize_t>(word.size());
    failures_ += done ? 0u : 1u;
    return done;
}

bool BenchLines::drive(std::size_t line, bool active, Time at) noexcept {
    if (line >= map_.size() || map_[line].line.role != Role::input) return false;
    if (at <= looked_) return pull(line, active);
    later_.push_back({line, active, at});
    return true;
}

void BenchLines::look(Time now) {
    last_ = looked_ == Time{} ? now : looked_;
    looked_ = now;
    for (const Later& each : later_)
        if (each.at <= now) static_cast<void>(pull(each.line, each.active));
    std::erase_if(later_, [now](const Later& each) { return each.at <= now; });
    const bool slow = now >= slow_at_;
    if (slow) slow_at_ = now + slow_period;
    for (std::size_t i = 0; i < map_.size(); ++i) {
        if (map_[i].line.role != Role::output) continue;
        if (map_[i].driven == Driven::by_port && !slow) continue;
        char digit = '0';
        if (::pread(files_[i], &digit, 1, 0) != 1) {
            ++failures_;
            continue;
        }
        const Mask bit = Mask{1} << i;
        const bool active = (digit == '1') != map_[i].line.active_low;
        outputs_ = active ? outputs_ | bit : outputs_ & ~bit;
    }
}

} // namespace tappet::gpio
