// Binds a unit by hand, as a machine does from its plan.
#include "tests/differential/unit_bench.hpp"

#include "kernel/program/operator_kinds.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace tappet {

namespace {

std::string print(double value) {
    std::array<char, 40> text{};
    if (value != value) return "nan";
    static_cast<void>(std::snprintf(text.data(), text.size(), "%.17g", value));
    return text.data();
}

std::string print(TypeId type, const std::byte* at) {
    const auto whole = [&](auto number) {
        std::memcpy(&number, at, sizeof number);
        return std::to_string(number);
    };
    switch (type->kind) {
    case ValueKind::boolean: return *at != std::byte{0} ? "true" : "false";
    case ValueKind::integer: return type->size == 8 ? whole(std::int64_t{}) : whole(std::int32_t{});
    case ValueKind::duration: return whole(std::int64_t{}) + "ns";
    case ValueKind::real: {
        double number = 0;
        std::memcpy(&number, at, sizeof number);
        return print(number);
    }
    case ValueKind::matrix: {
        std::string text = "[";
        for (std::size_t i = 0; i < type->rows * type->columns; ++i)
            text += print(type->element, at + i * type->element->size) + " ";
        return text + "]";
    }
    case ValueKind::text: {
        ScriptText text;
        std::memcpy(&text, at, sizeof text);
        return std::string{text.view()};
    }
    case ValueKind::record: {
        std::string text = "{";
        for (const RecordField& each : type->fields) text += print(each.type, at + each.offset()) + " ";
        return text + "}";
    }
    default: return "?";
    }
}

} // namespace

struct UnitBench::Heard {
    UnitBench* bench = nullptr;
    const Facet* facet = nullptr;
    std::string name{};

    void note(const std::byte* packed) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's diary grows", write(packed));
    }
    void write(const std::byte* packed) {
        std::string line = "event " + name;
        const std::byte* at = packed;
        for (TypeId type : facet->type->elements) {
            line += " " + print(type, at);
            at += type->size;
        }
        bench->diary.write(line);
        bench->hear(name, packed);
    }
    template <class... A>
    static void react(void* context, A... arguments) noexcept TAPPET_REALTIME {
        std::array<std::byte, (std::size_t{1} + ... + sizeof(A))> packed{};
        [[maybe_unused]] std::byte* at = packed.data();
        ((std::memcpy(at, &arguments, sizeof arguments), at += sizeof arguments), ...);
        static_cast<Heard*>(context)->note(packed.data());
    }
    template <class... A>
    static constexpr void (*call)(void*, A...) noexcept TAPPET_REALTIME = &Heard::react<A...>;
};

std::span<const Reachable> UnitBench::reach() {
    static constexpr std::array<Reachable, 3> list{{{"own", &component_type<Bench>, true},
                                                    {"mate", &component_type<Bench>, true},
                                                    {"arm", &component_type<Arm>, false}}};
    return list;
}

