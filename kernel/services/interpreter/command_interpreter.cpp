// Executes a line: compiles it for the names in it, and posts it repeatedly to the engine that runs it.
#include "kernel/services/interpreter/command_interpreter.hpp"

#include "kernel/base/value_text.hpp"
#include "kernel/machine/plan/operations.hpp"
#include "kernel/script/load.hpp"
#include "kernel/script/token.hpp"

#include <algorithm>

namespace tappet {

using interpreter::Bank;

namespace {

constexpr ComponentType nobody{};
constexpr std::string_view line_name = "line";
constexpr std::size_t most_homes = 8;

/// Returns one component of each activity that the words of a line name, in their order.
Bounded<std::size_t, most_homes> homes_of(std::string_view text, const AcceptedMachine& machine) {
    Bounded<std::size_t, most_homes> homes;
    script_detail::Lexer lexer{text};
    script_detail::Token token;
    do {
        lexer.next(token);
        const std::size_t named = token.is_word() ? find_component(machine.table, token.text) : nowhere;
        bool is_new = named != nowhere;
        for (const std::size_t home : homes)
            is_new = is_new && machine.index.activity[home] != machine.index.activity[named];
        if (is_new && !homes.push(named)) break;
    } while (token.sign != script_detail::Sign::end && token.sign != script_detail::Sign::broken);
    return homes;
}

bool is_expression(const ProgramTables& line) noexcept {
    return !line.variables.empty() && line.variables[0].kind == VariableKind::result;
}

} // namespace

constexpr LineFunctions CommandInterpreter::line_functions{
    .begin =
        [](void* self, std::string_view line, Rights rights, LineRefusal& refusal) {
            return static_cast<CommandInterpreter*>(self)->begin(line, rights, Asker::browser, refusal);
        },
    .end = [](void* self) -> const LineEnd* {
        auto& own = *static_cast<CommandInterpreter*>(self);
        return own.is_at_work() ? nullptr : &own.end_;
    },
    .let_go =
        [](void* self) {
            auto& own = *static_cast<CommandInterpreter*>(self);
            if (own.is_at_work()) own.finish(CommandState::failed, Sentence{"its sender has disconnected"});
            own.asker_ = Asker::none;
        },
    .break_off =
        [](void* self, Role role) {
            auto& own = *static_cast<CommandInterpreter*>(self);
            const bool ends_waiting = own.waits_ && role == Role::engineer; // a peer has this role
            if (!own.is_at_work() && !ends_waiting) return LineRefusal::not_now;
            if (own.is_at_work() && role < own.bank_->role) return LineRefusal::denied;
            if (own.is_at_work() && role > own.bank_->role) own.keep_for(role, own.machine_->clock().now());
            if (ends_waiting) own.waits_ = false;
            own.is_broken_off_ = own.is_at_work();
            return LineRefusal::none;
        }};

static_assert(std::size_t{interpreter::line_sizes.command_slots} * CommandInterpreter::lines_at_most ==
              line_commands);

Sentence CommandInterpreter::configure(Setup& setup) {
    machine_ = setup.machine;
    const MachineView& table = machine_->machine().table;
    own_ = find_component(table, setup.component);
    reach_[0] = {"this", &nobody, true};
    for (std::size_t c = 0; c < table.components.size(); ++c)
        reach_[c + 1] = {table.components[c].name, table.components[c].type, false};
    return {};
}

void CommandInterpreter::reach_from(std::size_t home) noexcept {
    const auto activity = machine_->machine().index.activity;
    for (std::size_t c = 0; c < machine_->machine().table.components.size(); ++c)
        reach_[c + 1].same_activity = activity[c] == activity[home];
}

Sentence CommandInterpreter::begin(std::string_view text, Rights rights, Asker asker, LineRefusal& refusal) {
    const Role role = rights.role;
    const auto refuse = [this](const Sentence& fault) {
        refused.write(refused.last() + 1);
        return fault;
    };
    refusal = LineRefusal::not_now;
    if (machine_->life().state_of(own_) != ComponentState::running)
        return refuse(Sentence{"the component that executes lines does not run; start it first"});
    const Time now = machine_->clock().now();
    if (asker_ != Asker::none) {
        const bool is_higher = role > bank_->role;
        const bool gives_way = is_higher && is_expression(bank_->unit.parts()[0].type->tables);
        if (is_higher) keep_for(role, now);
        if (!gives_way) return refuse(Sentence{"another line is at work; wait for its end, or break it off"});
        is_broken_off_ = is_at_work();
        if (asker == Asker::peer) { // a peer does not ask again
            waits_ = true;
            since_waiting_ = now;
            return {};
        }
        return refuse(Sentence{"an ", to_text(bank_->role), "'s line gives way to yours; ask again"});
    }
    if (role < kept_for_ && now < kept_until_)
        return refuse(Sentence{"an ", to_text(kept_for_), " is served first; ask again"});
    Bank* const free = std::ranges::find_if(banks_, &Bank::is_free);
    if (std::ranges::count_if(banks_, &Bank::is_free) <= (role < Role::engineer ? banks_of_engineers : 0))
        return refuse(
            Sentence{"commands of earlier lines are still on their way; wait until they have ended, "
                     "or stop their components"});
    if (const Sentence fault = prepare(text, rights, *free, refusal); !fault.empty()) return refuse(fault);
    refusal = LineRefusal::none;
    kept_for_ = Role::observer;
    bank_ = free;
    bank_->role = role;
    asker_ = asker;
    is_broken_off_ = false;
    since_ = now;
    end_ = {.state = CommandState::executing};
    executed.write(executed.last() + 1);
    post(*free);
    return {};
}

Sentence CommandInterpreter::prepare(std::string_view text, Rights rights, Bank& bank, LineRefusal& refusal) {
    const AcceptedMachine& machine = machine_->machine();
    refusal = LineRefusal::wrong;
    if (text.size() > max_characters)
        return Sentence{"a line has at most ", max_characters,
                        " characters; write a shorter one, or load a script into a slot"};
    auto homes = homes_of(text, machine);
    if (homes.empty()) static_cast<void>(homes.push(own_));
    Reach reach;
    reach.components = {reach_.data(), machine.table.components.size() + 1};
    reach.command_slots = interpreter::line_sizes.command_slots;
    ScriptRoom room = bank.rows.room();
    room.reach = {reach_.data(), reach.components.size()};
    // A line reads from one activity only; compiling shows which one of those that it names.
    ScriptOutcome outcome;
    Sentence first_fault;
    for (const std::size_t home : homes) {
        reach_from(home);
        outcome = compile_line(text, line_name, reach, room);
        bank.home = home;
        if (outcome.good()) break;
        if (first_fault.empty()) first_fault = outcome.fault;
    }
    if (!outcome.good()) return first_fault;
    refusal = LineRefusal::denied;
    if (Sentence fault = check_rights(outcome.unit, rights); !fault.empty()) return fault;
    refusal = LineRefusal::not_now;
    const std::size_t activity = machine.index.activity[bank.home];
    if (!is_alive(*machine_, activity))
        return Sentence{"activity \"", machine.table.activities[activity].name,
                        "\" is stopped, and nothing of it can be asked; start it first"};
    if (Sentence fault = check_running(outcome.unit); !fault.empty()) return fault;
    refusal = LineRefusal::wrong;
    if (Sentence fault = bank.unit.place(outcome.unit, {}, {.statements = statements_between_steps},
                                         bank.memory, {}, *machine_, bank.home);
        !fault.empty())
        return Sentence{line_name, ":1:1: it takes more values than a line has room for; write a shorter "
                                   "one, or load a script into a slot"};
    UnitPart& part = bank.unit.parts()[0];
    tappet::detail::for_each_slot_link(outcome.unit, *part.type, [&](std::size_t i, const Facet&) {
        const LinkRow& row = part.type->tables.links[i];
        CommandSlot& slot = *part.links[i].slot;
        const std::size_t receiver = std::size_t{row.peer} - 1;
        slot.place(machine_->requests().line_route({receiver, row.facet}), slot.values());
    });
    bank.unit.connect_links();
    bank.engine = &machine_->engines()[activity];
    bank.has_begun = false;
    return {};
}

Sentence CommandInterpreter::check_rights(const ScriptUnit& unit, Rights rights) const {
    const Role role = rights.role;
    const ProgramTables& tables = unit.types[0].tables;
    for (const Instruction& each : tables.instructions) {
        if (each.facet == nullptr) continue;
        const Role least = interpreter::role_of(each);
        const Sentence name{reach_[tables.links[each.link].peer].name, ".", each.facet->name};
        if (role < least)
            return Sentence{"\"",
                            name,
                            "\" needs the role of an ",
                            to_text(least),
                            " here, you are an ",
                            to_text(role),
                            "; ask for it in the board's list of roles"};
        if (Sentence fault = interpreter::check_origin(each, name.view(), rights.origin); !fault.empty())
            return fault;
    }
    if (role >= Role::machine_operator || is_expression(tables)) return {};
    return Sentence{"statements need the role of an ", to_text(Role::machine_operator), ", you are an ",
                    to_text(role), "; write an expression, or ask for it in the board's list of roles"};
}

Sentence CommandInterpreter::check_running(const ScriptUnit& unit) const {
    for (const LinkRow& link : unit.types[0].tables.links) {
        const std::size_t component = std::size_t{link.peer} - 1;
        const FacetKind kind = reach_[link.peer].type->facets[link.facet].kind;
        if ((kind == FacetKind::method || kind == FacetKind::operation) &&
            machine_->life().state_of(component) != ComponentState::running)
            return Sentence{"component \"", reach_[link.peer].name, "\" does not run; start it first"};
    }
    return {};
}

void CommandInterpreter::run(void* self, const std::byte*) noexcept TAPPET_REALTIME {
    auto& bank = *static_cast<Bank*>(self);
    const Time now = bank.engine->now();
    if (!bank.has_begun) bank.unit.start(now);
    bank.has_begun = true;
    bank.unit.step_programs(now);
}

// A call that finds no room is posted in the next cycle.
void CommandInterpreter::post(Bank& bank) noexcept {
    const AcceptedMachine& machine = machine_->machine();
    Message message;
    message.run = &run;
    message.object = &bank;
    message.id = machine.plan.part_of[bank.home];
    posted_ = machine_->clock().now();
    static_cast<void>(bank.call.post(*machine_, machine.index.activity[bank.home], message, bank.role));
}

void CommandInterpreter::work(const Cycle& cycle) {
    if (waits_ && asker_ == Asker::none) {
        waits_ = false;
        LineRefusal refusal{};
        tell(begin(of_peer_.view(), Rights{}, Asker::peer, refusal));
    } else if (waits_ && cycle.now - since_waiting_ > patience) {
        waits_ = false;
        tell(Sentence{"the line that is at work does not end; look at its components"});
    }
    if (!is_at_work()) return;
    if (is_broken_off_) return finish(CommandState::failed, Sentence{"it was broken off"});
    if (cycle.now - since_ > longest.get())
        return finish(CommandState::failed,
                      Sentence{"it took longer than a line may; write less in one, or raise \"longest\""});
    if (!bank_->call.is_over()) {
        if (cycle.now - posted_ > patience)
            finish(CommandState::failed,
                   Sentence{"its engine did not execute it in time: look at activity \"",
                            machine_->machine()
                                .table.activities[machine_->machine().index.activity[bank_->home]]
                                .name,
                            "\""});
        return;
    }
    if (bank_->program().has_ended()) return finish_good();
    if (bank_->program().status() == ProgramStatus::error)
        return finish(CommandState::failed, interpreter::describe_fault(*bank_, reach_));
    post(*bank_);
}

void CommandInterpreter::finish_good() {
    const UnitPart& part = bank_->unit.parts()[0];
    end_.values = part.type->tables.variables;
    end_.data = part.data;
    value_ = {};
    if (is_expression(part.type->tables)) {
        const VariableRow& row = end_.values[0];
        alignas(data_alignment) std::array<std::byte, interpreter::line_sizes.data> value{};
        std::copy_n(end_.data + row.at, std::min(row.type->size, value.size()), value.data());
        std::array<char, 2048> text;
        value_.append({text.data(), format_value(*row.type, value.data(), text)});
    }
    finish(CommandState::done, Sentence{value_.length == 0 ? std::string_view{"done"} : value_.view()});
}

// Nobody steps a line that is broken off: it stays as it is, and its memory is reused when no engine refers
// to it any more.
void CommandInterpreter::finish(CommandState state, const Sentence& why) noexcept TAPPET_REALTIME {
    end_.state = state;
    Text<240> text;
    text.append(why.view());
    said.write(text);
    if (state == CommandState::done) return;
    end_.why = why;
    static_cast<void>(bank_->call.withdraw());
}

void CommandInterpreter::stop(const Cycle&) noexcept TAPPET_REALTIME {
    if (is_at_work()) finish(CommandState::failed, Sentence{"the component that executes lines was stopped"});
    if (asker_ == Asker::peer) asker_ = Asker::none;
    waits_ = false;
}

// ---- for peers

// A peer's line that waits, or whose answer was not taken yet, keeps the place of peers.
bool CommandInterpreter::execute(const Line& line, Line& value) noexcept {
    LineRefusal refusal{};
    const bool is_taken = waits_ || asker_ == Asker::peer;
    const Sentence fault = is_taken ? Sentence{"another component's line is at work; send yours after it"}
                                    : begin(line.view(), Rights{}, Asker::peer, refusal);
    if (is_taken) refused.write(refused.last() + 1);
    tell(fault);
    if (!fault.empty()) return false;
    of_peer_ = line;
    static_cast<void>(number_of_peer_.assign(Sentence{"line ", ++lines_of_peers_}.view()));
    value = number_of_peer_; // while it runs
    return true;
}

void CommandInterpreter::tell(const Sentence& fault) noexcept {
    if (fault.empty()) return;
    Text<240> text;
    text.append(fault.view());
    said.write(text);
}

CommandProgress CommandInterpreter::follow(const Line&, Line& value) noexcept TAPPET_REALTIME {
    // Not by its text: another peer may send the same.
    const bool is_its_own = value.view() == number_of_peer_.view();
    if (is_its_own && waits_) return CommandProgress::executing;
    if (!is_its_own || asker_ != Asker::peer) {
        value = {};
        return CommandProgress::failed; // it ended before another peer's line began, or was broken off
    }
    if (is_at_work()) return CommandProgress::executing;
    asker_ = Asker::none;
    const bool is_done = end_.state == CommandState::done;
    value = is_done ? value_ : Line{};
    return is_done ? CommandProgress::done : CommandProgress::failed;
}

} // namespace tappet
