// Builds a machine from its plan: constructs components, places engines, wires every row and configures.
#include "kernel/machine/instance/builder.hpp"
#include "kernel/machine/plan/scope_layout.hpp"

#include <algorithm>
#include <cstring>
#include <new>

namespace tappet {

namespace {

std::uint64_t cycles_of(const void* engine) noexcept TAPPET_REALTIME {
    return static_cast<const Engine*>(engine)->generation();
}

bool is_part_expected(const void* part) noexcept TAPPET_REALTIME {
    const ComponentState state = static_cast<const EnginePart*>(part)->state.load(std::memory_order_acquire);
    return state != ComponentState::stopped && state != ComponentState::inactive;
}

// An activity whose thread was given up is not active, but that was not requested.
bool is_engine_expected(const void* self) noexcept TAPPET_REALTIME {
    const auto& engine = *static_cast<const Engine*>(self);
    return engine.is_active() ||
           engine.plan().parts.front().state.load(std::memory_order_acquire) == ComponentState::failed;
}

bool rests(const void* self, Time now) noexcept TAPPET_REALTIME {
    const auto& engine = *static_cast<const Engine*>(self);
    return engine.generation() % 2 == 0 && !engine.is_woken() && engine.wakes_at() > now;
}

} // namespace

std::expected<void, Sentence> MachineBuilder::build(std::span<const ProvidedDevice> devices) {
    if (const Sentence fault = check_constants(); !fault.empty()) return std::unexpected(fault);
    if (auto shared = share_memory(); !shared) return shared;
    construct();
    if (unlisted_.kind != nullptr) return std::unexpected(describe_unlisted());
    place_engines();
    place_scope();
    connect_clocks();
    connect_data();
    place_needed_inputs();
    if (const Sentence fault = place_behaviours(); !fault.empty()) return std::unexpected(fault);
    if (const Sentence fault = connect_controls(); !fault.empty()) return std::unexpected(fault);
    connect_extras();
    connect_events();
    place_mailboxes();
    connect_operations();
    place_map();
    const MachineView& table = machine_.table;
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const ComponentRow& row = table.components[c];
        if (const Sentence refusal = configure_properties(c); !refusal.empty())
            return std::unexpected(refusal);
        os::Waiter& waiter = instance_.engines()[machine_.index.activity[c]].waiter();
        waiter.watch_for(machine_.plan.part_of[c]);
        Setup setup{row.name,
                    row.device,
                    devices,
                    &instance_.clock(),
                    &waiter,
                    life_sign_of(row.watched),
                    row.type->sees_machine ? &instance_ : nullptr,
                    row.type->records_cycles ? instance_.at<scope::Directory>(machine_.plan.scope_at)
                                             : nullptr};
        if (row.type->configure != nullptr)
            if (const Sentence refusal = row.type->configure(instance_.component(c), setup); !refusal.empty())
                return std::unexpected(refusal);
        if (const Sentence fault = check_wake(row, setup); !fault.empty()) return std::unexpected(fault);
    }
    return {};
}

/// Checks that a driver keeps what its type says of its device's wakes, by which the table was checked.
Sentence MachineBuilder::check_wake(const ComponentRow& row, const Setup& setup) {
    if (setup.is_woken == row.type->woken_by_device) return {};
    const Sentence who{"component \"", row.name, "\": its type ", row.type->tag->name};
    if (setup.is_woken)
        return Sentence{who, " calls Setup::woken_by() but does not say so; add static constexpr bool "
                             "woken_by_device = true to it"};
    return Sentence{who, " says woken_by_device, but its configure() never called Setup::woken_by(), so its "
                         "device would wake nobody; call it there, or remove woken_by_device"};
}

void MachineBuilder::construct() {
    const MemberCensus census{[](void* self, const void* member, const MemberKind& kind) noexcept {
                                  static_cast<MachineBuilder*>(self)->look_up(member, kind);
                              },
                              this};
    for (constructed_ = 0; constructed_ < machine_.table.components.size(); ++constructed_) {
        const ComponentType& type = *machine_.table.components[constructed_].type;
        MemberCensus::current = type.device_kind == nullptr && !type.sees_machine ? &census : nullptr;
        type.construct(instance_.component(constructed_));
    }
    MemberCensus::current = nullptr;
}