UnitBench::UnitBench() {
    own.diary = mate.diary = &diary;
    own.name = "own";
    mate.name = "mate";
    arm.diary = &diary;
    PortAccess::data<double>.link_local(&own.measured, &source, nullptr);
    for (void* output :
         {static_cast<void*>(&source), static_cast<void*>(&own.setpoint), static_cast<void*>(&mate.setpoint)})
        PortAccess::data<double>.set_clock(output, false, &now);
    PortAccess::data<double>.set_clock(&own.measured, true, &now);
    PortAccess::data<double>.set_clock(&mate.measured, true, &now);
    source.write(0);
    connect(feed, own.queue);
    connect(own.sent, drain);
    for (Bench* each : {&own, &mate})
        for (const Facet& facet : component_type<Bench>.facets) {
            if (facet.kind != FacetKind::event) continue;
            void* const event = facet.at(each, facet.index);
            subscribers_.emplace_back(facet.event->subscriber_bytes + 16);
            facet.event->give_storage(event, subscribers_.back().data());
            heard_.push_back(std::make_unique<Heard>(
                this, &facet, (each == &own ? "" : "mate.") + std::string{facet.name}));
            const void* call = facet.name == "tick" ? static_cast<const void*>(&Heard::call<>)
                               : facet.name == "moved"
                                   ? static_cast<const void*>(&Heard::call<std::int32_t, double>)
                                   : static_cast<const void*>(&Heard::call<bool>);
            facet.event->subscribe(event, call, heard_.back().get()) |= 1;
        }
    constexpr std::size_t letters = 64;
    mail_.resize(CommandMailbox::bytes_for(letters) + CommandMailbox::alignment);
    const std::size_t misaligned = reinterpret_cast<std::uintptr_t>(mail_.data()) % CommandMailbox::alignment;
    mailbox_ = std::make_unique<CommandMailbox>(
        mail_.data() + (misaligned == 0 ? 0 : CommandMailbox::alignment - misaligned), letters,
        Overflow::reject);
    followed_.resize(letters);
    commands_.place({mailbox_.get(), 1}, followed_, letters);
}

UnitBench::~UnitBench() = default;

template <class T> void UnitBench::connect(BufferOutput<T>& from, BufferInput<T>& to) {
    const BufferOperations& operations = PortAccess::buffer<T>;
    std::vector<std::byte>& ring =
        rings_.emplace_back(operations.ring_bytes(places, false) + operations.ring_align);
    const std::size_t misaligned = reinterpret_cast<std::uintptr_t>(ring.data()) % operations.ring_align;
    operations.link(&from, &to, ring.data() + (misaligned == 0 ? 0 : operations.ring_align - misaligned),
                    places, Overflow::reject, false);
}

void UnitBench::bind_links(BenchPart& part) {
    void* const components[] = {&own, &mate, &arm};
    for (const LinkRow& row : part.type->tables.links) {
        const ComponentType& type = *reach()[row.peer].type;
        ProgramLink link;
        link.component = &gates_[row.peer];
        link.place = components[row.peer];
        link.type = &type;
        if (row.facet != LinkRow::component_itself) {
            const Facet& facet = type.facets[row.facet];
            if (facet.at != nullptr) link.place = facet.at(components[row.peer], facet.index);
            if (row.needs_slot) {
                CommandSlot& slot = slots_.emplace_back();
                slot_values_.emplace_back(facet.command->value_bytes() + 1);
                CommandSlot::Route route;
                route.command = facet.command;
                route.receiver = link.component;
                route.inbox = &commands_.inbox();
                slot.place(route, slot_values_.back().data());
                link.slot = &slot;
            }
        }
        part.links.push_back(link);
    }
}

void UnitBench::resolve(BenchPart& part, const ProgramCode& code, const StateMachineFast& fast,
                        const StateMachinePolicy& policy) {
    const ResolvedSizes sizes = measure(part.type->machine);
    part.plans.resize(sizes.states);
    part.triggers.resize(sizes.triggers);
    part.cells.resize(sizes.states * sizes.triggers);
    part.asked.resize(sizes.asked);
    part.arcs.resize(sizes.arcs);
    part.steps.resize(sizes.steps);
    part.regions.resize(sizes.regions);
    part.captured.resize(sizes.triggers);
    part.history.resize(sizes.history);
    part.deferred.resize(sizes.captured * StateMachineExecution::max_raised_events);
    const ResolvedRoom room{part.plans, part.triggers, part.cells,   part.asked,
                            part.arcs,  part.steps,    part.regions, part.captured};
    StateMachineBinding binding;
    binding.machine = resolve_into(part.type->machine, room);
    binding.component = &own;
    binding.code = code;
    binding.data = part.data;
    binding.links = part.links.data();
    if (part.row->children != 0) binding.machines = &machines_[part.row->first_child];
    binding.history = part.history;
    binding.deferred = part.deferred;
    binding.policy = policy;
    binding.beside = {&parts_.front().program, programs_beside()};
    if (part.row->parent != no_instance) binding.parent = &machines_[part.row->parent];
    binding.fast = fast;
    if (!part.machine->bind(binding)) std::abort();
}

