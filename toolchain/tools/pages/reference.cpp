// The reference: components of the library and the drivers by their interfaces, words of tables and maps by
// their headers, commands of the browser by their table.
#include "drivers/camera/sensor.hpp"
#include "drivers/can/bus.hpp"
#include "drivers/can/clock.hpp"
#include "drivers/can/restarter.hpp"
#include "drivers/canopen/axis.hpp"
#include "drivers/canopen/eds.hpp"
#include "drivers/canopen/manager.hpp"
#include "drivers/gpio/line_port.hpp"
#include "drivers/instruments/analog.hpp"
#include "drivers/instruments/encoder.hpp"
#include "drivers/instruments/force_sensor.hpp"
#include "drivers/instruments/velocity_axis.hpp"
#include "drivers/modbus/client.hpp"
#include "drivers/system/link.hpp"
#include "drivers/udp/peer_clock.hpp"
#include "kernel/base/decimal.hpp"
#include "kernel/control/control.hpp"
#include "kernel/pieces/cam_shaft.hpp"
#include "kernel/pieces/kept.hpp"
#include "kernel/services/box/box.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/services/configuration/property_keeper.hpp"
#include "kernel/services/interpreter/command_interpreter.hpp"
#include "kernel/services/scope/thread_scope.hpp"
#include "kernel/services/tasks/behaviour_task.hpp"
#include "kernel/services/tasks/component_life.hpp"
#include "kernel/services/time/timed_event.hpp"
#include "kernel/services/time/watchdog.hpp"
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/pages/node.eds.hpp"
#include "toolchain/tools/pages/pages.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace tappet::pages {

