// The compiler's part of reporting: refuses wrong rows of a report, and computes the size of its records.
#pragma once

#include "kernel/base/compare.hpp"
#include "kernel/machine/plan/places.hpp"
#include "kernel/machine/table/section.hpp"
#include "kernel/services/reporting/layout.hpp"
#include "kernel/services/reporting/rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <span>

namespace tappet::reporting_detail {

/// A tape holds what its activity records in this time at most: a reader that polls as often misses nothing.
inline constexpr Duration tape_span = 500ms;
inline constexpr std::size_t fewest_tape_words = 256;

/// Whether the type describes all bytes of its values.
constexpr bool can_be_told(TypeId type) noexcept {
    if (type == nullptr || type->kind == ValueKind::opaque || type->kind == ValueKind::arguments)
        return false;
    if (type->element != nullptr && !can_be_told(type->element)) return false;
    for (const RecordField& field : type->fields)
        if (!can_be_told(field.type)) return false;
    return true;
}

constexpr bool is_number(const TypeTag& type) noexcept {
    return type.kind == ValueKind::real || type.kind == ValueKind::integer ||
           type.kind == ValueKind::natural || type.kind == ValueKind::duration;
}

/// Says what keeps a facet from being recorded, with the cure; empty: nothing does.
constexpr Sentence hindrance(const Facet& facet) {
    if (facet.kind != FacetKind::output && facet.kind != FacetKind::property)
        return Sentence{to_text(facet.kind), " has no current value; name an output or a property"};
    if (!can_be_told(facet.type))
        return Sentence{"its type ", facet.type->name, " has unknown fields; name its fields with fields_of"};
    if (facet.type->size > recorded::most_value_bytes)
        return Sentence{"its value has ", facet.type->size, " bytes, more than the ",
                        recorded::most_value_bytes,
                        " that are recorded; write the interesting part to its own output"};
    return {};
}

constexpr std::size_t all_outputs = nowhere; ///< as a facet: all recordable outputs of the component

/// Finds the value of a row. For "component.*" the result is the component and all_outputs.
constexpr Sentence find(const ReportRow& row, const MachineView& m, std::span<const std::size_t> by_name,
                        End& found) {
    if (row.what.ends_with(".*")) {
        const std::string_view name = row.what.substr(0, row.what.size() - 2);
        found = {by_name.empty() ? find_component(m, name) : find_component(m, by_name, name), all_outputs};
        return found.component == nowhere ? unknown_component(m, name) : Sentence{};
    }
    return resolve(m, by_name, row.what, FacetKind::output, found);
}

/// Calls `take` with each value that a checked row names.
template <class Take>
constexpr void for_each_end(const ReportRow& row, const MachineView& m, Take take) {
    End end;
    static_cast<void>(find(row, m, {}, end));
    if (end.facet != all_outputs) return take(end);
    const auto facets = m.components[end.component].type->facets;
    for (std::size_t f = 0; f < facets.size(); ++f)
        if (facets[f].kind == FacetKind::output && hindrance(facets[f]).empty()) take(End{end.component, f});
}

/// Returns the number of a window's event among the events of all rows.
constexpr std::size_t trigger_number(std::span<const ReportRow> rows, std::string_view event) noexcept {
    std::size_t number = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (same_text(rows[i].trigger, event)) return number;
        bool is_first = !rows[i].trigger.empty();
        for (std::size_t j = 0; j < i && is_first; ++j)
            is_first = !same_text(rows[j].trigger, rows[i].trigger);
        number += is_first ? 1 : 0;
    }
    return number;
}
/// Returns the event of that number; empty: none.
constexpr std::string_view trigger_of(std::span<const ReportRow> rows, std::size_t number) noexcept {
    for (const ReportRow& row : rows)
        if (!row.trigger.empty() && trigger_number(rows, row.trigger) == number) return row.trigger;
    return {};
}

/// Sizes of one activity's records.
struct OfActivity {
    std::size_t channels = 0;
    std::uint64_t triggers = 0; ///< a bit for each event, by its number; each event has a channel of its own
    std::size_t words = 0;      ///< of a cycle that records all channels
    std::size_t span_words = 0; ///< of tape_span, at most
};

struct Sizes {
    std::array<OfActivity, max_activities> activities{};
    std::size_t channels = 0;
    std::size_t tapes = 0;
    std::size_t last_words = 0; ///< of the values that are compared
    std::size_t triggers = 0;   ///< events
    std::size_t emissions = 0;  ///< channels of events
};

/// Returns the number of an activity's cycles within tape_span.
constexpr std::size_t cycles_of(const ActivityRow& row) noexcept {
    const Duration each = row.periodic() ? row.period : row.at_most_per;
    const std::int64_t runs = row.periodic() ? 1 : row.at_most_n;
    return each > Duration::zero() ? static_cast<std::size_t>(runs * (tape_span / each + 1))
                                   : std::size_t{64};
}