/// Is told each facet member that a component constructs, and notes the first that is not listed.
void MachineBuilder::look_up(const void* member, const MemberKind& kind) noexcept {
    const ComponentType& type = *machine_.table.components[constructed_].type;
    const std::byte* const memory = machine_.memory.data() + machine_.plan.component_at[constructed_];
    const auto* const at = static_cast<const std::byte*>(member);
    if (unlisted_.kind != nullptr || at < memory || at >= memory + type.size) return; // or a temporary
    for (const Facet& each : type.facets)
        if (each.at != nullptr && each.at(const_cast<std::byte*>(memory), each.index) == member) return;
    unlisted_ = {constructed_, at, &kind};
}

Sentence MachineBuilder::configure_properties(std::size_t c) {
    const ComponentRow& row = machine_.table.components[c];
    PropertyTransaction transaction;
    transaction.begin(row.name, *row.type, instance_.component(c));
    for (const PropertyRow& setting : row.settings) {
        const std::size_t index = find_facet(row, setting.name);
        row.type->facets[index].property->set(transaction.change(index), setting.setting);
    }
    if (row.has_properties_file) {
        if (store_.load == nullptr)
            return Sentence{"component \"", row.name, "\" has the properties file \"", row.properties.name,
                            "\" but this start-up reads none; give it read_properties_from(...)"};
        if (Sentence fault = store_.load(store_.self, row, transaction); !fault.empty()) return fault;
    }
    transaction.commit();
    if (transaction.refusal().empty()) return {};
    Sentence text{"component \"", row.name, "\" refuses its properties"};
    if (row.has_properties_file) text.add(" (see \"").add(row.properties.name).add("\")");
    return text.add(": ").add(transaction.refusal());
}

void MachineBuilder::place_engines() {
    const MachineView& table = machine_.table;
    for (std::size_t a = 0; a < table.activities.size(); ++a) {
        const ActivityRow& row = table.activities[a];
        const ActivityPlan& plan = machine_.plan.activities[a];
        const auto parts = make(plan.parts);
        const auto functions =
            make(PlacesOf<FunctionTiming>{plan.functions_at, parts.size() * functions_per_part});
        const auto timers = instance_.at(plan.timers);
        std::size_t timer_count = 0;
        for (std::size_t c = 0; c < table.components.size(); ++c) {
            if (machine_.index.activity[c] != a) continue;
            const ComponentRow& component_row = table.components[c];
            const std::uint32_t part = machine_.plan.part_of[c];
            parts[part].place(instance_.component(c));
            parts[part].type = component_row.type;
            parts[part].name = component_row.name;
            for (std::size_t f = 0; f < component_row.type->facets.size(); ++f) {
                const Facet& each = component_row.type->facets[f];
                if (each.kind == FacetKind::timer)
                    new (&timers[timer_count++])
                        EngineTimer{static_cast<Timer*>(instance_.facet({c, f})), each.timer->fire, part};
            }
        }
        EnginePlan engine;
        engine.name = row.name;
        engine.activity = static_cast<std::uint32_t>(a);
        engine.periodic = row.periodic();
        engine.real_time = row.real_time;
        engine.period = row.period;
        engine.phase = row.phase;
        engine.deadline = row.real_time ? row.deadline() : Duration::zero();
        engine.budget = row.budget_each;
        engine.at_most_n = row.at_most_n;
        engine.at_most_per = row.at_most_per;
        engine.hears_causes = hears_causes(a);
        engine.stop_when_late = row.when_late == WhenLate::stop;
        engine.parts = parts;
        engine.functions = functions;
        engine.timers = timers;
        engine.behaviours = instance_.at(plan.behaviours);
        engine.inputs = instance_.at(plan.inputs);
        engine.forced = &instance_.observation().forced_ports();
        for (EnginePart& part : engine.parts) part.stops.forced = engine.forced;
        engine.guarded = instance_.at(plan.guarded);
        auto* placed = new (&instance_.engines()[a]) Engine;
        placed->place(engine, instance_.clock());
        placed->on_stop(
            [](void* self, StopReason reason, std::uint64_t detail, const Engine& from) noexcept
            TAPPET_REALTIME { static_cast<MachineInstance*>(self)->ask_stop(reason, detail, &from); },
            &instance_);
    }
}