namespace {

// Each kind of row once, so that each kind of facet appears.
constexpr auto frames = can::signal_map(
    can::receive(can::standard(1), "in_frame", can::bytes(8), can::every(10ms), can::signal("count", 0, 16),
                 can::signal("measure", 16, 16).times(0.1).in("mm")),
    can::transmit(can::standard(2), "out_frame", can::bytes(8), can::every(10ms), can::signal("count", 0, 16),
                  can::signal("measure", 16, 16).times(0.1).in("mm"))
        .safe_by_silence());
constexpr auto nodes =
    canopen::network(frames, canopen::manager(127),
                     canopen::node(9, "node", canopen::dictionary<files::node_eds>).heartbeat(100ms));
constexpr auto cams = cam_table(300_rpm, cam("point", at(0_deg)), cam("window", window(80_deg, 120_deg)));
constexpr auto lines = gpio::line_map(gpio::sensor("sensor"), gpio::output("output", gpio::safe(false)),
                                      gpio::actuator("actuator", gpio::safe(false)));
constexpr auto registers =
    modbus::register_map(modbus::read("in_row", modbus::input_registers(0, 1), modbus::every(1s),
                                      modbus::word("measure", 0).in("mm")),
                         modbus::write("out_row", modbus::holding_registers(0, 1), modbus::every(1s),
                                       modbus::stale_after(3s), modbus::word("measure", 0).in("mm").safe(0)));

constexpr auto bus_clock = can::clock(can::standard(0x100), can::every(100ms));
/// Everything that crosses a wire, once each.
struct Crosses {
    Output<double> value{};
    Input<double> heard{};
    Event<> event{};
    CommandCall<> call{};
    void operation() noexcept TAPPET_REALTIME {}
    bool command() noexcept TAPPET_REALTIME { return true; }
    static constexpr auto interface() {
        return facets(
            output<&Crosses::value>("value", "mm", "told"), input<&Crosses::heard>("heard", "mm", "heard"),
            tappet::event<&Crosses::event>("event", "emitted"), sends<&Crosses::call>("call", "sent"),
            tappet::operation<&Crosses::operation>("operation", "served"),
            tappet::command<&Crosses::command>("command", "executed"));
    }
};
constexpr auto one_machine = machine("one", components(component<Crosses>("c")), activities(), connections(),
                                     reactions(), behaviours());
constexpr auto pair = system(
    "pair", tappet::nodes(node<one_machine>("a"), node<one_machine>("b")), wire("wire", bit_rate(500'000)),
    crossings(across(data("a.c.value", "b.c.heard"), every(10ms), in_bits(16, 0.1)),
              across(data("b.c.value", "a.c.heard"), every(10ms), in_bits(16, 0.1)),
              across(when("a.c.event", tell("b.c.operation")), at_most(1, 100ms), within(50ms)),
              across(when("b.c.event", tell("a.c.operation")), at_most(1, 100ms), within(50ms)),
              across(uses("a.c.call", "b.c.command"), at_most(1, 100ms), within(50ms)),
              across(uses("b.c.call", "a.c.command"), at_most(1, 100ms), within(50ms))));

struct Described {
    std::string_view header, type, row;
    const ComponentType& component;
};
const Described components[] = {
    {"drivers/gpio/line_port.hpp", "LinePort", "gpio::LinePort<line_map>",
     component_type<gpio::LinePort<lines>>},
    {"drivers/can/bus.hpp", "Bus", "can::Bus<signal_map>", component_type<can::Bus<frames>>},
    {"drivers/camera/sensor.hpp", "Sensor", "camera::Sensor<columns, rows>",
     component_type<camera::Sensor<160, 120>>},
    {"drivers/udp/peer_clock.hpp", "ClockAnswers", "udp::ClockAnswers", component_type<udp::ClockAnswers>},
    {"drivers/udp/peer_clock.hpp", "PeerClock", "udp::PeerClock", component_type<udp::PeerClock>},
    {"drivers/can/clock.hpp", "ClockTeller", "can::ClockTeller<row>",
     component_type<can::ClockTeller<bus_clock>>},
    {"drivers/can/clock.hpp", "ToldClock", "can::ToldClock<row>", component_type<can::ToldClock<bus_clock>>},
    {"drivers/system/link.hpp", "Link", "systems::Link<system, node>",
     component_type<systems::Link<pair, 0>>},
    {"drivers/can/restarter.hpp", "Restarter", "can::Restarter", component_type<can::Restarter>},
    {"drivers/canopen/manager.hpp", "Manager", "canopen::Manager<network>",
     component_type<canopen::Manager<nodes>>},
    {"drivers/canopen/axis.hpp", "Axis", "canopen::Axis<\"mm\">", component_type<canopen::Axis<"mm">>},
    {"drivers/modbus/client.hpp", "Client", "modbus::Client<register_map>",
     component_type<modbus::Client<registers>>},
    {"drivers/instruments/encoder.hpp", "Encoder", "instruments::Encoder<\"m\", 16>",
     component_type<instruments::Encoder<"m", 16>>},
    {"drivers/instruments/analog.hpp", "AnalogInput", "instruments::AnalogInput<\"bar\">",
     component_type<instruments::AnalogInput<"bar">>},
    {"drivers/instruments/analog.hpp", "AnalogOutput", "instruments::AnalogOutput<\"bar\">",
     component_type<instruments::AnalogOutput<"bar">>},
    {"drivers/instruments/force_sensor.hpp", "ForceSensor", "instruments::ForceSensor",
     component_type<instruments::ForceSensor>},
    {"drivers/instruments/velocity_axis.hpp", "VelocityAxis", "instruments::VelocityAxis<\"m/s\">",
     component_type<instruments::VelocityAxis<"m/s">>},
    {"kernel/services/box/box.hpp", "Box", "Box", component_type<Box>},
    {"kernel/services/time/timed_event.hpp", "TimedEvent", "TimedEvent", component_type<TimedEvent>},
    {"kernel/services/time/watchdog.hpp", "Watchdog", "Watchdog", component_type<Watchdog>},
    {"kernel/services/tasks/behaviour_task.hpp", "BehaviourTask", "BehaviourTask<script, \"instance\">",
     component_type<BehaviourTask<>>},
    {"kernel/services/tasks/component_life.hpp", "ComponentLife", "ComponentLife",
     component_type<ComponentLife>},
    {"kernel/control/chain_switch.hpp", "ChainSwitch", "ChainSwitch", component_type<ChainSwitch>},
    {"kernel/pieces/cam_shaft.hpp", "CamShaft", "CamShaft<cam_table>", component_type<CamShaft<cams>>},
    {"kernel/pieces/kept.hpp", "HourMeter", "HourMeter", component_type<HourMeter>},
    {"kernel/pieces/kept.hpp", "Total", "Total", component_type<Total>},
    {"kernel/services/configuration/property_keeper.hpp", "PropertyKeeper", "PropertyKeeper",
     component_type<PropertyKeeper>},
    {"kernel/services/scope/thread_scope.hpp", "ThreadScope", "ThreadScope", component_type<ThreadScope>},
    {"kernel/services/browsing/browser_service.hpp", "BrowserService", "BrowserService",
     component_type<BrowserService>},
    {"kernel/services/interpreter/command_interpreter.hpp", "CommandInterpreter", "CommandInterpreter",
     component_type<CommandInterpreter>},
};

constexpr std::string_view tables[][2] = {
    {"kernel/machine/table/components.hpp", "components(...)"},
    {"kernel/machine/table/activities.hpp", "activities(...)"},
    {"kernel/machine/table/connections.hpp", "connections(...)"},
    {"kernel/machine/table/reactions.hpp", "reactions(...)"},
    {"kernel/machine/table/behaviours.hpp", "behaviours(...)"},
    {"kernel/limits/limits.hpp", "limits(...)"},
    {"kernel/control/rows.hpp", "control(...)"},
    {"kernel/services/reporting/rows.hpp", "reporting(...)"},
    {"kernel/machine/table/board.hpp", "a board"},
    {"kernel/machine/table/binding.hpp", "binding(...)"},
    {"drivers/gpio/line_map.hpp", "gpio::line_map(...)"},
    {"drivers/can/signal_map.hpp", "can::signal_map(...)"},
    {"drivers/modbus/register_map.hpp", "modbus::register_map(...)"},
};

std::string type_text(const TypeTag& type) {
    switch (type.kind) {
    case ValueKind::duration: return "time";
    case ValueKind::integer:
    case ValueKind::natural:
        return (type.kind == ValueKind::natural ? "uint" : "int") + std::to_string(8 * type.size);
    case ValueKind::arguments: {
        std::string text;
        for (const TypeId each : type.elements) text += (text.empty() ? "" : ", ") + type_text(*each);
        return "(" + text + ")";
    }
    default: break;
    }
    std::string text{type.name};
    if (text.starts_with("tappet::")) text.erase(0, 8);
    return text;
}

std::string range_text(const Range& range) {
    if (std::isinf(range.low) && std::isinf(range.high)) return {};
    return std::string{decimal(range.low).view()} + " to " + std::string{decimal(range.high).view()};
}

std::string_view thread_text(const Facet& facet) {
    switch (facet.kind) {
    case FacetKind::event: return "call: its own; tell: the receiver's";
    case FacetKind::operation: return facet.any_thread ? "any" : "its own";
    case FacetKind::method: return facet.any_thread ? "any" : "the caller's, in its own activity";
    case FacetKind::command: return "its own, in its cycles";
    default: return "its own";
    }
}

bool may_be_asked_for(FacetKind kind) {
    return kind == FacetKind::property || kind == FacetKind::operation || kind == FacetKind::method ||
           kind == FacetKind::command;
}

void put(std::ostream& page, const Described& each, const std::string& text) {
    page << "\n### " << cell(each.row) << "\n\n" << text << "\n\n`#include \"" << each.header << "\"`";
    if (each.component.device_kind != nullptr)
        page << "; drives a " << each.component.device_kind->name << " device";
    page << "\n\n| facet | kind | type | unit | range | text | thread | asked for by |\n"
            "|---|---|---|---|---|---|---|---|\n";
    for (const Facet& facet : each.component.facets) {
        std::string_view kind = to_text(facet.kind);
        kind.remove_prefix(kind.find(' ') + 1);
        page << "| `" << facet.name << "` | " << kind << (facet.required ? ", required" : "") << " | "
             << cell(type_text(*facet.type)) << " | " << facet.unit << " | " << range_text(facet.range)
             << " | " << cell(facet.doc) << " | " << thread_text(facet) << " | "
             << (may_be_asked_for(facet.kind) ? to_text(facet.least_role) : "") << " |\n";
    }
}

std::optional<std::string> put(std::ostream& page, std::string_view heading, const std::string& header,
                               const std::string& text) {
    const auto found = words(header, text);
    if (!found) return found.error();
    if (found->empty()) return header + ": no word was found in it";
    page << "\n### " << heading << "\n\n| word | says |\n|---|---|\n";
    for (const Word& word : *found) page << "| " << code(word.spelled) << " | " << cell(word.text) << " |\n";
    return std::nullopt;
}

/// Returns the drivers with words. For a driver without words, a row contains only names.
std::vector<std::string> drivers_with_words(const std::filesystem::path& tree) {
    std::vector<std::string> found;
    for (const auto& folder : std::filesystem::directory_iterator{tree / "drivers"})
        if (contents_of(folder.path() / "kind.hpp").contains("constexpr Fact "))
            found.push_back(folder.path().filename().string());
    std::ranges::sort(found);
    return found;
}

} // namespace

std::expected<std::string, std::string> reference_page(const std::filesystem::path& tree) {
    std::ostringstream page;
    page << "# Reference\n\nMade from the code: interfaces, headers and the browser's table.\n\n"
            "## Components\n\nA driver's facets are those of a sample map, in which `in_frame`, `sensor` or "
            "`in_row` stands for a name of yours.\n";
    for (const Described& each : components) {
        const std::string text = text_of(contents_of(tree / each.header), each.type);
        if (text.empty())
            return std::unexpected(std::string{each.header} + ": " + std::string{each.type} +
                                   " has no text; say above it, after ///, what it is");
        put(page, each, text);
    }
    page << "\n## Rows and their options\n";
    std::string silent;
    for (const auto& [header, heading] : tables)
        if (const auto fault = put(page, heading, std::string{header}, contents_of(tree / header)))
            silent += "\n  " + *fault;
    for (const std::string& driver : drivers_with_words(tree)) {
        const std::string header = "drivers/" + driver + "/kind.hpp";
        if (const auto fault =
                put(page, "boards and bindings: " + driver, header, contents_of(tree / header)))
            silent += "\n  " + *fault;
    }
    if (!silent.empty()) return std::unexpected(silent);
    page << "\n## Commands of the browser\n\n| `tappet-browse ...` | does |\n|---|---|\n";
    for (const browser::Command& each : browser::commands())
        page << "| " << code(each.usage) << " | " << cell(each.help) << " |\n";
    return page.str();
}

} // namespace tappet::pages
