// Records values at the end of a cycle in the engine, and places its channels.
#include "kernel/services/reporting/reporting.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <new>

namespace tappet::reporting_detail {

namespace {

/// Returns eight bytes of a value, or as many as are left.
std::uint64_t word_at(const std::byte* from, std::size_t left) noexcept TAPPET_REALTIME {
    std::uint64_t word = 0;
    if (left >= sizeof word)
        std::memcpy(&word, from, sizeof word);
    else
        std::memcpy(&word, from, left);
    return word;
}

template <class T>
double as(std::uint64_t word) noexcept TAPPET_REALTIME {
    T value{};
    std::memcpy(&value, &word, sizeof value);
    return static_cast<double>(value);
}
double number_of(std::uint64_t word, ValueKind kind, std::uint32_t bytes) noexcept TAPPET_REALTIME {
    if (kind == ValueKind::real) return bytes == sizeof(float) ? as<float>(word) : as<double>(word);
    const bool is_signed = kind != ValueKind::natural;
    switch (bytes) {
    case 1: return is_signed ? as<std::int8_t>(word) : as<std::uint8_t>(word);
    case 2: return is_signed ? as<std::int16_t>(word) : as<std::uint16_t>(word);
    case 4: return is_signed ? as<std::int32_t>(word) : as<std::uint32_t>(word);
    default: return is_signed ? as<std::int64_t>(word) : as<std::uint64_t>(word);
    }
}

std::uint64_t word_of(const Recorded& channel, std::uint32_t i) noexcept TAPPET_REALTIME {
    return word_at(channel.value + 8 * i, channel.bytes - 8 * i);
}

/// Whether a number differs by more than its band. A NaN always does.
[[gnu::noinline]] bool is_beyond_band(const Recorded& channel, std::uint64_t word) noexcept TAPPET_REALTIME {
    const double now = number_of(word, channel.kind, channel.bytes);
    const double then = number_of(channel.last[0], channel.kind, channel.bytes);
    return !(std::abs(now - then) <= channel.band);
}

/// Whether a one-word value differs from the last recorded one; if so, it becomes the last one.
bool is_new(Recorded& channel, std::uint64_t word) noexcept TAPPET_REALTIME {
    if (channel.sequence != 0) { // the first one always is
        if (word == channel.last[0]) return false;
        if (channel.band != 0.0 && !is_beyond_band(channel, word)) return false;
    }
    channel.last[0] = word;
    return true;
}

using Pen = recorded::ValueTape::Pen;

/// Records a value that is not one whole word: separate from the common case.
[[gnu::noinline]] Pen record_bytes(Recorded& channel, Pen pen) noexcept TAPPET_REALTIME {
    const std::uint32_t words = recorded::SampleHead::of(channel.head).words;
    if (channel.every == 0 && words == 1) {
        if (!is_new(channel, word_of(channel, 0))) return pen;
    } else if (channel.every == 0) {
        bool differs = channel.sequence == 0;
        for (std::uint32_t i = 0; i < words; ++i) {
            const std::uint64_t word = word_of(channel, i);
            differs |= word != channel.last[i];
            channel.last[i] = word;
        }
        if (!differs) return pen;
    }
    pen.put(channel.head | channel.sequence++);
    for (std::uint32_t i = 0; i < words; ++i) pen.put(word_of(channel, i));
    return pen;
}

void record(CycleRecorder& self, const Cycle& cycle, bool stepped) noexcept TAPPET_REALTIME {
    auto& recorder = static_cast<Recorder&>(self);
    for (Emissions& each : recorder.events)
        each.seen = each.counter->load(std::memory_order_relaxed); // no step: this cycle sees it, or the next
    Pen pen = recorder.tape->begin();
    for (Recorded& channel : recorder.channels) {
        if (channel.every != 0) {
            if (!stepped || --channel.left != 0) continue;
            channel.left = channel.every;
        }
        if (*channel.writes == 0) continue;
        if (channel.bytes != sizeof(std::uint64_t)) {
            pen = record_bytes(channel, pen);
            continue;
        }
        std::uint64_t word = 0;
        std::memcpy(&word, channel.value, sizeof word);
        if (channel.every == 0 && !is_new(channel, word)) continue;
        pen.put(channel.head | channel.sequence++);
        pen.put(word);
    }
    recorder.tape->end(pen, to_ns(cycle.now));
}

constexpr std::uint64_t always_written = 1;

/// Fills the places of one section, channel by channel.
class Placer {
public:
    Placer(std::span<const ReportRow> rows, MachineInstance& machine, std::byte* begin)
        : rows_{rows},
          machine_{machine},
          table_{machine.machine().table},
          sizes_{sizes_of(rows, table_)},
          places_{places_of(sizes_)},
          begin_{begin} {}

    void place() {
        auto* directory = new (begin_) recorded::Directory;
        directory->bytes = places_.bytes;
        directory->channels_at = places_.channels_at;
        directory->channels = static_cast<std::uint32_t>(sizes_.channels);
        directory->tapes_at = places_.tapes_at;
        directory->tapes = static_cast<std::uint32_t>(sizes_.tapes);
        for (std::size_t t = 0; t < sizes_.triggers; ++t)
            new (at<std::atomic<std::uint64_t>>(places_.counters_at) + t) std::atomic<std::uint64_t>{0};
        for (std::size_t a = 0; a < table_.activities.size(); ++a)
            if (sizes_.activities[a].channels != 0) place_activity(a);
        machine_.observation().records_at(directory);
    }

private:
    template <class T>
    [[nodiscard]] T* at(std::size_t place) const noexcept {
        return reinterpret_cast<T*>(begin_ + place);
    }
    [[nodiscard]] std::uint64_t offset_of(const std::uint32_t& word) const noexcept {
        return static_cast<std::uint64_t>(reinterpret_cast<const std::byte*>(&word) - begin_);
    }

