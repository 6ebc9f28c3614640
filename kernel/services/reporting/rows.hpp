// The recorded values of a machine, as rows of the table (thesis 3.3, Reporting):
//     reporting(report("shaft.position", every(2)),
//               report("tension.force", on_change(0.5)),
//               report("weft.*", on_change(), before(200ms), after(1s), trigger("weft.missed")))
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/statechart/rows.hpp"

#include <cstdint>
#include <string_view>

namespace tappet {

struct ReportRow {
    std::string_view what{}; ///< "component.facet", or "component.*": all its outputs
    std::int64_t every = 1;  ///< the number of steps of its activity
    bool on_change = false;
    double band = 0.0;
    std::string_view trigger{}; ///< the event around which its samples count
    Duration before{};
    Duration after{};
};

/// Records it in the first step of its activity and in each n-th step after it. The default: in each step.
constexpr RowOption<ReportRow, std::int64_t> every(std::int64_t steps) noexcept {
    return {&ReportRow::every, steps};
}
struct OnChange {
    double band;
};
/// Records it when it differs after a cycle from the last recorded value: by more than `band`, in its unit.
constexpr OnChange on_change(double band = 0.0) noexcept { return {band}; }
/// Keeps the records of this time before the event, in a row with a trigger. For the time after it:
/// after(time).
constexpr RowOption<ReportRow, Duration> before(Duration time) noexcept { return {&ReportRow::before, time}; }
/// Keeps recorded values around this event only: "component.event".
constexpr RowOption<ReportRow, std::string_view> trigger(std::string_view event) noexcept {
    return {&ReportRow::trigger, event};
}

namespace detail {

constexpr void apply(ReportRow& row, OnChange option) noexcept {
    row.on_change = true;
    row.band = option.band;
}
constexpr void apply(ReportRow& row, statechart::After option) noexcept { row.after = option.time; }

} // namespace detail

/// An output or a property, and when to record it: every(steps) or on_change(band).
template <class... Options>
constexpr ReportRow report(std::string_view what, const Options&... options) {
    ReportRow row{.what = what};
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