constexpr Sizes sizes_of(std::span<const ReportRow> rows, const MachineView& m) {
    Sizes sizes;
    const auto add = [&](std::size_t activity, std::size_t words, std::size_t every, bool is_compared) {
        OfActivity& of = sizes.activities[activity];
        const std::size_t cycles = cycles_of(m.activities[activity]);
        if (of.channels++ == 0) {
            ++sizes.tapes;
            of.words = recorded::Moment::words_beside_samples;
            of.span_words = of.words * cycles;
        }
        ++sizes.channels;
        of.words += 1 + words;
        of.span_words += (1 + words) * (cycles / every + 1);
        if (is_compared) sizes.last_words += words;
    };
    for (const ReportRow& row : rows)
        for_each_end(row, m, [&](End end) {
            const std::size_t activity = activity_of(m, m.components[end.component].name);
            add(activity, recorded::words_of(facet_at(m, end).type->size),
                row.on_change ? 1 : static_cast<std::size_t>(row.every), row.on_change);
            if (row.trigger.empty()) return;
            const std::uint64_t bit = std::uint64_t{1} << trigger_number(rows, row.trigger);
            if ((sizes.activities[activity].triggers & bit) != 0) return;
            sizes.activities[activity].triggers |= bit;
            ++sizes.emissions;
            add(activity, 1, 1, true);
        });
    while (!trigger_of(rows, sizes.triggers).empty()) ++sizes.triggers;
    return sizes;
}

/// Returns a power of two, so large that one moment uses at most an eighth.
constexpr std::size_t tape_words(const OfActivity& of) noexcept {
    return std::bit_ceil(std::max({fewest_tape_words, 8 * of.words, of.span_words}));
}

/// Returns the fault of a row's window.
constexpr Sentence check_window(const ReportRow& row, const MachineView& m, const TableIndexView& r) {
    if (row.before < Duration::zero() || row.after < Duration::zero())
        return Sentence{"its window has a negative time; write how long before and after the event"};
    const bool is_empty = row.before == Duration::zero() && row.after == Duration::zero();
    if (row.trigger.empty())
        return is_empty ? Sentence{}
                        : Sentence{"before and after need an event; add trigger(\"component.event\")"};
    End event;
    if (Sentence fault = resolve(m, r.by_name, row.trigger, FacetKind::event, event); !fault.empty())
        return fault;
    if (facet_at(m, event).kind != FacetKind::event)
        return Sentence{"\"", row.trigger, "\" is ", to_text(facet_at(m, event).kind),
                        ", but a window needs an event; name one"};
    if (is_empty)
        return Sentence{"its window around \"", row.trigger,
                        "\" is empty; add before(...), after(...) or both"};
    return {};
}

constexpr Sentence check_row(const ReportRow& row, const MachineView& m, const TableIndexView& r) {
    End end;
    if (Sentence fault = find(row, m, r.by_name, end); !fault.empty()) return fault;
    if (row.every <= 0)
        return Sentence{"every(", row.every, ") records nothing; write every(1) for each step, or more"};
    if (row.every > std::numeric_limits<std::int32_t>::max())
        return Sentence{"every(", row.every, ") is more steps than are counted; write fewer"};
    if (!(row.band >= 0.0 && row.band < std::numeric_limits<double>::infinity()))
        return Sentence{"its band is negative or not a finite number; give the largest change to ignore, or "
                        "leave it out to record every change"};
    if (m.components[end.component].type->loop != nullptr)
        return Sentence{"\"", m.components[end.component].name,
                        "\" has a loop() but no step(), after which it could be recorded; give it a step()"};
    if (Sentence fault = check_window(row, m, r); !fault.empty()) return fault;
    if (end.facet == all_outputs) {
        std::size_t outputs = 0;
        for_each_end(row, m, [&](End) { ++outputs; });
        if (outputs == 0)
            return Sentence{"\"", m.components[end.component].name,
                            "\" has no output that can be recorded; leave it out"};
        if (row.band != 0.0)
            return Sentence{"a band has the unit of one value, but this row names several; name one value"};
        return {};
    }
    if (Sentence fault = hindrance(facet_at(m, end)); !fault.empty()) return fault;
    if (row.band != 0.0 && !is_number(*facet_at(m, end).type))
        return Sentence{"its type is ", facet_at(m, end).type->name,
                        ", which has no band; write on_change() for any change"};
    return {};
}

constexpr Sentence check(std::span<const ReportRow> rows, const MachineView& m, const TableIndexView& r) {
    if (find_observer(m) == nowhere)
        return Sentence{
            "reporting: no component can read what is recorded; add component<BrowserService>(\"browser\")"};
    std::size_t channels = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto said = [&](const Sentence& fault) {
            return Sentence{"report \"", rows[i].what, "\": ", fault};
        };
        if (const Sentence fault = check_row(rows[i], m, r); !fault.empty()) return said(fault);
        Sentence twice;
        for_each_end(rows[i], m, [&](End end) {
            ++channels;
            for (std::size_t j = 0; j < i; ++j)
                for_each_end(rows[j], m, [&](End other) {
                    if (other == end)
                        twice = Sentence{"the row of \"", rows[j].what, "\" records \"",
                                         facet_at(m, end).name, "\" already; keep one"};
                });
        });
        if (!twice.empty()) return said(twice);
    }
    if (!trigger_of(rows, recorded::most_triggers).empty())
        return Sentence{"reporting: its windows are around more than ", recorded::most_triggers,
                        " events; use one event for several windows"};
    if (channels > recorded::most_channels)
        return Sentence{"reporting: it records ", channels, " values, more than the limit of ",
                        recorded::most_channels, "; leave some out"};
    return {};
}

} // namespace tappet::reporting_detail
