// The four applications (thesis 4.2.3, 4.4.4, 4.5.4 and 4.6.4), each a machine table. Each activity occurs
// once less in each second than its nominal period says, so that periods drift against each other; priorities
// follow from the periods. Budgets are the loads plus a quarter.
//
// Each activity has one neighbour above and one below. The topology of data flow in figure 4.13 is that of
// the text: in the small application the activity in between separates the other two; in the concurrent one
// four activities stand in a ring of eight channels; in the large one each fills a buffer for the one above,
// and the highest sets data for all. Commands and events go both ways between neighbours, and between the
// highest and the lowest.
#pragma once

#include "kernel/machine/firmware.hpp"
#include "kernel/machine/table/machine.hpp"
#include "tests/figures/experiments/task.hpp"

#include <array>
#include <span>

namespace tappet::experiments {

/// The processor on which the program was told to run.
inline constexpr Board one_processor{
    .name = "experiments",
    .world = "host",
    .memory_budget_bytes = 4 * 1024 * 1024,
    .heap_bytes = 0,
    .processors = 1,
    .highest_priority = 80,
    .default_processor = -1, // the program's only one
    .only_warned = warn_only("realtime-kernel", "clock-source", "rt-throttling", "cpu-governor",
                             "heap-sealed", "cpu-dma-latency", "memory-locked", "memory-lockable", "swap",
                             "fifo-priority", "clock-resolution", "processors"),
};

/// Period of an activity that occurs once less in each second than `in_a_second` times.
constexpr Duration drifting(std::int64_t in_a_second) {
    return Duration{(1'000'000'000 + (in_a_second - 1) / 2) / (in_a_second - 1)};
}

// clang-format off
inline constexpr auto minimal = machine("minimal",
    components(
        component<Task>("high", set("load", 500us)),
        component<Task>("background")),
    activities(
        activity("high",       every(drifting(1000)), runs("high"), budget(625us)),
        activity("background", every(drifting(1000)), runs("background"), not_real_time)),
    connections(
        data("high.to_lower",        "background.from_higher"),
        data("background.to_higher", "high.from_lower")),
    reactions(
        uses("high.ask_lower",        "background.serve_higher"),
        uses("background.ask_higher", "high.serve_lower"),
        when("high.pulse",       tell("background.hear_higher", keep_latest)),
        when("background.pulse", tell("high.hear_lower", keep_latest))),
    behaviours());

inline constexpr auto small = machine("small",
    components(
        component<Task>("high", set("load", 500us)),
        component<Task>("low",  set("load", 500us)),
        component<Task>("background")),
    activities(
        activity("high",       every(drifting(1000)), runs("high"), budget(625us)),
        activity("low",        every(drifting(200)),  runs("low"),  budget(625us)),
        activity("background", every(drifting(1000)), runs("background"), not_real_time)),
    connections(
        data("high.to_lower",        "low.from_higher"),
        data("low.to_higher",        "high.from_lower"),
        data("low.to_lower",         "background.from_higher"),
        data("background.to_higher", "low.from_lower")),
    reactions(
        uses("high.ask_lower",        "low.serve_higher"),
        uses("low.ask_higher",        "high.serve_lower"),
        uses("low.ask_lower",         "background.serve_higher"),
        uses("background.ask_higher", "low.serve_lower"),
        uses("background.ask_lower",  "high.serve_higher"),
        uses("high.ask_higher",       "background.serve_lower"),
        when("high.pulse",       tell("low.hear_higher", keep_latest)),
        when("high.pulse",       tell("background.hear_lower", keep_latest)),
        when("low.pulse",        tell("high.hear_lower", keep_latest)),
        when("low.pulse",        tell("background.hear_higher", keep_latest)),
        when("background.pulse", tell("low.hear_lower", keep_latest)),
        when("background.pulse", tell("high.hear_higher", keep_latest))),
    behaviours());

inline constexpr auto concurrent = machine("concurrent",
    components(
        component<Task>("high",   set("load", 100us)),
        component<Task>("medium", set("load", 200us)),
        component<Task>("low",    set("load", 300us)),
        component<Task>("background")),
    activities(
        activity("high",       every(drifting(2000)), runs("high"),   budget(125us)),
        activity("medium",     every(drifting(1000)), runs("medium"), budget(250us)),
        activity("low",        every(drifting(500)),  runs("low"),    budget(375us)),
        activity("background", every(drifting(1000)), runs("background"), not_real_time)),
    connections( // eight channels
        data("high.to_lower",        "medium.from_higher"),
        data("medium.to_higher",     "high.from_lower"),
        data("medium.to_lower",      "low.from_higher"),
        data("low.to_higher",        "medium.from_lower"),
        data("low.to_lower",         "background.from_higher"),
        data("background.to_higher", "low.from_lower"),
        data("background.to_lower",  "high.from_higher"),
        data("high.to_higher",       "background.from_lower")),
    reactions(
        uses("high.ask_lower",        "medium.serve_higher"),
        uses("medium.ask_higher",     "high.serve_lower"),
        uses("medium.ask_lower",      "low.serve_higher"),
        uses("low.ask_higher",        "medium.serve_lower"),
        uses("low.ask_lower",         "background.serve_higher"),
        uses("background.ask_higher", "low.serve_lower"),
        uses("background.ask_lower",  "high.serve_higher"),
        uses("high.ask_higher",       "background.serve_lower"),
        when("high.pulse",       tell("medium.hear_higher", keep_latest)),
        when("high.pulse",       tell("background.hear_lower", keep_latest)),
        when("medium.pulse",     tell("high.hear_lower", keep_latest)),
        when("medium.pulse",     tell("low.hear_higher", keep_latest)),
        when("low.pulse",        tell("medium.hear_lower", keep_latest)),
        when("low.pulse",        tell("background.hear_higher", keep_latest)),
        when("background.pulse", tell("low.hear_lower", keep_latest)),
        when("background.pulse", tell("high.hear_higher", keep_latest))),
    behaviours());

inline constexpr auto large = machine("large",
    components(
        component<Task>("high",     set("load", 50us)),
        component<Task>("medium",   set("load", 1ms)),
        component<Task>("low",      set("load", 2ms)),
        component<Task>("very_low", set("load", 5ms)),
        component<Task>("background")),
    activities(
        activity("high",       every(drifting(1000)), runs("high"),     budget(63us)),
        activity("medium",     every(drifting(200)),  runs("medium"),   budget(1250us)),
        activity("low",        every(drifting(100)),  runs("low"),      budget(2500us)),
        activity("very_low",   every(drifting(20)),   runs("very_low"), budget(6250us)),
        activity("background", every(drifting(1000)), runs("background"), not_real_time)),
    connections(
        data("high.to_lower", "medium.from_higher"),
        data("high.to_lower", "low.from_higher"),
        data("high.to_lower", "very_low.from_higher"),
        data("high.to_lower", "background.from_higher"),
        buffer<8>("medium.fill",     "high.drain"),
        buffer<8>("low.fill",        "medium.drain"),
        buffer<8>("very_low.fill",   "low.drain"),
        buffer<8>("background.fill", "very_low.drain")),
    reactions(
        uses("high.ask_lower",        "medium.serve_higher"),
        uses("medium.ask_higher",     "high.serve_lower"),
        uses("medium.ask_lower",      "low.serve_higher"),
        uses("low.ask_higher",        "medium.serve_lower"),
        uses("low.ask_lower",         "very_low.serve_higher"),
        uses("very_low.ask_higher",   "low.serve_lower"),
        uses("very_low.ask_lower",    "background.serve_higher"),
        uses("background.ask_higher", "very_low.serve_lower"),
        uses("background.ask_lower",  "high.serve_higher"),
        uses("high.ask_higher",       "background.serve_lower"),
        when("high.pulse",       tell("medium.hear_higher", keep_latest)),
        when("high.pulse",       tell("background.hear_lower", keep_latest)),
        when("medium.pulse",     tell("high.hear_lower", keep_latest)),
        when("medium.pulse",     tell("low.hear_higher", keep_latest)),
        when("low.pulse",        tell("medium.hear_lower", keep_latest)),
        when("low.pulse",        tell("very_low.hear_higher", keep_latest)),
        when("very_low.pulse",   tell("low.hear_lower", keep_latest)),
        when("very_low.pulse",   tell("background.hear_higher", keep_latest)),
        when("background.pulse", tell("very_low.hear_lower", keep_latest)),
        when("background.pulse", tell("high.hear_higher", keep_latest))),
    behaviours());
// clang-format on

struct Application {
    std::string_view name;
    AcceptedMachine (*machine)(); ///< from a Firmware: the measured machine is the flashed one
};
/// All four accepted machines.
std::span<const Application> applications();

} // namespace tappet::experiments
