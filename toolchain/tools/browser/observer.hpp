// Reads values without affecting the machine: copies from its memory that are consistent by the generation of
// the writing activity (thesis 4.8).
#pragma once

#include "toolchain/tools/browser/map_reader.hpp"

#include <optional>

namespace tappet::browser {

/// A facet's value between two cycles of its activity.
struct Reading {
    std::uint32_t facet = 0;
    bool busy = false; ///< the activity was in its cycle at every attempt: no value
    bool forced = false;
    bool has_writes = false; ///< the machine counts this facet's values
    std::uint64_t writes =
        0;               ///< of an input: that its component has read; 0: the value is the row's initial one
    bool unread = false; ///< an input with a value that its component did not read since it started
    std::int64_t stamp_ns = -1; ///< the time at which the value was true; -1: not stored
    std::int64_t now_ns = -1;   ///< time of the cycle after which it was read; -1: no activity
    std::vector<std::byte> value{};
    /// For an input that a device feeds, which shows its component's last read value: the driver's last
    /// value. Otherwise empty.
    std::vector<Reading> wire{};

    /// Returns whether the value is the row's initial one: see unread.
    [[nodiscard]] bool is_initial() const { return has_writes && writes == 0; }
};

struct FigureReading {
    std::uint32_t figure = 0;
    bool busy = false;
    std::vector<std::byte> value{};
};

/// Reads with at most `attempts` copies. An activity that is in its cycle at every attempt gives a busy
/// reading, never a torn one: the generation was even and the same before and after each returned copy.
class Observer {
public:
    static constexpr int attempts = 64;

    /// `frozen`: nothing runs any more. A value that an activity was writing when it ended is then returned
    /// as it is. `most`: attempts; up to 8 do not sleep.
    explicit Observer(const MapReader& map, bool frozen = false, int most = attempts)
        : map_{&map}, frozen_{frozen}, most_{most} {}

    [[nodiscard]] Reading read(std::uint32_t facet) const;
    /// Returns readings in the order of `facets`. Values of one activity are copied together, so they are of
    /// the same moment.
    [[nodiscard]] std::vector<Reading> read(std::span<const std::uint32_t> facets) const;
    [[nodiscard]] FigureReading read_figure(std::uint32_t figure) const;
    /// Reads one row's times at its times_at; `activity` receives. Nothing: it was busy.
    [[nodiscard]] std::optional<map::Times> read_times(std::uint64_t at, std::uint32_t activity) const;
    /// Returns how many ports of the whole machine are forced now.
    [[nodiscard]] std::uint32_t forced() const;
    /// Returns the generation of an activity: even between two cycles.
    [[nodiscard]] std::uint64_t generation(std::uint32_t activity) const;

private:
    template <class Word> void copy(std::uint64_t at, Word& into) const {
        if (at != 0) into = map_->view().word<Word>(at);
    }
    void copy_reading(Reading& reading) const;
    [[nodiscard]] bool was_written_to(std::uint32_t input) const;
    /// Runs `copy_all` until it fell between two cycles; returns false after all attempts.
    template <class Copy> bool between_cycles(std::uint32_t activity, Copy&& copy_all) const;

    const MapReader* map_;
    bool frozen_;
    int most_;
};

} // namespace tappet::browser