/// Whether edges or frames may cause what a periodic activity does.
bool MachineBuilder::hears_causes(std::size_t activity) const {
    const MachineView& table = machine_.table;
    for (std::size_t x = 0; x < table.connections.size(); ++x)
        if (machine_.index.activity[machine_.index.connections[x].to.component] == activity && is_cause(x))
            return true;
    return std::ranges::any_of(machine_.index.reactions, [&](const Link& each) {
        return machine_.index.activity[each.to.component] == activity;
    });
}

void MachineBuilder::place_scope() {
    if (machine_.plan.scope_at == 0) return;
    const MachineView& table = machine_.table;
    const auto after = [this](std::size_t place) { return place - machine_.plan.scope_at; };
    auto* directory = new (instance_.at<scope::Directory>(machine_.plan.scope_at)) scope::Directory;
    directory->tapes_at = sizeof(scope::Directory);
    directory->tapes = static_cast<std::uint32_t>(table.activities.size());
    directory->recordings_at = after(machine_.plan.recordings_at);
    directory->recordings = static_cast<std::uint32_t>(machine_.plan.recordings);
    directory->recording_stride = scope::recording_bytes;
    directory->bytes = directory->recordings_at + directory->recordings * directory->recording_stride;
    for (std::size_t a = 0; a < table.activities.size(); ++a) {
        const ActivityPlan& plan = machine_.plan.activities[a];
        new (&scope::tapes(*directory)[a]) scope::Tape{after(plan.tape_at), table.activities[a].real_time};
        instance_.engines()[a].record_to(new (instance_.at<CycleTape>(plan.tape_at))
                                             CycleTape{plan.tape_words});
    }
    for (std::size_t i = 0; i < directory->recordings; ++i)
        new (&scope::recording(*directory, i)) scope::Recording;
    for (std::size_t c = 0; c < table.components.size(); ++c)
        if (table.components[c].type->records_cycles)
            directory->owner = static_cast<std::uint32_t>(machine_.index.activity[c]);
}

void MachineBuilder::connect_clocks() {
    for (std::size_t c = 0; c < machine_.table.components.size(); ++c) {
        const Time* now = instance_.engines()[machine_.index.activity[c]].now_address();
        const auto facets = machine_.table.components[c].type->facets;
        for (std::size_t f = 0; f < facets.size(); ++f)
            if (facets[f].kind == FacetKind::input || facets[f].kind == FacetKind::output)
                facets[f].port->set_clock(instance_.facet({c, f}), facets[f].kind == FacetKind::input, now);
    }
}

/// Says which member of a component its interface() does not list. A driver has more ports than its map's
/// rows need; a service that sees the machine has members of the kinds of others.
Sentence MachineBuilder::describe_unlisted() const {
    const ComponentRow& row = machine_.table.components[unlisted_.component];
    return Sentence{"component \"",
                    row.name,
                    "\": its type ",
                    row.type->tag->name,
                    " has ",
                    unlisted_.kind->name,
                    place_among_members(unlisted_.component, unlisted_.member),
                    " that interface() does not list, so that ",
                    unlisted_.kind->effect,
                    "; list it, ",
                    unlisted_.kind->word,
                    ", or remove it"};
}

/// Describes an address in a component by the listed members around it.
Sentence MachineBuilder::place_among_members(std::size_t c, const std::byte* address) const {
    const auto facets = machine_.table.components[c].type->facets;
    const auto* const memory = static_cast<const std::byte*>(instance_.component(c));
    const std::byte* below = nullptr;
    const std::byte* above = nullptr;
    std::string_view before, behind;
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const auto* const member = static_cast<const std::byte*>(instance_.place_of({c, f}));
        if (member < memory || member >= memory + machine_.table.components[c].type->size) continue;
        if (member < address && (below == nullptr || member > below)) below = member, before = facets[f].name;
        if (member > address && (above == nullptr || member < above)) above = member, behind = facets[f].name;
    }
    Sentence text;
    if (below != nullptr) text.add(" behind \"").add(before).add("\"");
    if (above != nullptr) text.add(below != nullptr ? " and" : "").add(" before \"").add(behind).add("\"");
    return text;
}

