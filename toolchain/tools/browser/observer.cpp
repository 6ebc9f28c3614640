// The reader's side of the generations: reads the generation, copies, reads it again.
#include "toolchain/tools/browser/observer.hpp"

#include <ctime>

namespace tappet::browser {

namespace {

/// Attempts before the first sleep: a cycle takes some microseconds.
constexpr int hasty_attempts = 8;
constexpr long pause_ns = 50'000;

} // namespace

std::uint64_t Observer::generation(std::uint32_t activity) const {
    return map_->view().word<std::uint64_t>(map_->activities()[activity].generation_at);
}

template <class Copy> bool Observer::between_cycles(std::uint32_t activity, Copy&& copy_all) const {
    if (frozen_ || activity == map::none || map_->activities()[activity].generation_at == 0) {
        copy_all();
        return true;
    }
    if (map_->view().consistent(activity, hasty_attempts, copy_all)) return true;
    for (int attempt = hasty_attempts; attempt < most_; ++attempt) {
        const timespec pause{0, pause_ns};
        ::nanosleep(&pause, nullptr);
        if (map_->view().consistent(activity, 1, copy_all)) return true;
    }
    return false;
}

void Observer::copy_reading(Reading& reading) const {
    const map::Facet& facet = map_->facets()[reading.facet];
    const std::size_t size = facet.type == map::none ? 0 : map_->types()[facet.type].size;
    std::uint8_t forced = 0;
    copy(facet.forced_at, forced);
    reading.forced = forced != 0;
    const std::uint64_t from =
        reading.forced && facet.forced_value_at != 0 ? facet.forced_value_at : facet.value_at;
    reading.value.resize(from == 0 ? 0 : size);
    static_cast<void>(map_->view().copy(from, reading.value)); // the map was checked: in range
    copy(facet.stamp_at, reading.stamp_ns);
    reading.has_writes = facet.writes_at != 0;
    copy(facet.writes_at, reading.writes);
    const std::uint32_t activity = map_->activity_of(facet);
    if (activity != map::none) copy(map_->activities()[activity].now_at, reading.now_ns);
}

Reading Observer::read(std::uint32_t facet) const { return read(std::span{&facet, 1}).front(); }

std::vector<Reading> Observer::read(std::span<const std::uint32_t> facets) const {
    std::vector<Reading> readings(facets.size());
    for (std::size_t i = 0; i < facets.size(); ++i) readings[i].facet = facets[i];
    std::vector<bool> done(facets.size(), false);
    for (std::size_t first = 0; first < facets.size(); ++first) {
        if (done[first]) continue;
        const std::uint32_t activity = map_->activity_of(map_->facets()[facets[first]]);
        std::vector<std::size_t> together;
        for (std::size_t i = first; i < facets.size(); ++i)
            if (map_->activity_of(map_->facets()[facets[i]]) == activity) together.push_back(i);
        const bool whole = between_cycles(activity, [&] {
            for (const std::size_t i : together) copy_reading(readings[i]);
        });
        for (const std::size_t i : together) {
            done[i] = true;
            readings[i].busy = !whole;
            if (!whole) readings[i].value.clear();
        }
    }
    for (Reading& reading : readings) { // after them: a value that comes in between is one more, not one less
        reading.unread = reading.is_initial() && was_written_to(reading.facet);
        if (const map::Connection* row = map_->device_row_of(reading.facet))
            reading.wire.push_back(read(row->from));
    }
    return readings;
}

bool Observer::was_written_to(std::uint32_t input) const {
    std::uint64_t writes = 0;
    for (const map::Connection& row : map_->connections())
        if (row.to == input && writes == 0) copy(map_->facets()[row.from].writes_at, writes);
    return writes != 0;
}

FigureReading Observer::read_figure(std::uint32_t figure) const {
    const map::Figure& record = map_->figures()[figure];
    FigureReading reading;
    reading.figure = figure;
    reading.value.resize(record.value_at == 0 ? 0 : map_->types()[record.type].size);
    const bool whole = between_cycles(
        record.activity, [&] { static_cast<void>(map_->view().copy(record.value_at, reading.value)); });
    reading.busy = !whole;
    if (!whole) reading.value.clear();
    return reading;
}

std::optional<map::Times> Observer::read_times(std::uint64_t at, std::uint32_t activity) const {
    map::Times times;
    bool inside = true;
    const bool whole = between_cycles(
        activity, [&] { inside = map_->view().copy(at, std::as_writable_bytes(std::span{&times, 1})); });
    return whole && inside ? std::optional{times} : std::nullopt;
}

std::uint32_t Observer::forced() const { return map_->view().word<std::uint32_t>(map_->header().forced_at); }

} // namespace tappet::browser
