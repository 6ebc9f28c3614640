// Binds the instances of a compiled script by hand, as start-up does for a machine.
#include "tests/kernel/script/fixture.hpp"

#include "kernel/program/interpreter.hpp"
#include "kernel/script/load.hpp"

#include <stdexcept>

namespace script_test {

namespace {

using Resolved = ResolvedMachine<ResolvedSizes{
    .states = 64, .triggers = 16, .arcs = 200, .asked = 512, .steps = 1024, .regions = 32}>;

constexpr std::array<Reachable, 3> three{{{"own", &component_type<Cell>, true},
                                          {"robot", &component_type<Cell>, true},
                                          {"far", &component_type<Cell>, false}}};

} // namespace

ScriptOutcome compile(std::string_view text, std::string_view name, const Reach& reach,
                      const ScriptRoom& room) {
    return compile_loaded(text, name, reach, room);
}

std::span<const Reachable> components() { return three; }

std::string fault_of(std::string_view text, std::uint32_t statements_per_step) {
    const auto buffer = std::make_unique<ScriptBuffer<buffer_sizes>>();
    Reach reach;
    reach.components = three;
    reach.statements_per_step = statements_per_step;
    return std::string{compile(text, "test.osd", reach, buffer->room()).fault.view()};
}

struct Slot {
    CommandSlot slot{};
    alignas(8) std::array<std::byte, 64> values{};
};

struct Played::Parts {
    Parts(Cell* own, Cell* robot, Cell* far)
        : gates{GatedComponent{own, ComponentState::running}, GatedComponent{robot, ComponentState::running},
                GatedComponent{far, ComponentState::running}} {}
    ScriptBuffer<buffer_sizes> buffer{};
    std::vector<std::vector<std::byte>> memory;
    std::vector<std::vector<ProgramLink>> links;
    std::vector<std::unique_ptr<Slot>> slots;
    std::vector<std::unique_ptr<Resolved>> resolved;
    std::vector<StateMachineExecution> machines;
    std::vector<ProgramExecution> programs;
    std::vector<std::vector<StateIndex>> history;
    std::vector<std::vector<std::byte>> deferred;

    alignas(512) std::array<std::byte, 16384> ring{};
    std::array<CommandMailbox, 1> boxes{};
    std::array<CommandSlot*, 16> followed{};
    CommandProcessor processor{};
    GatedComponent gates[3];
    os::Clock clock{os::Clock::Kind::virtual_time};
};

Played::Played(std::string_view text, std::uint32_t statements_per_step)
    : parts_{std::make_unique<Parts>(&own, &robot, &far)} {
    Parts& p = *parts_;
    Reach reach;
    reach.components = three;
    reach.statements_per_step = statements_per_step;
    outcome = compile(text, "test.osd", reach, p.buffer.room());
    if (!outcome.good()) throw std::runtime_error{std::string{outcome.fault.view()}};

    p.boxes[0].place(p.ring.data(), 16, Overflow::reject);
    p.processor.place(p.boxes, p.followed, 0);
    Cell* const cells[] = {&own, &robot, &far};
    const std::size_t count = outcome.unit.instances.size();
    p.memory.resize(count);
    p.links.resize(count);
    p.history.resize(count);
    p.deferred.resize(count);
    p.machines = std::vector<StateMachineExecution>(count);
    p.programs.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const BehaviourInstance& instance = outcome.unit.instances[i];
        const BehaviourType& type = outcome.unit.types[instance.type];
        p.memory[i].resize(type.tables.layout.size);
        std::memcpy(p.memory[i].data(), instance.image.data(), instance.image.size());
        for (const LinkRow& row : type.tables.links) {
            ProgramLink link;
            link.component = &p.gates[row.peer];
            link.place = cells[row.peer];
            link.type = three[row.peer].type;
            const Facet& facet = link.type->facets[row.facet];
            if (facet.at != nullptr) link.place = facet.at(cells[row.peer], facet.index);
            if (row.needs_slot) {
                p.slots.push_back(std::make_unique<Slot>());
                CommandSlot::Route route;
                route.command = facet.command;
                route.receiver = link.component;
                route.inbox = &p.processor.inbox();
                route.clock = &p.clock;
                p.slots.back()->slot.place(route, p.slots.back()->values.data());
                link.slot = &p.slots.back()->slot;
            }
            p.links[i].push_back(link);
        }
        if (type.is_program()) {
            ProgramContext context;
            context.component = &own;
            context.data = p.memory[i].data();
            context.links = p.links[i].data();
            p.programs[i].bind(interpreted(type.tables), context, instance.image);
            static_cast<void>(p.programs[i].start());
            p.resolved.push_back(nullptr);
            continue;
        }
        p.resolved.push_back(std::make_unique<Resolved>());
        if (const Sentence fault = p.resolved.back()->load(type.machine); !fault.empty())
            throw std::runtime_error{std::string{fault.view()}};
        StateMachineBinding binding;
        binding.machine = p.resolved.back()->view();
        binding.component = &own;
        binding.code = interpreted(type.tables);
        binding.data = p.memory[i].data();
        binding.links = p.links[i].data();
        if (instance.children != 0) binding.machines = &p.machines[instance.first_child];
        p.history[i].resize(binding.machine.sizes.history);
        p.deferred[i].resize(binding.machine.sizes.captured * StateMachineExecution::max_raised_events);
        binding.history = p.history[i];
        binding.deferred = p.deferred[i];
        if (!p.machines[i].bind(binding)) throw std::runtime_error{"a machine was not bound"};
    }
}

