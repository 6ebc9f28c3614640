// Wiring of components that run in turns, and the hand-over from one chain to another.
#include "kernel/control/control.hpp"

#include "kernel/machine/instance/instance.hpp"

#include <bit>
#include <new>

namespace tappet {

namespace control_detail {

namespace {

constexpr Engine::Parts bit(std::uint32_t part) noexcept TAPPET_REALTIME { return Engine::Parts{1} << part; }

/// Finds the parts of the row's level, by chain, and those that always run.
void find_parts(const ControlView& control, const AcceptedMachine& accepted, std::size_t activity,
                Turns& turns) {
    const MachineView& m = accepted.table;
    const auto part_of = [&](std::string_view name) {
        return accepted.plan.part_of[find_component(m, name)];
    };
    for (std::size_t k = 0; k < turns.rows->chains.size(); ++k)
        for (const std::string_view member : turns.rows->chains[k].members)
            turns.members[k] |= bit(part_of(member));
    for (const LevelRow& level : control.levels)
        for (const RoleRow& role : level.roles) {
            bool by_turns = accepted.index.activity[find_component(m, role.component)] != activity;
            for (const ExclusiveRow& row : control.exclusives)
                by_turns |= chains_of(row, role.component) != 0;
            if (!by_turns) turns.level |= bit(part_of(role.component));
        }
}

bool is_controller(const ControlView& control, std::string_view component) noexcept {
    for (const LevelRow& level : control.levels)
        for (const RoleRow& role : level.roles)
            if (role.role == ControlRole::controller && role.component == component) return true;
    return false;
}

void find_inputs(const ControlView& control, MachineInstance& machine, Turns& turns) {
    const AcceptedMachine& accepted = machine.machine();
    for (std::size_t x = 0; x < accepted.table.connections.size(); ++x) {
        const Link& link = accepted.index.connections[x];
        if (accepted.table.connections[x].buffered) continue;
        void* const input = machine.facet(link.to);
        const PortOperations* const port = facet_at(accepted.table, link.to).port;
        if (is_member(*turns.rows, accepted.table, link.to.component) &&
            accepted.index.activity[link.from.component] != accepted.index.activity[link.to.component])
            static_cast<void>( // the check counted them
                turns.watched.push({input, port, accepted.plan.part_of[link.to.component]}));
        const unsigned writer = chains_of(*turns.rows, accepted.table.components[link.from.component].name);
        bool is_shared = false;
        for (std::size_t j = 0; j < accepted.table.connections.size(); ++j)
            is_shared |= j != x && accepted.index.connections[j].to == link.to;
        if (writer == 0 || !is_shared) continue;
        SharedInput* place = nullptr;
        for (SharedInput& each : turns.shared)
            if (each.input == input) place = &each;
        if (place == nullptr) {
            static_cast<void>(turns.shared.push(
                {.input = input,
                 .port = port,
                 .part = accepted.plan.part_of[link.to.component],
                 .facet = static_cast<std::uint16_t>(link.to.facet),
                 .of_controller =
                     is_controller(control, accepted.table.components[link.to.component].name)}));
            place = turns.shared.end() - 1;
        }
        for (std::size_t k = 0; k < turns.rows->chains.size(); ++k)
            if ((writer >> k & 1) != 0)
                place->writers[k] = {machine.facet(link.from),
                                     bit(accepted.plan.part_of[link.from.component])};
    }
}

void find_calls(MachineInstance& machine, Turns& turns) {
    const AcceptedMachine& accepted = machine.machine();
    for (std::size_t x = 0; x < accepted.table.reactions.size(); ++x) {
        const Link& link = accepted.index.reactions[x];
        if (!is_answered_by_turns(*turns.rows, accepted.table, accepted.index, x)) continue;
        void* const call = machine.facet(link.from);
        SharedCall* place = nullptr;
        for (SharedCall& each : turns.calls)
            if (each.call == call) place = &each;
        if (place == nullptr) {
            static_cast<void>( // the check counted them
                turns.calls.push(
                    {.call = call, .operations = facet_at(accepted.table, link.from).method_call}));
            place = turns.calls.end() - 1;
        }
        const unsigned in = chains_of(*turns.rows, accepted.table.components[link.to.component].name);
        for (std::size_t k = 0; k < turns.rows->chains.size(); ++k)
            if ((in >> k & 1) != 0)
                place->goals[k] = {facet_at(accepted.table, link.to).method->call,
                                   machine.gate_of(link.to.component)};
    }
}

} // namespace

std::size_t Turns::find(std::string_view chain) const noexcept TAPPET_REALTIME {
    for (std::size_t k = 0; k < rows->chains.size(); ++k)
        if (rows->chains[k].name == chain) return k;
    return nowhere;
}

Engine::Parts Turns::all() const noexcept TAPPET_REALTIME {
    Engine::Parts parts = 0;
    for (const Engine::Parts each : members) parts |= each;
    return parts;
}

const Stops* Turns::stops_of(const Writer& writer) const noexcept TAPPET_REALTIME {
    return &engine->plan().parts[static_cast<std::size_t>(std::countr_zero(writer.part))].stops;
}

void Turns::link(std::size_t chain, Engine::Parts beginning) noexcept TAPPET_REALTIME {
    for (const SharedInput& each : shared) {
        const Writer& writer = each.writers[chain];
        if (writer.output == nullptr) continue;
        if ((writer.part & beginning) != 0) each.port->forget(writer.output);
        each.port->link_local(each.input, writer.output, stops_of(writer));
    }
    for (const SharedCall& each : calls) each.operations->aim(each.call, &each.goals[chain]);
}

void Turns::begin() noexcept TAPPET_REALTIME {
    link(0, members[0]);
    engine->rest(all() & ~members[0], all());
    running.store(0, std::memory_order_release);
}

LifeAnswer Turns::hand_over(std::size_t next) noexcept TAPPET_REALTIME {
    const std::size_t now = running.load(std::memory_order_relaxed);
    const Engine::Parts again = told_by_another(now, next);
    const Engine::Parts entering = members[next] & ~members[now];
    link(next, entering);
    LifeAnswer answer = engine->enter(entering);
    if (answer.outcome != LifeOutcome::refused) {
        answer = find_unwritten(next);
        // From the sent value, so that a set point from another writer causes no jump.
        if (answer.outcome != LifeOutcome::refused) answer = engine->begin_anew(again);
        if (answer.outcome == LifeOutcome::refused) engine->leave(entering);
    }
    if (answer.outcome == LifeOutcome::refused) {
        link(now, 0);
        static_cast<void>(engine->begin_anew(again)); // they ran on these inputs a moment ago
        return answer;
    }
    engine->leave(members[now] & ~members[next]);
    for (const SharedInput& each : shared)
        if (const Writer& writer = each.writers[next]; writer.output != nullptr)
            each.port->hand_force_to(each.input, stops_of(writer));
    running.store(static_cast<std::uint32_t>(next), std::memory_order_release);
    times[next].fetch_add(1, std::memory_order_relaxed);
    return answer;
}

Engine::Parts Turns::told_by_another(std::size_t now, std::size_t next) const noexcept TAPPET_REALTIME {
    Engine::Parts parts = 0;
    for (const SharedInput& each : shared)
        if (each.of_controller && each.writers[now].output != nullptr &&
            each.writers[next].output != nullptr && each.writers[now].output != each.writers[next].output)
            parts |= bit(each.part);
    return parts & run_in(now) & run_in(next);
}

LifeAnswer Turns::find_unwritten(std::size_t chain) const noexcept TAPPET_REALTIME {
    for (const SharedInput& each : shared)
        if (each.writers[chain].output != nullptr && (run_in(chain) & bit(each.part)) != 0 &&
            !each.port->is_written(each.writers[chain].output))
            return {LifeOutcome::refused, LifeRefusal::input_never_written,
                    static_cast<std::uint8_t>(each.part), each.facet};
    return {.outcome = LifeOutcome::done};
}

std::uint32_t Turns::failed_part(Engine::Parts among) const noexcept TAPPET_REALTIME {
    const std::span<EnginePart> parts = engine->plan().parts;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
        if ((among & bit(i)) == 0) continue;
        const ComponentState state = parts[i].state.load(std::memory_order_acquire);
        if (state < ComponentState::waiting || state > ComponentState::running) return i;
    }
    for (const WatchedInput& each : watched)
        if ((among & bit(each.part)) != 0 && each.port->flow(each.input) == Flow::stale) return each.part;
    return nobody;
}

void Turns::ask_stop(std::uint32_t part) noexcept TAPPET_REALTIME {
    machine->ask_section_stop(section, row << 16 | role_of(part), engine);
}

std::size_t Turns::role_of(std::uint32_t part) const noexcept TAPPET_REALTIME {
    std::size_t place = 0;
    for (const LevelRow& each : levels)
        for (const RoleRow& role : each.roles) {
            if (role.component == engine->plan().parts[part].name) return place;
            ++place;
        }
    for (const RoleRow& role : processes) {
        if (role.component == engine->plan().parts[part].name) return place;
        ++place;
    }
    return place;
}

void connect(const ControlView& control, MachineInstance& machine, std::size_t section,
             std::span<std::byte> memory) {
    const AcceptedMachine& accepted = machine.machine();
    for (std::size_t i = 0; i < control.exclusives.size(); ++i) {
        auto* turns = new (reinterpret_cast<Turns*>(memory.data()) + i) Turns{};
        turns->machine = &machine;
        turns->section = section;
        turns->row = i;
        turns->rows = &control.exclusives[i];
        turns->levels = control.levels;
        turns->processes = control.processes;
        const std::size_t by = find_component(accepted.table, turns->rows->by);
        const std::size_t activity = accepted.index.activity[by];
        turns->engine = &machine.engines()[activity];
        find_parts(control, accepted, activity, *turns);
        find_inputs(control, machine, *turns);
        find_calls(machine, *turns);
        static_cast<ChainSwitch*>(machine.component(by))->place(*turns);
    }
}

Sentence describe_stop(const ControlView& control, std::size_t row) {
    std::size_t place = row & 0xFFFF;
    std::string_view part{};
    for (const LevelRow& level : control.levels) {
        if (part.empty() && place < level.roles.size()) part = level.roles[place].component;
        place -= std::min(place, level.roles.size());
    }
    if (part.empty() && place < control.processes.size()) part = control.processes[place].component;
    const ExclusiveRow& exclusive = control.exclusives[row >> 16];
    return Sentence{"exclusive \"",
                    exclusive.by,
                    "\": \"",
                    part,
                    "\" stopped, could not start, or reads what is stale, and \"",
                    exclusive.chains[0].name,
                    "\" cannot run without it; see why, and start the machine again"};
}

SectionCount counted(const ControlView& control, std::span<const std::byte> memory,
                     std::size_t row) noexcept {
    for (std::size_t i = 0; i < control.exclusives.size(); ++i) {
        const auto& chains = control.exclusives[i].chains;
        if (row < chains.size())
            return {chains[row].name, reinterpret_cast<const Turns*>(memory.data())[i].times[row].load(
                                          std::memory_order_relaxed)};
        row -= chains.size();
    }
    return {};
}

} // namespace control_detail

