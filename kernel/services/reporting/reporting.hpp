// The reporting service (thesis 3.3): a section of the machine table that lists the recorded values. The
// engines copy them at the end of their cycles to tapes in the machine's memory; another process reads the
// tapes and writes files.
#pragma once

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/reporting/check.hpp"
#include "kernel/services/reporting/layout.hpp"

#include <array>
#include <atomic>
#include <span>
#include <string_view>

namespace tappet {

namespace reporting_detail {

/// An engine's data of a channel: one cache line.
struct Recorded {
    const std::byte* value = nullptr;
    const std::uint64_t* writes = nullptr; ///< 0 there: it has no value yet
    std::uint64_t head = 0;                ///< of sample 0
    std::uint64_t* last = nullptr;         ///< on change: the words recorded last
    std::uint32_t every = 0;               ///< 0: on change
    std::uint32_t left = 1;                ///< steps until it is recorded again
    std::uint32_t sequence = 0;            ///< of the next sample
    std::uint32_t bytes = 0;
    double band = 0.0; ///< of a number
    ValueKind kind = ValueKind::opaque;
};
static_assert(sizeof(Recorded) == 64);

/// An engine's copy of the counter of an event that any activity may emit.
struct Emissions {
    const std::atomic<std::uint64_t>* counter = nullptr;
    std::uint64_t seen = 0; ///< the value of its channel
};

/// The recorder of one activity.
struct Recorder : CycleRecorder {
    recorded::ValueTape* tape = nullptr;
    std::span<Emissions> events{};
    std::span<Recorded> channels{};
};

/// Places in the section's memory, from its first line pair on.
struct Places {
    std::size_t counters_at = 0, emissions_at = 0;
    std::size_t channels_at = 0, tapes_at = 0, recorders_at = 0, recorded_at = 0, last_at = 0;
    std::array<std::size_t, max_activities> tape_at{}; ///< in the order of the activities that have one
    std::size_t bytes = 0;
};

constexpr Places places_of(const Sizes& sizes) noexcept {
    Places places;
    Layout layout;
    layout.take<recorded::Directory>();
    places.counters_at = layout.take<std::atomic<std::uint64_t>>(sizes.triggers);
    places.emissions_at = layout.take<Emissions>(sizes.emissions);
    places.channels_at = layout.take<recorded::Channel>(sizes.channels);
    places.tapes_at = layout.take<recorded::Tape>(sizes.tapes);
    places.recorders_at = layout.take<Recorder>(sizes.tapes);
    places.recorded_at = layout.take<Recorded>(sizes.channels);
    places.last_at = layout.take<std::uint64_t>(sizes.last_words);
    std::size_t tape = 0;
    for (const OfActivity& each : sizes.activities)
        if (each.channels != 0)
            places.tape_at[tape++] =
                layout.take(recorded::ValueTape::bytes_for(tape_words(each)), recorded::ValueTape::alignment);
    places.bytes = layout.used();
    return places;
}

void connect(std::span<const ReportRow> rows, MachineInstance& machine, std::span<std::byte> memory);
std::atomic<std::uint64_t>* counter(std::span<std::byte> memory, std::size_t number) noexcept;

} // namespace reporting_detail

template <std::size_t N>
struct Reporting final : ExtraSection {
    std::array<ReportRow, N> rows{};

    constexpr explicit Reporting(const std::array<ReportRow, N>& r) : rows{r} {}

    [[nodiscard]] constexpr Sentence check(const MachineView& m, const TableIndexView& r) const override {
        return reporting_detail::check(rows, m, r);
    }
    [[nodiscard]] constexpr std::size_t bytes(const MachineView& m) const override {
        // It begins on a line pair, wherever its memory begins.
        return reporting_detail::places_of(reporting_detail::sizes_of(rows, m)).bytes +
               recorded::ValueTape::alignment;
    }
    [[nodiscard]] constexpr std::string_view counts(std::size_t number) const override {
        return reporting_detail::trigger_of(rows, number);
    }
    [[nodiscard]] std::atomic<std::uint64_t>* counter(std::span<std::byte> memory,
                                                      std::size_t number) const noexcept override {
        return reporting_detail::counter(memory, number);
    }
    void connect(MachineInstance& machine, std::size_t, std::span<std::byte> memory) const override {
        reporting_detail::connect(rows, machine, memory);
    }
    [[nodiscard]] constexpr std::string_view stands_once() const override { return "reporting"; }
    [[nodiscard]] Sentence describe_stop(std::size_t) const override { return {}; } // no row stops a machine
    [[nodiscard]] SectionCount counted(std::span<const std::byte>, std::size_t) const noexcept override {
        return {}; // the reader of the tapes counts
    }
};

/// The section: rows of report(..). A component of the table must see the machine, a BrowserService, so that
/// the records can be read.
template <class... Rows>
constexpr Reporting<sizeof...(Rows)> reporting(const Rows&... rows) {
    static_assert(sizeof...(Rows) != 0, "reporting() without a row records nothing; leave the section out");
    return Reporting<sizeof...(Rows)>{{rows...}};
}

} // namespace tappet
