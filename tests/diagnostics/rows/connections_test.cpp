// Connections: their two ends, and their options for the values.
#include "tests/diagnostics/rows/fault.hpp"
#include "tests/diagnostics/small_machine.hpp"

namespace {

using namespace small;
using namespace tappet::diagnostics;

/// Ports that small_machine.hpp lacks.
struct Talker {
    Output<Text<8>> word;
    Output<std::int8_t> count;
    Output<float> share;
    void step(const Cycle&) noexcept TAPPET_REALTIME { count.write(1); }
    static constexpr auto interface() {
        return facets(output<&Talker::word>("word", "", "that it says"),
                      output<&Talker::count>("count", "", "of its words"),
                      output<&Talker::share>("share", "", "of silence"));
    }
};
struct Hearer {
    Input<Text<8>> word;
    Input<std::int8_t> count, pulse;
    Input<float> share;
    Input<double> loud, damp;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(input<&Hearer::word>("word", "", "that it hears", optional),
                      input<&Hearer::count>("count", "", "of the words", optional),
                      input<&Hearer::share>("share", "", "of silence", optional),
                      input<&Hearer::loud>("loud", "", "as it was", optional),
                      input<&Hearer::damp>("damp", "%", "the air", optional),
                      input<&Hearer::pulse>("pulse", "", "of who talks", optional, grows_stale));
    }
};
void add_talk(Table& m, const ConnectionRow& row) {
    m.add(component<Talker>("talker"), "logic");
    m.add(component<Hearer>("hearer"), "logic");
    m.add(row);
}

/// A driver's output and input, as its map makes them.
struct Wire {
    Output<double> level;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(output<&Wire::level>("level", "", "that is received", comes_every(10ms)));
    }
};
struct Valve {
    Input<double> wanted;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(input<&Valve::wanted>("wanted", "", "that is set", needs_wake));
    }
};
void add_wire(Table& m, const ConnectionRow& row) {
    m.add(component<Wire>("wire"), "motion");
    m.add(row);
}

constexpr float standing = 0;
constexpr int at_rest = 0;
constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// The row from the encoder to the shaft with other options.
void measured(Table& m, const auto&... options) {
    m.put(data("encoder.angle", "shaft.measured", options...));
}

