// Levels between a plant and gpio-sim. The files speak of the wire, the plant of what it means: a line that
// is active low is turned over here.
#include "toolchain/machine/bench/line_end.hpp"

#include "kernel/machine/check/board.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace tappet {

LineEnd::LineEnd() { files_.fill(-1); }

LineEnd::~LineEnd() {
    for (const int file : files_)
        if (file >= 0) ::close(file);
}

std::expected<void, Sentence> LineEnd::open(const std::string& folder, std::span<const gpio::LineRow> map,
                                            std::span<const Fact> bound) {
    map_ = map;
    for (std::size_t i = 0; i < map.size(); ++i) {
        const bool input = map[i].line.role == gpio::Role::input;
        const unsigned offset = gpio::offset_of(bound, map[i].line.name);
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

bool LineEnd::pull(std::size_t line, bool active) noexcept {
    const std::string_view word = active != map_[line].line.active_low ? "pull-up" : "pull-down";
    const bool done =
        ::pwrite(files_[line], word.data(), word.size(), 0) == static_cast<ssize_t>(word.size());
    failures_ += done ? 0u : 1u;
    return done;
}

bool LineEnd::drive(std::size_t line, bool active, Time at) noexcept {
    if (line >= map_.size() || map_[line].line.role != gpio::Role::input) return false;
    if (at <= looked_) return pull(line, active);
    later_.push_back({line, active, at});
    return true;
}

void LineEnd::look(Time now) {
    last_ = looked_ == Time{} ? now : looked_;
    looked_ = now;
    for (const Later& each : later_)
        if (each.at <= now) static_cast<void>(pull(each.line, each.active));
    std::erase_if(later_, [now](const Later& each) { return each.at <= now; });
    const bool slow = now >= slow_at_;
    if (slow) slow_at_ = now + slow_period;
    for (std::size_t i = 0; i < map_.size(); ++i) {
        if (map_[i].line.role != gpio::Role::output) continue;
        if (map_[i].driven == gpio::Driven::by_port && !slow) continue;
        char digit = '0';
        if (::pread(files_[i], &digit, 1, 0) != 1) {
            ++failures_;
            continue;
        }
        const gpio::Mask bit = gpio::Mask{1} << i;
        const bool active = (digit == '1') != map_[i].line.active_low;
        outputs_ = active ? outputs_ | bit : outputs_ & ~bit;
    }
}

} // namespace tappet