using control_detail::Turns;

void ChainSwitch::tell() noexcept TAPPET_REALTIME {
    ScriptText name;
    static_cast<void>(
        name.assign(turns_->rows->chains[turns_->running.load(std::memory_order_relaxed)].name));
    chain.write(name);
}

void ChainSwitch::start(const Cycle&) noexcept TAPPET_REALTIME {
    turns_->begin();
    wanted_ = 0;
    is_first_step_ = true;
    hindered.write({});
    tell();
}

std::uint32_t ChainSwitch::take_over(std::size_t next) noexcept TAPPET_REALTIME {
    const LifeAnswer answer = turns_->hand_over(next);
    ScriptText hindrance;
    if (answer.outcome == LifeOutcome::refused) {
        const EnginePart& part = turns_->engine->plan().parts[answer.part];
        hindrance.append(part.name);
        if (answer.refusal != LifeRefusal::not_initialised) {
            hindrance.append(".");
            hindrance.append(part.type->facets[answer.facet].name);
        }
    }
    hindered.write(hindrance);
    tell();
    return answer.outcome == LifeOutcome::refused ? answer.part : Turns::nobody;
}

void ChainSwitch::stop(const Cycle&) noexcept TAPPET_REALTIME { turns_->engine->leave(turns_->all()); }

