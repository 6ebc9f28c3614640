// Recording: names, rates, bands, and the reader of the recording.
#include "tests/diagnostics/rows/fault.hpp"

namespace camera {
struct Raw {
    int number = 0;
};
} // namespace camera

namespace {

using namespace tappet;
using namespace tappet::diagnostics;

struct Frames {
    Output<camera::Raw> last;
    Output<std::array<double, 600>> samples;
    static constexpr auto interface() {
        return facets(output<&Frames::last>("last", "", "as it came"),
                      output<&Frames::samples>("samples", "", "of a turn"));
    }
};
struct Door {
    static constexpr bool sees_machine = true;
    Output<bool> open;
    void work(const Cycle&) {}
    static constexpr auto interface() { return facets(output<&Door::open>("open", "", "it is")); }
};
struct Deaf {
    Output<camera::Raw> last;
    Event<> heard;
    static constexpr auto interface() {
        return facets(output<&Deaf::last>("last", "", "as it came"), event<&Deaf::heard>("heard", "never"));
    }
};
struct Own {
    Output<double> speed;
    void loop(LoopControl&) {}
    void break_loop() {}
    static constexpr auto interface() { return facets(output<&Own::speed>("speed", "m/s", "of it")); }
};

/// The small loom with a browser, and a report.
Table reported() {
    Table table = small_loom();
    table.add(component<Door>("door"));
    table.add(component<Frames>("frames"));
    table.add(component<Deaf>("deaf"));
    table.add(component<Own>("own"));
    table.add(activity("outside", every(20ms), not_real_time, runs("door", "frames", "deaf")));
    table.add(activity("alone", on_work(), not_real_time, runs("own")));
    table.reports.emplace_back().rows = {report("shaft.speed", every(2)), report("weft.*", on_change())};
    return table;
}

void record(Table& m, const ReportRow& row) { m.reports.front().rows.push_back(row); }

constexpr Fault faults[] = {
    {"report_of_nobody", [](Table& m) { record(m, report("shatf.speed")); },
     R"(loom: report "shatf.speed": there is no component "shatf"; did you mean "shaft"?)"},
    {"report_of_nothing", [](Table& m) { record(m, report("tension.torqe")); },
     R"(loom: report "tension.torqe": component "tension" has no output "torqe"; did you mean "torque"?)"},
    {"report_of_a_whole_nobody", [](Table& m) { record(m, report("tensoin.*")); },
     R"(loom: report "tensoin.*": there is no component "tensoin"; did you mean "tension"?)"},
    {"report_without_a_facet", [](Table& m) { record(m, report("tension")); },
     R"(loom: report "tension": "tension" is not of the form "component.output"; name both)"},
    {"report_of_an_input", [](Table& m) { record(m, report("tension.speed")); },
     R"(loom: report "tension.speed": an input has no current value; name an output or a property)"},
    {"report_of_a_buffer", [](Table& m) { record(m, report("encoder.samples")); },
     R"(loom: report "encoder.samples": a buffered output has no current value; name an output or a property)"},
    {"report_of_an_event", [](Table& m) { record(m, report("weft.broken")); },
     R"(loom: report "weft.broken": an event has no current value; name an output or a property)"},
    {"report_of_what_nobody_knows", [](Table& m) { record(m, report("frames.last")); },
     R"(loom: report "frames.last": its type camera::Raw has unknown fields; name its fields with fields_of)"},
    {"report_of_too_much", [](Table& m) { record(m, report("frames.samples")); },
     R"(loom: report "frames.samples": its value has 4800 bytes, more than the 4096 that are recorded; write the interesting part to its own output)"},
    {"report_of_a_component_without_outputs", [](Table& m) { record(m, report("deaf.*")); },
     R"(loom: report "deaf.*": "deaf" has no output that can be recorded; leave it out)"},
    {"report_of_a_loop", [](Table& m) { record(m, report("own.speed")); },
     R"(loom: report "own.speed": "own" has a loop() but no step(), after which it could be recorded; give it a step())"},
    {"report_every_0", [](Table& m) { record(m, report("tension.torque", every(0))); },
     R"(loom: report "tension.torque": every(0) records nothing; write every(1) for each step, or more)"},
    {"report_every_minus_1", [](Table& m) { record(m, report("tension.torque", every(-1))); },
     R"(loom: report "tension.torque": every(-1) records nothing; write every(1) for each step, or more)"},
    {"report_never_again", [](Table& m) { record(m, report("tension.torque", every(3'000'000'000))); },
     R"(loom: report "tension.torque": every(3000000000) is more steps than are counted; write fewer)"},
    {"report_negative_band", [](Table& m) { record(m, report("tension.torque", on_change(-0.5))); },
     R"(loom: report "tension.torque": its band is negative or not a finite number; give the largest change to ignore, or leave it out to record every change)"},
    {"report_endless_band",
     [](Table& m) {
         record(m, report("tension.torque", on_change(std::numeric_limits<double>::infinity())));
     },
     R"(loom: report "tension.torque": its band is negative or not a finite number; give the largest change to ignore, or leave it out to record every change)"},
    {"report_band_of_no_number", [](Table& m) { record(m, report("shaft.reversed", on_change(0.5))); },
     R"(loom: report "shaft.reversed": its type is bool, which has no band; write on_change() for any change)"},
    {"report_band_of_several", [](Table& m) { record(m, report("tension.*", on_change(0.5))); },
     R"(loom: report "tension.*": a band has the unit of one value, but this row names several; name one value)"},
    {"report_window_without_event", [](Table& m) { record(m, report("tension.torque", before(1ms))); },
     R"(loom: report "tension.torque": before and after need an event; add trigger("component.event"))"},
    {"report_window_around_nothing",
     [](Table& m) { record(m, report("tension.torque", after(1s), trigger("weft.brokne"))); },
     R"(loom: report "tension.torque": component "weft" has no event "brokne"; did you mean "broken"?)"},
    {"report_window_around_a_port",
     [](Table& m) { record(m, report("tension.torque", after(1s), trigger("weft.reference"))); },
     R"(loom: report "tension.torque": "weft.reference" is an output, but a window needs an event; name one)"},
    {"report_window_empty", [](Table& m) { record(m, report("tension.torque", trigger("weft.broken"))); },
     R"(loom: report "tension.torque": its window around "weft.broken" is empty; add before(...), after(...) or both)"},
    {"report_window_negative",
     [](Table& m) { record(m, report("tension.torque", before(-1ms), trigger("weft.broken"))); },
     R"(loom: report "tension.torque": its window has a negative time; write how long before and after the event)"},
    {"report_twice", [](Table& m) { record(m, report("shaft.speed", on_change())); },
     R"(loom: report "shaft.speed": the row of "shaft.speed" records "speed" already; keep one)"},
    {"report_twice_by_all", [](Table& m) { record(m, report("weft.reference")); },
     R"(loom: report "weft.reference": the row of "weft.*" records "reference" already; keep one)"},
    {"reporting_for_nobody",
     [](Table& m) {
         std::erase_if(m.components, [](const ComponentRow& row) { return row.name == "door"; });
         m.put(activity("outside", every(20ms), not_real_time, runs("frames", "deaf")));
     },
     R"(loom: reporting: no component can read what is recorded; add component<BrowserService>("browser"))"},
    {"reporting_twice", [](Table& m) { m.reports.emplace_back().rows = {report("tension.torque")}; },
     R"(loom: reporting(...) appears twice; write all of its rows into one)"},
};
INSTANTIATE_TEST_SUITE_P(reporting, Refusal, planted_into(reported, faults), name_of);

} // namespace