void UnitBench::place(const ScriptUnit& unit, std::span<const ProgramCode> code,
                      std::span<const StateMachineFast> fast, StateMachinePolicy policy) {
    unit_ = unit;
    machines_ = std::make_unique<StateMachineExecution[]>(unit_.instances.size());
    for (const BehaviourInstance& row : unit_.instances) {
        BenchPart& part = parts_.emplace_back();
        part.row = &row;
        part.machine = &machines_[parts_.size() - 1];
        part.type = &unit_.types[row.type];
        const std::size_t bytes = part.type->tables.layout.size + data_alignment;
        part.memory = std::make_unique<std::byte[]>(bytes);
        const std::size_t misaligned = reinterpret_cast<std::uintptr_t>(part.memory.get()) % data_alignment;
        part.data = part.memory.get() + (misaligned == 0 ? 0 : data_alignment - misaligned);
        std::copy(row.image.begin(), row.image.end(), part.data);
        bind_links(part);
    }
    for (BenchPart& part : parts_) {
        const ProgramCode with = code.empty() ? interpreted(part.type->tables) : code[part.row->type];
        if (part.is_program()) {
            ProgramContext context;
            context.component = &own;
            context.data = part.data;
            context.links = part.links.data();
            part.program.bind(with, context, part.row->image, {.statements = policy.statements});
        } else {
            resolve(part, with, fast.empty() ? StateMachineFast{} : fast[part.row->type], policy);
        }
    }
}

void UnitBench::start() {
    for (BenchPart& part : parts_) {
        if (part.row->parent != no_instance) continue;
        if (!part.is_program())
            static_cast<void>(part.machine->start(now));
        else if (!part.row->on_command)
            static_cast<void>(part.program.start());
    }
}

void UnitBench::step() {
    for (BenchPart& part : parts_)
        if (part.is_program()) part.program.step(now);
    for (BenchPart& part : parts_)
        if (!part.is_program()) part.machine->step(now);
}

void UnitBench::step_arm() {
    commands_.serve([this](std::uint32_t, CommandSlot& slot) noexcept
                    TAPPET_REALTIME { static_cast<void>(commands_.take_up(slot)); });
    static_cast<void>(commands_.follow([](std::uint32_t, CommandSlot& slot) noexcept
                                       TAPPET_REALTIME { return !in_flight(slot.follow()); }));
}

void UnitBench::hear(std::string_view event, const std::byte* packed) {
    for (BenchPart& part : parts_) {
        if (part.is_program()) continue;
        for (std::size_t i = 0; i < part.triggers.size(); ++i)
            if (part.triggers[i] == event) static_cast<void>(part.machine->dispatch(i, now, packed));
    }
}

BenchPart& UnitBench::part(std::string_view name) {
    for (BenchPart& each : parts_)
        if (each.row->name == name) return each;
    std::abort();
}

std::string UnitBench::picture(const BenchPart& part) const {
    if (part.is_program())
        return std::string{to_text(part.program.status())} +
               (part.program.status() == ProgramStatus::error
                    ? " in line " + std::to_string(part.program.line())
                    : "");
    const StateMachineExecution& machine = *part.machine;
    std::string text = machine.in_error() ? "error" : machine.is_active() ? "active" : "inactive";
    if (machine.is_paused()) text += " paused";
    if (machine.is_active() && !machine.is_automatic()) text += " reactive";
    for (const ActiveState& each : machine.states())
        text.append(" ").append(machine.machine().table.states[each.state].name);
    return text;
}

std::string UnitBench::value(const BenchPart& part, const VariableRow& row) const {
    return std::string{row.name} + "=" + print(row.type, part.data + row.at);
}

} // namespace tappet
