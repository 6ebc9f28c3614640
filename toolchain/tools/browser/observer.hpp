// Watching values without the machine noticing: copies out of its memory, whole by the generation of the
// activity that writes them (thesis 4.8).
#pragma once

#include "toolchain/tools/browser/map_reader.hpp"

#include <optional>

namespace tappet::browser {

/// A facet's value as it was between two cycles of its activity.
struct Reading {
    std::uint32_t facet = 0;
    bool busy = false; ///< the activity was in its cycle at every attempt: there is no value
    bool forced = false;
    bool has_writes = false;    ///< the machine counts this facet's values
    std::uint64_t writes = 0;   ///< 0: never written, and the value is the row's initial one
    std::int64_t stamp_ns = -1; ///< the time at which the value was true; -1: the machine keeps none
    std::int64_t now_ns = -1;   ///< the time of the cycle after which it was read; -1: no activity
    std::vector<std::byte> value{};
    /// Of an input that a device feeds, which shows what its component read last: what the driver gave last.
    /// Else empty.
    std::vector<Reading> wire{};

    [[nodiscard]] bool never_written() const { return has_writes && writes == 0; }
};

struct FigureReading {
    std::uint32_t figure = 0;
    bool busy = false;
    std::vector<std::byte> value{};
};

/// Reads with at most `attempts` copies. An engine that is caught in its cycle again and again makes a
/// reading busy, never torn: the generation was even and the same before and after each copy that is handed
/// out.
class Observer {
public:
    static constexpr int attempts = 64;

    /// `frozen`: nothing runs any more. What an activity was writing when it ended is then told as it was
    /// left.
    explicit Observer(const MapReader& map, bool frozen = false) : map_{&map}, frozen_{frozen} {}

    [[nodiscard]] Reading read(std::uint32_t facet) const;
    /// In the order of `facets`. What belongs to one activity is copied at once: it is of one and the same
    /// moment.
    [[nodiscard]] std::vector<Reading> read(std::span<const std::uint32_t> facets) const;
    [[nodiscard]] FigureReading read_figure(std::uint32_t figure) const;
    /// Of one row, at its times_at; `activity` receives. Nothing: it was busy.
    [[nodiscard]] std::optional<map::Times> read_times(std::uint64_t at, std::uint32_t activity) const;
    /// How many ports are forced now, of the whole machine.
    [[nodiscard]] std::uint32_t forced() const;
    /// The generation of an activity: even between two cycles.
    [[nodiscard]] std::uint64_t generation(std::uint32_t activity) const;

private:
    template <class Word> void copy(std::uint64_t at, Word& into) const {
        if (at != 0) into = map_->view().word<Word>(at);
    }
    void copy_reading(Reading& reading) const;
    /// Runs `copy_all` until it fell between two cycles; false after all attempts.
    template <class Copy> bool between_cycles(std::uint32_t activity, Copy&& copy_all) const;

    const MapReader* map_;
    bool frozen_;
};

} // namespace tappet::browser