Played::~Played() = default;

void Played::step() {
    Parts& p = *parts_;
    now_ += std::chrono::milliseconds{10};
    p.processor.serve([&p](std::uint32_t, CommandSlot& each) noexcept
                      TAPPET_REALTIME { static_cast<void>(p.processor.take_up(each)); });
    p.processor.follow([](std::uint32_t, CommandSlot& each) noexcept
                       TAPPET_REALTIME { return !in_flight(each.follow()); });
    for (std::size_t i = 0; i < p.programs.size(); ++i) {
        if (outcome.unit.types[outcome.unit.instances[i].type].is_program())
            p.programs[i].step(now_);
        else
            p.machines[i].step(now_);
    }
}

void Played::stop_far() { parts_->gates[2].state = ComponentState::stopped; }

ProgramExecution& Played::program() {
    for (std::size_t i = 0; i < outcome.unit.instances.size(); ++i)
        if (outcome.unit.types[outcome.unit.instances[i].type].is_program()) return parts_->programs[i];
    throw std::runtime_error{"the script has no program"};
}

StateMachineExecution& Played::machine(std::string_view name) {
    for (std::size_t i = 0; i < outcome.unit.instances.size(); ++i)
        if (outcome.unit.instances[i].name == name) return parts_->machines[i];
    throw std::runtime_error{"no such instance"};
}

std::string Played::state(std::string_view name) {
    const StateMachineExecution& of = machine(name);
    return of.active() == no_state ? "" : std::string{of.machine().table.states[of.active()].name};
}

StateOutcome Played::dispatch(std::string_view machine_name, std::string_view event_name,
                              const std::byte* packed) {
    StateMachineExecution& of = machine(machine_name);
    for (std::size_t t = 0; t < of.machine().triggers.size(); ++t)
        if (of.machine().triggers[t] == event_name) return of.dispatch(t, now_, packed);
    throw std::runtime_error{"no such event"};
}

std::byte* Played::variable_at(std::string_view instance, std::string_view variable) {
    for (std::size_t i = 0; i < outcome.unit.instances.size(); ++i) {
        if (outcome.unit.instances[i].name != instance) continue;
        for (const VariableRow& row : outcome.unit.types[outcome.unit.instances[i].type].tables.variables)
            if (row.name == variable) return parts_->memory[i].data() + row.at;
    }
    throw std::runtime_error{"no such variable"};
}

} // namespace script_test