bool MachineBuilder::has_initial(std::size_t connection) const noexcept {
    const ConnectionRow& row = machine_.table.connections[connection];
    return row.substitute.given || row.before_first.given;
}

/// Whether a component's outputs lead back to the writer of one of its inputs, by rows that keep their
/// readers from starting.
bool MachineBuilder::is_in_circle(const Link& input) const {
    constexpr std::size_t most = 64;
    Bounded<std::size_t, most> led_to;
    static_cast<void>(led_to.push(input.to.component));
    const MachineView& table = machine_.table;
    for (std::size_t i = 0; i < led_to.size(); ++i)
        for (std::size_t x = 0; x < table.connections.size(); ++x) {
            const Link& link = machine_.index.connections[x];
            if (link.from.component != led_to[i] || !is_needed_input(table, table.connections[x], link) ||
                (table.connections[x].max_age == Duration::zero() && has_initial(x)))
                continue;
            if (link.to.component == input.from.component) return true;
            if (std::ranges::find(led_to, link.to.component) == led_to.end())
                static_cast<void>(led_to.push(link.to.component));
        }
    return false;
}

void MachineBuilder::place_needed_inputs() {
    const MachineView& table = machine_.table;
    // Not for the value of the previous step: the first step has none.
    const auto awaits = [&](std::size_t x) {
        const Link& link = machine_.index.connections[x];
        for (std::size_t e = 0; e < table.extras->size(); ++e)
            if (table.extras->at(e)->awaits(table, link.from.component, link.to.component))
                return !table.connections[x].delayed_step;
        return false;
    };
    std::size_t placed[max_activities] = {};
    for (std::size_t x = 0; x < table.connections.size(); ++x) {
        const Link& link = machine_.index.connections[x];
        if (!is_needed_input(table, table.connections[x], link)) continue;
        const Facet& input = facet_at(table, link.to);
        const std::size_t reader = machine_.index.activity[link.to.component];
        const std::size_t writer = machine_.index.activity[link.from.component];
        const EnginePart& from =
            instance_.at(machine_.plan.activities[writer].parts)[machine_.plan.part_of[link.from.component]];
        const bool is_awaited = input.valid_to_start || awaits(x);
        new (&instance_.at(machine_.plan.activities[reader].inputs)[placed[reader]++])
            NeededInput{.input = instance_.facet(link.to),
                        .flow = input.port->flow,
                        .part = machine_.plan.part_of[link.to.component],
                        .facet = static_cast<std::uint16_t>(link.to.facet),
                        .has_initial = has_initial(x),
                        .same_activity = writer == reader,
                        .valid_to_start = is_awaited,
                        .circle = !is_awaited && is_in_circle(link) ? &from.state : nullptr};
    }
}

LifeSign MachineBuilder::life_sign_of(std::string_view watched) noexcept {
    if (watched.empty()) return {};
    if (const std::size_t a = find_activity(machine_.table, watched); a != nowhere)
        return {&instance_.engines()[a], &instance_.engines()[a], &cycles_of, &is_engine_expected,
                instance_.engines()[a].plan().periodic ? nullptr : &rests};
    End output;
    static_cast<void>(resolve(machine_.table, machine_.index.by_name, watched, FacetKind::output, output));
    for (std::size_t x = 0; x < machine_.table.connections.size(); ++x)
        if (machine_.index.connections[x].from == output && machine_.plan.connections[x].shared) {
            const std::size_t a = machine_.index.activity[output.component];
            return {instance_.at<void>(machine_.plan.connections[x].memory_at),
                    &instance_.engines()[a].plan().parts[machine_.plan.part_of[output.component]],
                    facet_at(machine_.table, output).port->written, &is_part_expected};
        }
    return {};
}

} // namespace tappet
