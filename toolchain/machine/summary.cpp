// Writes the summary: activities, budgets, stops and counters, as the machine has them at the end.
#include "toolchain/machine/summary.hpp"

#include "kernel/machine/check/traffic.hpp"
#include "kernel/machine/slots/behaviour_slot.hpp"
#include "kernel/os/box.hpp"
#include "kernel/os/heap.hpp"
#include "kernel/os/host_watch.hpp"
#include "kernel/os/memory.hpp"
#include "kernel/os/terminal.hpp"
#include "kernel/services/json.hpp"

#include <array>

namespace tappet {

namespace {

void write_activities(JsonText& json, const MachineInstance& instance) {
    json.key("activities").open('[');
    for (std::size_t a = 0; a < instance.engines().size(); ++a) {
        const Engine& engine = instance.engines()[a];
        const EngineStatistics& seen = engine.statistics();
        json.open('{')
            .field("name", engine.name())
            .field("cycles", seen.cycles)
            .field("longest_busy_us", static_cast<double>(seen.longest_busy.count()) * 1e-3);
        json.field("longest_response_us", static_cast<double>(seen.longest_response.count()) * 1e-3)
            .field("deadline_us", static_cast<double>(engine.plan().deadline.count()) * 1e-3)
            .field("deadline_misses", seen.misses)
            .field("skipped_periods", seen.skipped_periods);
        json.field("budget_us", static_cast<double>(engine.plan().budget.count()) * 1e-3)
            .field("claim_us", static_cast<double>(engine.plan().claim().count()) * 1e-3);
        json.field("most_processor_us", static_cast<double>(seen.most_processor.count()) * 1e-3)
            .field("over_claim", seen.over_claim)
            .field("measured_claims", seen.measured_claims);
        json.field("wakes_too_many", seen.wakes_too_many)
            .field("stack_bytes", instance.machine().plan.activities[a].stack_bytes)
            .field("stack_used_bytes", instance.observation().stack_high_water_bytes(a));
        json.key("functions").open('[');
        const EnginePlan& plan = engine.plan();
        constexpr std::string_view kinds[] = {"step", "timers", "reactions", "behaviour"};
        for (std::size_t f = 0; f < plan.functions.size(); ++f) {
            const FunctionTiming& timing = plan.functions[f];
            if (timing.passes == 0) continue;
            json.open('{')
                .field("component", plan.parts[f / functions_per_part].name)
                .field("function", kinds[f % functions_per_part])
                .field("passes", timing.passes);
            json.field("usual_ns", timing.usual().count())
                .field("longest_ns", timing.longest.count())
                .field("blamed", timing.blamed)
                .close('}');
        }
        json.close(']').close('}');
    }
    json.close(']');
}

/// Writes which script each slot held at the end, and the fate of the scripts before it.
void write_slots(JsonText& json, const MachineInstance& instance) {
    json.key("slots").open('[');
    for (const BehaviourRow& row : instance.machine().table.behaviours) {
        const BehaviourSlot* slot = row.is_slot() ? instance.slot_of(row.component) : nullptr;
        if (slot == nullptr) continue;
        json.open('{').field("component", row.component).field("script", slot->script());
        json.field("loads", slot->loads()).field("roll_backs", slot->roll_backs());
        json.field("news", slot->describe_roll_back().view()).close('}');
    }
    json.close(']');
}

/// Writes each driver's counters: its integer outputs, except those of its map, which have a dot.
void write_counters(JsonText& json, MachineInstance& instance) {
    const MachineView& table = instance.machine().table;
    json.key("counters").open('{');
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const ComponentType& type = *table.components[c].type;
        if (type.device_map == nullptr) continue;
        for (std::size_t f = 0; f < type.facets.size(); ++f) {
            const Facet& facet = type.facets[f];
            if (facet.kind != FacetKind::output || facet.type != type_id<std::int64_t> ||
                facet.name.contains('.'))
                continue;
            const auto& output = *static_cast<const Output<std::int64_t>*>(instance.facet({c, f}));
            json.field(Sentence{table.components[c].name, ".", facet.name}.view(), output.last());
        }
    }
    json.close('}');
}

void write_times(JsonText& json, const MachineInstance& instance, const Link& link, std::string_view how,
                 const ReactionTimes* times) {
    if (times == nullptr || times->count == 0) return;
    const MachineView& table = instance.machine().table;
    const auto name = [&table](End end) {
        return Sentence{table.components[end.component].name, ".", facet_at(table, end).name};
    };
    json.open('{')
        .field("row", Sentence{name(link.from), " ", how, " ", name(link.to)}.view())
        .field("count", times->count);
    json.field("mean_us", static_cast<double>(times->mean().count()) * 1e-3)
        .field("longest_us", static_cast<double>(times->longest.count()) * 1e-3);
    json.key("histogram").open('[');
    for (const std::uint32_t n : times->histogram) json.value(n);
    json.close(']').close('}');
}

/// For each device whose driver proves response times: the proven one, and the longest that was seen.
template <class Tell>
void each_sent(MachineInstance& instance, Tell tell) {
    const AcceptedMachine& machine = instance.machine();
    const MachineView& table = machine.table;
    const auto worst = checks::worst_responses_ns(table, *machine.board, *machine.binding, machine.index);
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const ComponentRow& row = table.components[c];
        const DeviceUse use =
            checks::use_of_device(table, *machine.board, *machine.binding, machine.index, worst, c);
        if (use.device.empty()) continue;
        std::array<TrafficRow, most_traffic_rows> rows{};
        static_cast<void>(row.type->device_traffic.analyse(use, rows)); // accepted
        for (const TrafficRow& each : std::span{rows}.first(row.type->device_traffic.rows))
            if (each.sent)
                tell(row.name, each, row.type->device_traffic.longest_seen(instance.component(c), each.name));
    }
}

