// Checks of loops: gain times period times delay. An unstable loop does not compile; a loop that will
// overshoot is reported.
#pragma once

#include "kernel/base/decimal.hpp"
#include "kernel/control/check_flow.hpp"
#include "kernel/control/stability.hpp"

#include <limits>

namespace tappet::control_detail {

/// Formats three digits, with a power of ten for small numbers: 0.148, 7.4e-4.
constexpr Sentence in_digits(double value) {
    std::int64_t tens = 0;
    if (value > 0.0 && value < 0.1)
        for (; value < 1.0; value *= 10.0) --tens;
    const Sentence text = decimal(value);
    return tens == 0 ? text : Sentence{text, "e", tens};
}

template <class... Pieces>
constexpr Sentence of_loop(const LoopRow& row, const Pieces&... fault) {
    return Sentence{"loop \"", row.name, "\": ", fault...};
}

/// Finds the value that the table gives to a numeric property.
constexpr Sentence find_value(const MachineView& m, std::string_view path, End& end, double& value) {
    if (Sentence fault = resolve(m, path, FacetKind::property, end); !fault.empty()) return fault;
    const Facet& facet = facet_at(m, end);
    if (facet.kind != FacetKind::property || facet.type->kind != ValueKind::real)
        return Sentence{"\"", path,
                        "\" is not a property that is a number; name the one that holds the gain"};
    for (const PropertyRow& each : m.components[end.component].settings)
        if (same_text(each.name, facet.name)) {
            value = each.setting.kind == PropertySetting::Kind::integer
                        ? static_cast<double>(each.setting.integer)
                        : each.setting.real;
            return {};
        }
    return Sentence{"the table does not set \"",
                    path,
                    "\", which decides whether the loop is stable; add set(\"",
                    facet.name,
                    "\", ...) to the row of \"",
                    m.components[end.component].name,
                    "\""};
}

/// Steps of the Controller's period, and how many of them vary from step to step.
struct Delay {
    std::size_t steps = 0, varying = 0;
};

constexpr std::size_t in_steps_of(Duration period, Duration late) {
    return static_cast<std::size_t>(late / period + (late % period > Duration::zero() ? 1 : 0));
}

/// Returns the delay that a row causes. A value from another activity is as old as that activity's period and
/// response just before the next value arrives; a value for another activity waits for its next cycle.
constexpr Delay delay_of(const MachineView& m, const TableIndexView& r, std::size_t x, bool along,
                         Duration period) {
    const ConnectionRow& row = m.connections[x];
    const std::size_t from = r.activity[r.connections[x].from.component];
    const std::size_t into = r.activity[r.connections[x].to.component];
    Duration always = row.delayed_step ? m.activities[into].period : Duration::zero();
    if (row.transition == RateTransition::interpolate) always += m.activities[from].period;
    Duration varying{};
    if (from != into)
        varying = m.activities[along ? into : from].period + Duration{r.worst_response_ns[from]};
    return {in_steps_of(period, always + varying), in_steps_of(period, varying)};
}

/// Returns the largest delay in steps over all paths from a Controller: against the flow to Sensors, or along
/// it to Effectors, of any level.
constexpr Delay most_delayed(const MachineView& m, const TableIndexView& r, const Seats& seats,
                             std::size_t component, bool along, Duration period, std::size_t depth = 0) {
    if (depth > 8) return {};
    const RowsByComponent& rows = along ? r.connections_from : r.connections_into;
    Delay most;
    for (std::size_t x = rows.first[component]; x != nowhere; x = rows.next[x]) {
        const Link& link = r.connections[x];
        const DataPath* path = path_between(seats, link.from.component, link.to.component);
        // Sent values, set points and the model of outputs close other loops.
        if (path == nullptr || path->of_last_step || (!along && path->from == ControlRole::generator))
            continue;
        Delay late = delay_of(m, r, x, along, period);
        if (path->to != ControlRole::effector && path->from != ControlRole::sensor) {
            const Delay beyond = most_delayed(m, r, seats, along ? link.to.component : link.from.component,
                                              along, period, depth + 1);
            late = {late.steps + beyond.steps, late.varying + beyond.varying};
        }
        most = {std::max(most.steps, late.steps), std::max(most.varying, late.varying)};
    }
    return most;
}

/// Returns the dead time in steps beyond the one that sampling takes: delayed rows and transport time.
constexpr Delay dead_samples(const LoopRow& row, const MachineView& m, const TableIndexView& r,
                             const Seats& seats, std::size_t component, Duration period) {
    const Delay before = most_delayed(m, r, seats, component, false, period);
    const Delay behind = most_delayed(m, r, seats, component, true, period);
    return {before.steps + behind.steps + in_steps_of(period, row.transport),
            before.varying + behind.varying};
}

/// A properties file, a script and people set the gains within their ranges while the machine runs.
constexpr Sentence check_by_hand(const LoopRow& row, Range by_hand, Range integral_by_hand, double bound,
                                 double longest, std::size_t dead, std::size_t varying) {
    for (const double kp : {by_hand.low, by_hand.high})
        for (const double ki : {integral_by_hand.low, integral_by_hand.high}) {
            const SampledLoop extreme{kp * row.factor * longest, ki * row.factor * longest * longest, dead,
                                      varying};
            if ((kp == 0.0 && ki == 0.0) || (kp > 0.0 && is_stable(extreme))) continue;
            return of_loop(row, "people may set ", row.gain,
                           kp < std::numeric_limits<double>::infinity() ? " to " : " to anything",
                           kp < std::numeric_limits<double>::infinity() ? in_digits(kp) : Sentence{},
                           row.integral.empty() ? "" : " and ",
                           row.integral.empty() ? Sentence{} : Sentence{row.integral, " to ", in_digits(ki)},
                           " while it runs, which is not stable; give ",
                           row.integral.empty() ? "it a range" : "both a range", " of stable gains, below ",
                           in_digits(bound / (row.factor * longest)));
        }
    return {};
}

constexpr Sentence check_loop(const LoopRow& row, const MachineView& m, const TableIndexView& r,
                              const Seats& seats) {
    End end;
    double gain = 0.0, integral = 0.0;
    if (row.gain.empty())
        return of_loop(row, "it has no gain; name the Controller's property: gain(\"...\")");
    if (Sentence fault = find_value(m, row.gain, end, gain); !fault.empty()) return of_loop(row, fault);
    const std::size_t component = end.component;
    const Range by_hand = facet_at(m, end).range;
    Range integral_by_hand{0.0, 0.0};
    bool is_controller = false;
    for (const Seat& each : seats)
        is_controller |= each.component == component && each.role == ControlRole::controller;
    if (!is_controller)
        return of_loop(row, "\"", m.components[component].name,
                       "\" is not a Controller of a level; name the property of one");
    if (!row.integral.empty()) {
        if (Sentence fault = find_value(m, row.integral, end, integral); !fault.empty())
            return of_loop(row, fault);
        integral_by_hand = facet_at(m, end).range;
        if (end.component != component)
            return of_loop(row, "its two gains belong to different components; name two of one component");
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (!(gain > 0.0 && gain < infinity && integral >= 0.0 && integral < infinity && row.factor > 0.0 &&
          row.factor < infinity && row.transport >= Duration::zero()))
        return of_loop(row, "its gains, stiffness and transport must be positive; if the feedback has the "
                            "other sign, invert it in the Sensor");
    const ActivityRow& activity = m.activities[r.activity[component]];
    const auto [dead, varying] = dead_samples(row, m, r, seats, component, activity.period);
    if (dead > max_dead_samples)
        return of_loop(row, "its transport is more than ", max_dead_samples, " periods; sample more slowly");
    // A step may send at once, and the next one at the end of its response: the first value then lasts longer
    // by that time.
    const Duration jitter{r.worst_response_ns[r.activity[component]]};
    const double period = to_seconds(activity.period), longest = to_seconds(activity.period + jitter);
    const auto with = [&](double seconds) {
        return SampledLoop{gain * row.factor * seconds, integral * row.factor * seconds * seconds, dead,
                           varying};
    };
    const auto say = [&](double bound, std::string_view what, std::string_view otherwise) {
        return of_loop(row, "gain times period is ", in_digits(with(longest).proportional),
                       jitter == Duration::zero() ? "" : " at the longest period", ", but with ", dead,
                       dead == 1 ? " step" : " steps", varying != 0 ? " of varying delay" : " of delay", what,
                       in_digits(bound), "; set ", row.gain, " below ",
                       in_digits(bound / (row.factor * longest)), otherwise);
    };
    const double bound = varying != 0 ? most_stable_at_any_delay(dead) : most_stable(dead);
    if (!is_stable(with(longest)) || !is_stable(with(period))) {
        if (with(longest).proportional >= bound)
            return say(bound, " the loop is stable only below ", ", or shorten the delay");
        return of_loop(row, "it is not stable with an integral gain of ", in_digits(integral), "; set ",
                       row.integral, " lower");
    }
    if (!row.may_overshoot && integral > 0.0)
        return of_loop(row,
                       "with an integral around an axis it overshoots after each step of the set point; add "
                       "may_overshoot if that does no harm, or leave the integral out");
    if (!row.may_overshoot && with(longest).proportional > most_without_overshoot(dead) * (1 + 1e-9))
        return say(most_without_overshoot(dead), " the loop overshoots above ",
                   ", or add may_overshoot if that does no harm");
    return check_by_hand(row, by_hand, integral_by_hand, bound, longest, dead, varying);
}

constexpr Sentence check_loops(const ControlView& c, const MachineView& m, const TableIndexView& r,
                               const Seats& seats) {
    for (const LoopRow& row : c.loops)
        if (Sentence fault = check_loop(row, m, r, seats); !fault.empty()) return fault;
    return {};
}

} // namespace tappet::control_detail