    void place_activity(std::size_t activity) {
        const OfActivity& of = sizes_.activities[activity];
        const std::size_t place = places_.tape_at[tapes_];
        const std::size_t first = channels_, first_event = emissions_;
        // The events come before the values of the same cycle, so that a window is open when the values
        // follow.
        for (std::size_t t = 0; t < sizes_.triggers; ++t)
            if ((of.triggers >> t & 1) != 0) add_event(t);
        for (const ReportRow& row : rows_)
            for_each_end(row, table_, [&](End end) {
                if (machine_.machine().index.activity[end.component] == activity) add(row, end, first);
            });
        auto* recorder = new (at<Recorder>(places_.recorders_at) + tapes_) Recorder;
        recorder->record = &record;
        recorder->tape = new (at<recorded::ValueTape>(place)) recorded::ValueTape{tape_words(of), of.words};
        recorder->events = {at<Emissions>(places_.emissions_at) + first_event, emissions_ - first_event};
        recorder->channels = {at<Recorded>(places_.recorded_at) + first, channels_ - first};
        new (at<recorded::Tape>(places_.tapes_at) + tapes_)
            recorded::Tape{.at = place, .activity = static_cast<std::uint32_t>(activity)};
        machine_.engines()[activity].record_values_by(recorder);
        ++tapes_;
    }

    void add_event(std::size_t number) {
        auto* emissions = new (at<Emissions>(places_.emissions_at) + emissions_++) Emissions;
        emissions->counter = at<std::atomic<std::uint64_t>>(places_.counters_at) + number;
        End event;
        static_cast<void>(resolve(table_, trigger_of(rows_, number), FacetKind::event, event)); // was checked
        const auto* value = reinterpret_cast<const std::byte*>(&emissions->seen);
        add(event, {.value = value, .writes = &emissions->seen, .bytes = sizeof emissions->seen}).is_event =
            1;
    }

    void add(const ReportRow& row, End end, std::size_t first) {
        const Facet& facet = facet_at(table_, end);
        Recorded channel{.every = row.on_change ? 0 : static_cast<std::uint32_t>(row.every),
                         .bytes = static_cast<std::uint32_t>(facet.type->size),
                         .band = row.band,
                         .kind = facet.type->kind};
        if (facet.port != nullptr) {
            const PortPlaces port = facet.port->places(machine_.facet(end), false);
            channel.value = static_cast<const std::byte*>(port.value);
            channel.writes = port.writes;
        } else {
            channel.value = static_cast<const std::byte*>(machine_.facet(end));
            channel.writes = &always_written;
        }
        recorded::Channel& told = add(end, channel);
        if (row.trigger.empty()) return;
        const std::uint64_t triggers =
            sizes_.activities[machine_.machine().index.activity[end.component]].triggers;
        const std::uint64_t below = (std::uint64_t{1} << trigger_number(rows_, row.trigger)) - 1;
        told.trigger =
            static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(std::popcount(triggers & below));
        told.before_ns = row.before.count();
        told.after_ns = row.after.count();
    }

    recorded::Channel& add(End end, const Recorded& channel) {
        auto* placed = new (at<Recorded>(places_.recorded_at) + channels_) Recorded{channel};
        const std::size_t words = recorded::words_of(channel.bytes);
        placed->head =
            recorded::SampleHead{static_cast<std::uint32_t>(channels_), static_cast<std::uint32_t>(words), 0}
                .word();
        if (channel.every == 0) {
            placed->last = at<std::uint64_t>(places_.last_at) + last_words_;
            std::fill_n(placed->last, words, 0);
            last_words_ += words;
        }
        return *new (at<recorded::Channel>(places_.channels_at) + channels_++)
            recorded::Channel{.component = static_cast<std::uint32_t>(end.component),
                              .facet = static_cast<std::uint32_t>(end.facet),
                              .bytes = channel.bytes,
                              .tape = tapes_,
                              .every = channel.every,
                              .band = channel.band,
                              .next_at = offset_of(placed->sequence)};
    }

    std::span<const ReportRow> rows_;
    MachineInstance& machine_;
    const MachineView& table_;
    Sizes sizes_;
    Places places_;
    std::byte* begin_;
    std::size_t channels_ = 0;
    std::size_t emissions_ = 0;
    std::uint32_t tapes_ = 0;
    std::size_t last_words_ = 0;
};

/// Returns where the places begin: on a line pair.
std::byte* first_of(std::span<std::byte> memory) noexcept {
    constexpr std::size_t alignment = recorded::ValueTape::alignment;
    const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
    return memory.data() + (alignment - address % alignment) % alignment;
}

} // namespace

void connect(std::span<const ReportRow> rows, MachineInstance& machine, std::span<std::byte> memory) {
    Placer{rows, machine, first_of(memory)}.place();
}

std::atomic<std::uint64_t>* counter(std::span<std::byte> memory, std::size_t number) noexcept {
    // The counters follow the directory, whatever the other sizes are.
    return reinterpret_cast<std::atomic<std::uint64_t>*>(first_of(memory) + places_of({}).counters_at) +
           number;
}

} // namespace tappet::reporting_detail