void write_traffic(JsonText& json, MachineInstance& instance) {
    json.key("sent").open('[');
    each_sent(instance, [&](std::string_view component, const TrafficRow& row, Duration longest) {
        json.open('{').field("frame", Sentence{component, ".", row.name}.view());
        json.field("proven_us", static_cast<double>(row.worst.count()) * 1e-3)
            .field("longest_us", static_cast<double>(longest.count()) * 1e-3)
            .close('}');
    });
    json.close(']');
}

/// Writes the time from the edge or the frame to the output that it caused, row by row.
void write_reactions(JsonText& json, const MachineInstance& instance) {
    const AcceptedMachine& machine = instance.machine();
    json.key("reactions").open('[');
    for (std::size_t x = 0; x < machine.table.connections.size(); ++x)
        write_times(json, instance, machine.index.connections[x], "wakes",
                    instance.observation().times_of_connection(x));
    for (std::size_t i = 0; i < machine.table.reactions.size(); ++i)
        write_times(json, instance, machine.index.reactions[i], "tells",
                    instance.observation().times_of_reaction(i));
    json.close(']');
}

} // namespace

std::size_t write_summary(MachineInstance& instance, const RunFacts& facts, std::span<char> buffer) {
    const AcceptedMachine& machine = instance.machine();
    std::uint64_t misses = 0;
    for (const Engine& engine : instance.engines()) misses += engine.statistics().misses;
    JsonText json{buffer};
    json.open('{')
        .field("machine", machine.table.name)
        .field("board", machine.board->name)
        .field("world", machine.board->world);
    json.field("kernel_release", os::kernel_release().view())
        .field("realtime", facts.realtime)
        .field("machine_seed", facts.seed)
        .field("stop_reason", facts.stop_reason.view());
    for (const WireCounter& each : facts.wires.each) json.field(each.name, each.count);
    write_counters(json, instance);
    write_traffic(json, instance);
    write_slots(json, instance);
    json.key("held_back").open('{'); // by the rows of limits
    for (std::size_t section = 0; section < instance.machine().table.extras->size(); ++section)
        for (std::size_t row = 0; !instance.observation().counted(section, row).what.empty(); ++row)
            json.field(instance.observation().counted(section, row).what,
                       instance.observation().counted(section, row).times);
    json.close('}');
    json.key("unsent").open('{'); // by rows of drivers
    instance.each_unsent([&](std::string_view component, const Facet& row, const Unsent& seen) {
        json.key(Sentence{component, ".", row.name}.view()).open('{');
        json.field("clamped", seen.clamped).field("no_number", seen.no_number).close('}');
    });
    json.close('}');
    json.field("emissions_lost", instance.observation().lost_emissions())
        .field("forced_ports", instance.observation().forced_ports().load());
    if (os::heap::seal_counts())
        json.field("heap_allocations_after_arming",
                   os::heap::allocations_after_seal() + os::heap::mappings_after_seal());
    if (os::host_watch::is_linked()) json.field("cycles_that_may_block", os::host_watch::cycles());
    json.field("page_faults_after_arming", facts.page_faults_after_arming);
    json.field("contracts_broken", facts.contracts_broken).field("texts_dropped", os::dropped_texts());
    json.field("deadline_misses", misses)
        .field("binary_bytes", os::binary_bytes())
        .field("static_memory_bytes", machine.plan.bytes + machine.board->heap_bytes);
    json.field("heap_high_water_bytes", os::heap::high_water_bytes()).field("rss_bytes", os::rss_bytes());
    if (facts.start_to_armed > Duration::zero())
        json.field("start_to_armed_ms", static_cast<double>(facts.start_to_armed.count()) * 1e-6);
    if (facts.with_digest) json.field("machine_digest", instance.observation().event_log_digest());
    write_reactions(json, instance);
    write_activities(json, instance);
    return json.size();
}

