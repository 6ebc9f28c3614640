// The events of a random day, and the comparison after each of them.
#include "tests/differential/random_day.hpp"

#include <array>
#include <cstring>

namespace tappet {

using reference::Value;

void RandomDay::Alone::start(const reference::Type& type) {
    if (status == "running" || status.starts_with("error")) return;
    if (status != "paused") run.start(&type.body, true);
    status = "running";
}

void RandomDay::Alone::step(std::int64_t now, std::int64_t statements) {
    switch (run.run(scope, now, statements)) {
    case reference::ProgramRun::Result::ended: status = "stopped"; break;
    case reference::ProgramRun::Result::failed: status = "error in line " + std::to_string(run.line()); break;
    default: break;
    }
}

void RandomDay::Alone::stop() {
    if (status != "ready" && status != "stopped") status = "stopped", run.drop();
}

bool RandomDay::Aid::begin(const std::vector<Value>& given) {
    if (status == "running") return false;
    for (std::size_t i = 0; i < given.size(); ++i) {
        const reference::Variable& parameter = type->variables[i];
        scope.declare(parameter.name, parameter.type, *reference::convert(given[i], parameter.type));
    }
    run.start(&type->body, true, type->result);
    status = "running";
    has_ended = false;
    return true;
}

reference::Answer RandomDay::Aid::ended() {
    if (status == "running") return reference::Answer::no;
    return has_ended ? reference::Answer::yes : reference::Answer::failed;
}

void RandomDay::Aid::stop() {
    if (!is_in_step) return Alone::stop();
    is_to_stop = true;
}

void RandomDay::Aid::advance(std::int64_t now, std::int64_t statements) {
    if (type == nullptr || status != "running") return;
    is_in_step = true;
    is_to_stop = false;
    step(now, statements);
    is_in_step = false;
    has_ended = status == "stopped";
    if (is_to_stop && status == "running") Alone::stop();
}

RandomDay::RandomDay(std::uint64_t seed, const std::string& text, const ScriptUnit& unit,
                     std::span<const ProgramCode> code, std::span<const StateMachineFast> fast)
    : random_{seed}, script_{reference::read(text)} {
    // Few statements in a step: the rest runs in the next one.
    policy_ = {.statements = random_.one_in(2) ? static_cast<std::uint32_t>(random_.between(1, 8)) : 100'000,
               .escalates = random_.one_in(2)};
    bench_.place(unit, code, fast, policy_);
    if (script_.types.front().on_command) {
        aid_.type = &script_.types.front();
        aid_.scope.world = &world_;
        for (const reference::Variable& each : aid_.type->variables)
            aid_.scope.declare(each.name, each.type, reference::zero_of(each.type));
        world_.aid = &aid_;
    }
    if (script_.roots.empty()) {
        alone_.scope.world = &world_;
    } else {
        root_ = std::make_unique<reference::Machine>(
            script_, script_.roots[0], script_.roots[0].name, world_,
            reference::Machine::Policy{policy_.statements, policy_.escalates});
        world_.heard = [this](const std::string& event, const std::vector<Value>& given) {
            for (std::size_t i = 0; i <= root_->children().size(); ++i)
                machine(i).event(event, given, bench_.now.time_since_epoch().count());
        };
    }
}

reference::Machine& RandomDay::machine(std::size_t i) const {
    return i == 0 ? *root_ : *root_->children()[i - 1];
}

BenchPart& RandomDay::part(std::size_t i) const {
    UnitBench& bench = const_cast<UnitBench&>(bench_);
    return bench.parts()[bench.programs_beside() + i];
}

void RandomDay::did(const std::string& what) {
    world_.diary.write("-- " + what);
    bench_.diary.write("-- " + what);
}

std::string RandomDay::run(int steps) {
    const std::int64_t now = bench_.now.time_since_epoch().count();
    did("start");
    bench_.start();
    if (root_ != nullptr)
        root_->start(now);
    else
        alone_.start(script_.types[0]);
    for (int i = 0; i < steps; ++i) {
        if (std::string found = difference(); !found.empty()) return found;
        do_something();
    }
    return difference();
}

void RandomDay::step() {
    did("step at " + std::to_string(bench_.now.time_since_epoch().count()));
    const std::int64_t now = bench_.now.time_since_epoch().count();
    bench_.step();
    aid_.advance(now, policy_.statements);
    if (root_ == nullptr) {
        if (alone_.status == "running") alone_.step(now, policy_.statements);
        return;
    }
    for (std::size_t i = 0; i <= root_->children().size(); ++i) machine(i).step(now);
}

/// Executes a single step of a paused behaviour.
void RandomDay::single_step() {
    did("single step");
    const std::int64_t now = bench_.now.time_since_epoch().count();
    if (root_ == nullptr) {
        part(0).program.single_step(bench_.now);
        if (alone_.status == "paused") alone_.step(now, 1);
        return;
    }
    for (std::size_t i = 0; i <= root_->children().size(); ++i) {
        part(i).machine->step_once(bench_.now);
        machine(i).step_once(now);
    }
}

void RandomDay::do_something() {
    switch (random_.below(12)) {
    case 0:
    case 1:
    case 2:
        if (root_ != nullptr) return emit();
        break;
    case 3: {
        const double value = static_cast<double>(random_.below(10));
        did("measured " + std::to_string(value));
        bench_.source.write(value);
        world_.measured = value;
        return;
    }
    case 4:
        if (random_.one_in(2)) return root_ != nullptr ? command() : command_program();
        break;
    case 6: return random_.one_in(2) ? feed() : drain();
    case 5: {
        const bool value = random_.one_in(2);
        did(value ? "opened" : "closed");
        bench_.mate.open.set(value);
        world_.mate.open.set(value);
        return;
    }
    default: break;
    }
    if (!random_.one_in(5)) {
        did("arm");
        bench_.step_arm();
        world_.step_arm();
    }
    bench_.now += Duration{random_.between(1, 30) * 1'000'000};
    random_.one_in(3) ? single_step() : step();
}

void RandomDay::feed() {
    const std::int64_t number = random_.between(-3, 100'000);
    const bool taken = bench_.feed.push(number);
    did("fed " + std::to_string(number) + (taken ? "" : " in vain"));
    if (taken) world_.queue.push_back(number);
}

void RandomDay::drain() {
    double one = 0, other = 0;
    const bool is_there = bench_.drain.pop(one);
    if (!world_.sent.empty()) other = world_.sent.front(), world_.sent.pop_front();
    bench_.diary.write("-- drained " + (is_there ? reference::print(Value{one}) : "nothing"));
    world_.diary.write("-- drained " + (is_there ? reference::print(Value{other}) : "nothing"));
}

void RandomDay::emit() {
    const bool at_mate = random_.one_in(2);
    Bench& bench = at_mate ? bench_.mate : bench_.own;
    const std::string prefix = at_mate ? "mate." : "";
    switch (random_.below(4)) {
    case 0:
    case 1:
        did("tick");
        bench.tick();
        world_.emit(prefix + "tick", {});
        break;
    case 2: {
        const std::int32_t n = static_cast<std::int32_t>(random_.between(-100, 100));
        did("moved");
        bench.moved(n, 0.5 * n);
        world_.emit(prefix + "moved", {std::int64_t{n}, 0.5 * n});
        break;
    }
    default: {
        const bool on = random_.one_in(2);
        did("switched");
        bench.switched(on);
        world_.emit(prefix + "switched", {on});
    }
    }
}

void RandomDay::command() {
    const std::size_t which = root_->children().empty() || !random_.one_in(3) ? 0 : 1;
    reference::Machine& other = machine(which);
    StateMachineExecution& one = *part(which).machine;
    const Time at = bench_.now;
    const std::int64_t now = at.time_since_epoch().count();
    // After an error few requests have an effect.
    const bool helpless = other.in_error() && random_.one_in(2);
    switch (helpless ? 8 : random_.below(12)) {
    case 0:
        did("pause");
        one.pause(), other.pause();
        break;
    case 1:
    case 2:
    case 3:
        did("automatic");
        one.start(at), other.start(now);
        break;
    case 4:
        did("reactive");
        one.reactive(), other.reactive();
        break;
    case 5:
        did("final");
        one.request_final(at), other.request_final(now);
        break;
    case 6:
    case 7:
        did("reset");
        one.request_initial(at), other.reset(now);
        break;
    case 8:
        did("deactivate");
        one.deactivate(at), other.deactivate(now);
        break;
    default: {
        const std::size_t state = static_cast<std::size_t>(random_.below(other.type().states.size()));
        const std::string& name = other.type().states[state].name;
        const bool run_once = random_.one_in(2);
        did("request " + name + (run_once ? " once" : ""));
        const auto& states = one.machine().table.states;
        for (std::size_t i = 0; i < states.size(); ++i)
            if (states[i].name == name) one.request_state(static_cast<StateIndex>(i), at, run_once);
        other.request(name, run_once, now);
    }
    }
}

void RandomDay::command_program() {
    ProgramExecution& program = part(0).program;
    switch (random_.below(4)) {
    case 0:
        did("pause");
        program.pause();
        if (alone_.status == "running") alone_.status = "paused";
        break;
    case 1:
        did("stop");
        program.stop();
        alone_.stop();
        break;
    default:
        did("start");
        program.start();
        alone_.start(script_.types[0]);
    }
}

std::string RandomDay::compare(const BenchPart& part, const std::string& picture,
                               const reference::Scope& scope) const {
    std::string text;
    if (const std::string real = bench_.picture(part); real != picture)
        text += std::string{part.row->name} + ": " + real + ", by the text " + picture + "\n";
    for (const VariableRow& row : part.type->tables.variables) {
        const auto found = scope.values.find(std::string{row.name});
        const std::string by_text =
            std::string{row.name} + "=" +
            (found == scope.values.end() ? std::string{} : reference::print(found->second));
        const std::string real = bench_.value(part, row);
        if (real != by_text && found != scope.values.end()) text += real + ", by the text " + by_text + "\n";
    }
    return text;
}

std::string RandomDay::difference() const {
    std::string text;
    if (aid_.type != nullptr)
        text += compare(const_cast<UnitBench&>(bench_).parts().front(), aid_.status, aid_.scope);
    if (root_ == nullptr)
        text += compare(part(0), alone_.status, alone_.scope);
    else
        for (std::size_t i = 0; i <= root_->children().size(); ++i)
            text += compare(part(i), machine(i).picture(), machine(i).scope());
    const auto property = [&](const std::string& name, const auto& real, const auto& by_text) {
        const std::string one = reference::print(Value{real});
        const std::string other = reference::print(Value{by_text});
        if (one != other) text += name + "=" + one + ", by the text " + other + "\n";
    };
    for (const auto& [name, one, other] :
         {std::tuple{"own.", &bench_.own, &world_.own}, std::tuple{"mate.", &bench_.mate, &world_.mate}}) {
        property(name + std::string{"gain"}, std::int64_t{one->gain.get()}, std::int64_t{other->gain.get()});
        property(name + std::string{"level"}, one->level.get(), other->level.get());
        property(name + std::string{"open"}, one->open.get(), other->open.get());
    }
    property("setpoint", bench_.own.setpoint.last(), world_.setpoint);
    if (bench_.diary.lines == world_.diary.lines && text.empty()) return {};
    const std::size_t count = std::max(bench_.diary.lines.size(), world_.diary.lines.size());
    for (std::size_t i = 0; i < count; ++i) {
        const std::string one = i < bench_.diary.lines.size() ? bench_.diary.lines[i] : "";
        const std::string other = i < world_.diary.lines.size() ? world_.diary.lines[i] : "";
        text += "  " + one + (one == other ? "" : "   <-- by the text: " + other) + "\n";
    }
    return text;
}

} // namespace tappet