void ChainSwitch::step(const Cycle&) noexcept TAPPET_REALTIME {
    // Members of the fallback started with their activity, unless this component was started alone.
    if (is_first_step_ && turns_->failed_part(turns_->members[0]) != Turns::nobody)
        static_cast<void>(turns_->engine->enter(turns_->members[0])); // or it has failed: see below
    is_first_step_ = false;
    const std::size_t running = turns_->running.load(std::memory_order_relaxed);
    if (const std::uint32_t part = turns_->failed_part(turns_->level); part != Turns::nobody)
        return turns_->ask_stop(part);
    if (const std::uint32_t part = turns_->failed_part(turns_->members[running]); part != Turns::nobody) {
        wanted_ = 0;
        if (running != 0) static_cast<void>(take_over(0)); // checked below
        if (running == 0 || turns_->running.load(std::memory_order_relaxed) != 0)
            return turns_->ask_stop(part);
        fell_back.emit();
        return;
    }
    if (wanted_ == running) return;
    const std::uint32_t hinders = take_over(wanted_);
    // A request for the fallback is a request for rest: the running chain must not continue.
    if (hinders != Turns::nobody && wanted_ == 0) turns_->ask_stop(hinders);
    wanted_ = turns_->running.load(std::memory_order_relaxed);
    if (wanted_ != running) handed_over.emit();
}

bool ChainSwitch::run(const ScriptText& name) noexcept TAPPET_REALTIME {
    const std::size_t next = turns_->find(name.view());
    if (next == nowhere) return false;
    wanted_ = next;
    return true;
}

CommandProgress ChainSwitch::has_run(const ScriptText& name) noexcept TAPPET_REALTIME {
    const std::size_t next = turns_->find(name.view());
    if (turns_->running.load(std::memory_order_relaxed) == next) return CommandProgress::done;
    return wanted_ == next ? CommandProgress::executing : CommandProgress::failed;
}

bool ChainSwitch::is_running(const ScriptText& name) const noexcept TAPPET_REALTIME {
    return turns_->running.load(std::memory_order_acquire) == turns_->find(name.view());
}

} // namespace tappet