void tell_overruns(MachineInstance& instance, std::string_view speaker) {
    for (std::size_t a = 0; a < instance.engines().size(); ++a)
        for (const Sentence& told :
             {instance.observation().describe_budget(a), instance.observation().describe_end(a)})
            if (!told.empty()) os::print(Sentence{speaker, ": ", told, "\n"}.view());
    each_sent(instance, [&](std::string_view component, const TrafficRow& row, Duration longest) {
        if (longest > row.worst)
            os::print(Sentence{speaker, ": frame \"", component, ".", row.name, "\" took ",
                               longest.count() / 1000, " us to its confirmation, the analysis says ",
                               row.worst.count() / 1000,
                               " us at most: the map or the board states too little about the bus, or the "
                               "box is slower than the table claims\n"}
                          .view());
    });
    instance.each_unsent([&](std::string_view component, const Facet& row, const Unsent& seen) {
        if (seen.clamped != 0)
            os::print(Sentence{speaker, ": \"", component, ".", row.name, "\": ", seen.clamped,
                               " times its value was outside its range and sent as its nearest bound\n"}
                          .view());
        if (seen.no_number != 0)
            os::print(Sentence{speaker, ": \"", component, ".", row.name, "\": ", seen.no_number,
                               " times its value was not a number and not ",
                               row.kind == FacetKind::output ? "passed on\n" : "sent\n"}
                          .view());
    });
    for (std::size_t section = 0; section < instance.machine().table.extras->size(); ++section)
        if (const SectionCount seen = instance.observation().counted(section, 0);
            seen.times != 0 && !seen.told.empty())
            os::print(Sentence{speaker, ": \"", seen.what, "\": ", seen.times, " times it ", seen.told, "\n"}
                          .view());
    for (const Engine& engine : instance.engines()) {
        const EngineStatistics& seen = engine.statistics();
        if (seen.misses == 0) continue;
        const Miss& last = seen.recent_misses[(seen.misses - 1) % seen.recent_misses.size()];
        const std::string_view culprit = last.function == Miss::nobody
                                             ? std::string_view{"it began late"}
                                             : engine.plan().parts[last.function / functions_per_part].name;
        os::print(Sentence{speaker, ": activity \"", engine.name(), "\" missed its deadline ",
                           static_cast<std::int64_t>(seen.misses), " times; the last time ", culprit,
                           " took ", last.took.count() / 1000, " us, usually ", last.usual.count() / 1000,
                           " us\n"}
                      .view());
    }
}

} // namespace tappet