constexpr Fault end_faults[] = {
    {"connection_missing", [](Table& m) { m.connections = {data("encoder.angle", "shaft.measured")}; },
     R"(loom: component "tension": its required input "speed" is not connected; add data("...", "tension.speed"))"},
    {"connection_twice", [](Table& m) { m.connections[2] = m.connections[1]; },
     R"(loom: connection "shaft.speed" -> "tension.speed" appears twice in connections(...), rows 2 and 3; remove one)"},
    {"connection_ring", [](Table& m) { m.connections[2] = data("tension.torque", "shaft.reference"); },
     R"(loom: connection "tension.torque" -> "shaft.reference" closes a data-flow cycle inside activity "motion" (shaft -> tension -> shaft); add delayed to the row whose reader may use the last cycle's value)"},
    {"connection_component_unknown", [](Table& m) { m.put(data("encodr.angle", "shaft.measured")); },
     R"(loom: connection "encodr.angle" -> "shaft.measured": there is no component "encodr"; did you mean "encoder"?)"},
    {"connection_component_missing", [](Table& m) { m.put(data("gearbox.angle", "shaft.measured")); },
     R"(loom: connection "gearbox.angle" -> "shaft.measured": there is no component "gearbox"; add it to components(...))"},
    {"connection_port_unknown", [](Table& m) { m.connections[0] = data("encoder.angle", "shaft.mesured"); },
     R"(loom: connection "encoder.angle" -> "shaft.mesured": component "shaft" has no input "mesured"; did you mean "measured"?)"},
    {"connection_port_missing", [](Table& m) { m.put(data("shaft.oil_pressure", "tension.speed")); },
     R"(loom: connection "shaft.oil_pressure" -> "tension.speed": component "shaft" has no output "oil_pressure"; add it to the component's interface)"},
    {"connection_without_port", [](Table& m) { m.put(data("shaft", "tension.speed")); },
     R"(loom: connection "shaft" -> "tension.speed": "shaft" is not of the form "component.output"; name both)"},
    {"connection_exchanged", [](Table& m) { m.connections[0] = data("shaft.measured", "encoder.angle"); },
     R"(loom: connection "shaft.measured" -> "encoder.angle" runs from an input to an output; exchange the two)"},
    {"connection_from_an_event", [](Table& m) { m.put(data("weft.broken", "shaft.reference")); },
     R"(loom: connection "weft.broken" -> "shaft.reference": "weft.broken" is an event, not an output; name an output first)"},
    {"connection_from_an_input", [](Table& m) { m.put(data("tension.speed", "shaft.reference")); },
     R"(loom: connection "tension.speed" -> "shaft.reference": "tension.speed" is an input, not an output; name an output first)"},
    {"connection_to_an_output", [](Table& m) { m.add(data("encoder.angle", "tension.torque")); },
     R"(loom: connection "encoder.angle" -> "tension.torque": "tension.torque" is an output, not an input; name an input second)"},
    {"connection_to_itself", [](Table& m) { m.put(data("shaft.speed", "shaft.reference")); },
     R"(loom: connection "shaft.speed" -> "shaft.reference": a component's own output feeds its own input; add delayed, or keep the value in the component)"},
    {"connection_types", [](Table& m) { m.put(data("encoder.turns", "shaft.measured")); },
     R"(loom: connection "encoder.turns" -> "shaft.measured": "encoder.turns" is of type int but "shaft.measured" is of type double; connect ports of one type)"},
    {"connection_units", [](Table& m) { m.put(data("encoder.angle", "tension.speed")); },
     R"(loom: connection "encoder.angle" -> "tension.speed": "encoder.angle" is in deg but "tension.speed" in rpm; connect ports of one unit, or correct the unit of one of them)"},
    {"connection_unit_sizes", [](Table& m) { m.add(data("shaft.speed", "tension.rate")); },
     R"(loom: connection "shaft.speed" -> "tension.rate": "shaft.speed" is in rpm but "tension.rate" in deg/s, another unit of the same quantity; add converted to the row)"},
    {"connection_converted_kinds",
     [](Table& m) { m.add(data("climate.humidity", "tension.rate", converted)); },
     R"(loom: connection "climate.humidity" -> "tension.rate": there is no conversion from % to deg/s; write scaled(factor) if you know one, or correct a unit)"},
    {"connection_converted_without_a_unit",
     [](Table& m) { m.put(data("tension.torque", "shaft.measured", converted)); },
     R"(loom: connection "tension.torque" -> "shaft.measured": there is no conversion from N m to no unit; write scaled(factor) if you know one, or correct a unit)"},
    {"connection_scaled_wrongly", [](Table& m) { m.add(data("shaft.speed", "tension.rate", scaled(60))); },
     R"(loom: connection "shaft.speed" -> "tension.rate": its factor does not convert rpm to deg/s; write converted, and the compiler computes it)"},
    {"connection_scaled_twice",
     [](Table& m) { m.add(data("shaft.speed", "tension.rate", scaled(6), converted)); },
     R"(loom: connection "shaft.speed" -> "tension.rate" has both scaled and converted; keep one)"},
    {"connection_scaled_buffer",
     [](Table& m) { m.add(buffer<4>("encoder.samples", "shaft.samples", scaled(2))); },
     R"(loom: connection "encoder.samples" -> "shaft.samples": a buffer cannot be scaled, only a port of double or float; convert it in a component)"},
    {"connection_two_writers",
     [](Table& m) { m.connections.insert(m.connections.begin(), data("tension.torque", "shaft.reference")); },
     R"(loom: connection "weft.reference" -> "shaft.reference": "shaft.reference" is written by "tension.torque" already; an input has one writer: remove one row, or use a buffer)"},
    {"connection_of_a_buffer_by_data", [](Table& m) { m.add(data("encoder.samples", "shaft.samples")); },
     R"(loom: connection "encoder.samples" -> "shaft.samples": "encoder.samples" is a buffered output, not an output; write buffer<n>(...))"},
    {"connection_of_data_by_a_buffer", [](Table& m) { m.put(buffer<4>("encoder.angle", "shaft.measured")); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": "encoder.angle" is an output, not a buffered output; write data(...))"},
};
INSTANTIATE_TEST_SUITE_P(ends, Refusal, planted_into(small_loom, end_faults), name_of);

/// A row from a component of an activity that is not real-time.
void hear_slowly(Table& m, const ConnectionRow& row) {
    m.add(component<Wire>("wire"));
    m.add(activity("wires", every(4ms), not_real_time, runs("wire")));
    m.add(component<Hearer>("hearer"), "field");
    m.add(row);
}
constexpr Fault slow_faults[] = {
    {"row_stale_before_its_slow_writer_writes_again",
     [](Table& m) { hear_slowly(m, data("climate.humidity", "hearer.damp", stale_after(250ms), hold)); },
     R"(loom: connection "climate.humidity" -> "hearer.damp": stale_after(250000 us) is not longer than the period of 250000 us of its writer's activity "hall", so that good values would be stale; lengthen it)"},
    {"row_from_outside_stale_between_two_cycles_of_its_driver",
     [](Table& m) { hear_slowly(m, data("wire.level", "hearer.loud", stale_after(12ms), hold)); },
     R"(loom: connection "wire.level" -> "hearer.loud": stale_after(12000 us) is not longer than the 12000 us in which "wire.level" comes, so that good values would be stale; lengthen it)"},
};
INSTANTIATE_TEST_SUITE_P(slow, Refusal, planted_into(small_loom, slow_faults), name_of);

constexpr Fault option_faults[] = {
    {"row_from_outside_without_an_age",
     [](Table& m) {
         m.add(component<Hearer>("hearer"), "field");
         add_wire(m, data("wire.level", "hearer.loud"));
     },
     R"(loom: connection "wire.level" -> "hearer.loud": "wire.level" comes from outside every 10000 us, and nothing notices when it falls silent; add stale_after(...), longer than that, with hold, substitute(...) or stop_machine)"},
    {"row_from_outside_stale_too_soon",
     [](Table& m) {
         m.add(component<Hearer>("hearer"), "field");
         add_wire(m, data("wire.level", "hearer.loud", stale_after(10ms), hold));
     },
     R"(loom: connection "wire.level" -> "hearer.loud": stale_after(10000 us) is not longer than the 10000 us in which "wire.level" comes, so that good values would be stale; lengthen it)"},
    {"row_from_outside_in_a_slower_activity", [](Table& m) { m.add(component<Wire>("wire"), "hall"); },
     R"(loom: activity "hall" runs every 250000 us, but "wire.level" crosses the wire every 10000 us by its map; shorten the activity's period, or lengthen the every(...) of the map)"},
    {"row_stale_before_its_writer_writes_again",
     [](Table& m) { m.connections[1] = data("shaft.speed", "tension.speed", stale_after(1ms), hold); },
     R"(loom: connection "shaft.speed" -> "tension.speed": stale_after(1000 us) is not longer than the period of 1000 us of its writer's activity "motion", so that good values would be stale; lengthen it)"},
    {"row_from_outside_in_an_activity_that_nobody_wakes",
     [](Table& m) { m.add(component<Wire>("wire"), "logic"); },
     R"(loom: activity "logic" runs on_work(), but "wire.level" crosses the wire every 10000 us by its map, which wakes nobody; run it every(...) or on_device(...))"},
    {"row_that_must_wake",
     [](Table& m) {
         m.add(component<Valve>("valve"), "logic");
         m.add(data("shaft.speed", "valve.wanted"));
     },
     R"(loom: connection "shaft.speed" -> "valve.wanted": "valve.wanted" is looked at only when activity "logic" is woken, so that a new value could wait for ever; add wakes)"},
    {"connection_stale_never", [](Table& m) { measured(m, stop_machine); },
     R"(loom: connection "encoder.angle" -> "shaft.measured" says what to do with a stale value but not when it is stale; add stale_after(...))"},
    {"connection_stale_before_it_is_written", [](Table& m) { measured(m, stale_after(-5ms), hold); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": stale_after(-5000 us) is not above 0, so that no value would ever be stale; write the longest age, or leave it out)"},
    {"connection_stale_at_once", [](Table& m) { measured(m, stale_after(0ms), substitute(0)); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": stale_after(0 us) is not above 0, so that no value would ever be stale; write the longest age, or leave it out)"},
    {"connection_substitute_not_a_number",
     [](Table& m) { measured(m, stale_after(4ms), substitute(no_number)); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": the value in substitute is not a finite number; write a finite one)"},
    {"connection_substitute_infinite", [](Table& m) { measured(m, stale_after(4ms), substitute(endless)); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": the value in substitute is not a finite number; write a finite one)"},
    {"connection_substitute_constant_infinite",
     [](Table& m) { measured(m, stale_after(4ms), substitute<endless>()); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": the value in substitute is not a finite number; write a finite one)"},
    {"connection_initially_infinite",
     [](Table& m) { m.put(data("shaft.speed", "tension.speed", initially(-endless))); },
     R"(loom: connection "shaft.speed" -> "tension.speed": the value in initially is not a finite number; write a finite one)"},
    {"connection_initially_without_end_in_a_float",
     [](Table& m) { add_talk(m, data("talker.share", "hearer.share", initially(1e300))); },
     R"(loom: connection "talker.share" -> "hearer.share": the number in initially does not fit "hearer.share" of type float; write one that it can hold)"},
    {"connection_scaled_by_infinity", [](Table& m) { measured(m, scaled(endless)); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": the factor in scaled is not a finite number other than 0; write another)"},
    {"connection_scaled_by_no_number", [](Table& m) { measured(m, scaled(no_number)); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": the factor in scaled is not a finite number other than 0; write another)"},
    {"connection_scaled_by_nought", [](Table& m) { measured(m, scaled(0.0)); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": the factor in scaled is not a finite number other than 0; write another)"},
    {"connection_buffer_of_all",
     [](Table& m) { m.add(buffer<~std::size_t{0}>("encoder.samples", "shaft.samples")); },
     R"(loom: connection "encoder.samples" -> "shaft.samples" holds 18446744073709551615 values, more than the 16777216 of a row; write a smaller buffer<n>)"},
    {"connection_never_stale", [](Table& m) { add_talk(m, data("talker.count", "hearer.pulse")); },
     R"(loom: connection "talker.count" -> "hearer.pulse" has no maximum age, but "hearer.pulse" needs staleness to detect silence; add stale_after(...) and hold)"},
    {"connection_stale_twice", [](Table& m) { measured(m, stale_after(4ms), substitute(0), stop_machine); },
     R"(loom: connection "encoder.angle" -> "shaft.measured" has more than one of hold, substitute and stop_machine; keep one)"},
    {"connection_substitute_type", [](Table& m) { measured(m, stale_after(4ms), substitute<at_rest>()); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": substitute gives a value of type int, but "shaft.measured" is of type double; name a constant of the port's type)"},
    {"connection_initially_type",
     [](Table& m) { m.put(data("shaft.speed", "tension.speed", initially<standing>())); },
     R"(loom: connection "shaft.speed" -> "tension.speed": initially gives a value of type float, but "tension.speed" is of type double; name a constant of the port's type)"},
    {"connection_buffer_of_nothing", [](Table& m) { m.add(buffer<0>("encoder.samples", "shaft.samples")); },
     R"(loom: connection "encoder.samples" -> "shaft.samples" holds no value; write buffer<n> with n of at least 1)"},
    {"connection_buffer_stale",
     [](Table& m) { m.add(buffer<4>("encoder.samples", "shaft.samples", stale_after(4ms))); },
     R"(loom: connection "encoder.samples" -> "shaft.samples": values in a buffer have no age and no initial value; remove the option from the row)"},
    {"connection_delayed_across", [](Table& m) { measured(m, delayed); },
     R"(loom: connection "encoder.angle" -> "shaft.measured": delayed means one cycle of one activity, but this row crosses from "field" to "motion"; remove delayed)"},
    {"connection_wakes_a_periodic_activity", [](Table& m) { measured(m, wakes); },
     R"(loom: connection "encoder.angle" -> "shaft.measured" wakes activity "motion", which is periodic; remove wakes)"},
    {"connection_wakes_itself", [](Table& m) { add_talk(m, data("talker.count", "hearer.count", wakes)); },
     R"(loom: connection "talker.count" -> "hearer.count" wakes its own activity "logic"; remove wakes)"},
    {"connection_number_for_a_text",
     [](Table& m) { add_talk(m, data("talker.word", "hearer.word", stale_after(2ms), substitute(1.0))); },
     R"(loom: connection "talker.word" -> "hearer.word": a value of type tappet::Text<8> is not a number; write substitute<constant>() with a constant of that type)"},
    {"connection_number_too_large",
     [](Table& m) { add_talk(m, data("talker.count", "hearer.count", initially(128.0))); },
     R"(loom: connection "talker.count" -> "hearer.count": the number in initially does not fit "hearer.count" of type signed char; write one that it can hold)"},
};
INSTANTIATE_TEST_SUITE_P(options, Refusal, planted_into(small_loom, option_faults), name_of);

} // namespace
