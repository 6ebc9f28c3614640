// People of every role who may use everything that the machine offers: requests by names of its own table, a
// few in one cycle of its service. Their requests are no faults; the machine's reaction is judged.
#include "kernel/services/browsing/browser_service.hpp"
#include "toolchain/machine/swarm.hpp"

#include <algorithm>
#include <array>

namespace tappet {

namespace {

constexpr Duration longest_force = 12s;  // from its request to the effects of its release
constexpr Duration longest_line = 3s;    // from its request to its last statement, and to the wire
constexpr Duration told_late = 100ms;    // delay of an answer to its sender
constexpr std::size_t most_at_once = 24; // requests of somebody who floods the service
using Kinds = std::initializer_list<FacetKind>;

std::string in_quotes(std::string_view text) {
    std::string quoted;
    for (const char each : text) quoted += (each == '"' || each == '\\' ? "\\" : "") + std::string{each};
    return "\"" + quoted + "\"";
}

} // namespace

std::string SwarmRun::name_of(End end) const {
    const ComponentRow& row = of_.machine.table.components[end.component];
    return std::string{row.name} + "." + std::string{row.type->facets[end.facet].name};
}

/// Returns a facet of one of these kinds, preferably of the component; nowhere: the machine has none.
End SwarmRun::any_of(Kinds kinds, std::size_t component) {
    const auto rows = of_.machine.table.components;
    std::vector<End> own, all;
    for (std::size_t c = 0; c < rows.size(); ++c)
        for (std::size_t f = 0; f < rows[c].type->facets.size(); ++f)
            if (c != service_ && std::ranges::find(kinds, rows[c].type->facets[f].kind) != kinds.end()) {
                all.push_back({c, f});
                if (c == component) own.push_back({c, f});
            }
    const auto& some = own.empty() || random_.one_in(6) ? all : own;
    return some.empty() ? End{nowhere, nowhere} : some[random_.below(some.size())];
}

/// Returns the arguments of a call, separated by `between`; nothing when a type cannot be drawn.
std::optional<std::string> SwarmRun::any_arguments(const Facet& facet, std::string_view between) {
    std::string all;
    for (const TypeId each : (facet.command != nullptr ? *facet.command->arguments : *facet.type).elements) {
        const bool is_real = each->kind == ValueKind::real;
        const std::string value = is_real && between == " " && random_.one_in(12) ? "nan" : draw(*each, {});
        if (value.empty()) return {};
        all += (all.empty() ? "" : std::string{between}) + value;
    }
    return all;
}

/// Returns "component.name(arguments)", as in a statement.
std::string SwarmRun::any_call(End end) {
    const auto arguments =
        end.component == nowhere ? std::nullopt : any_arguments(facet_at(of_.machine.table, end), ", ");
    return arguments ? name_of(end) + "(" + *arguments + ")" : std::string{};
}

std::string SwarmRun::any_line(std::size_t component) {
    const auto call = [&] {
        return any_call(any_of({FacetKind::method, FacetKind::operation, FacetKind::command}, component));
    };
    const std::string first = call();
    if (first.empty()) return {};
    switch (random_.below(5)) {
    case 0: return name_of(any_of({FacetKind::output, FacetKind::property, FacetKind::input}, component));
    case 1: return "do " + first + ";";
    case 2: {
        const End end = any_of({FacetKind::property}, component);
        if (end.component == nowhere) return {};
        const std::string value =
            draw(*facet_at(of_.machine.table, end).type, facet_at(of_.machine.table, end).range);
        return value.empty() ? value : "wait(200 ms); set " + name_of(end) + " = " + value + ";";
    }
    case 3: return "wait(" + std::to_string(random_.below(1500)) + " ms); do " + first + ";";
    default: return "for (var int i = 0; i < 20; i = i + 1) { wait(50 ms); try do " + first + "; catch ; }";
    }
}

/// Returns a state machine that calls the slot's reachable operations one by one while it is loaded.
std::string SwarmRun::any_script(const BehaviourRow& row) {
    std::vector<std::string> calls;
    for (const std::string_view operation : row.slot.operations)
        for (const FacetKind kind : {FacetKind::method, FacetKind::operation, FacetKind::command}) {
            End end;
            if (!resolve(of_.machine.table, operation, kind, end).empty()) continue;
            if (std::string call = any_call(end); !call.empty()) calls.push_back(std::move(call));
            break;
        }
    if (calls.empty()) return {};
    std::string text = "StateMachine Anything { var int n = 0; ";
    // In any order, so that a state has another number in the next script.
    const bool is_other = random_.one_in(2);
    for (const std::string_view state : {is_other ? "Two" : "One", is_other ? "One" : "Two"})
        text += std::string{state == "One" ? "initial " : ""} + "state " + std::string{state} +
                " { run { var int i = 0; while i < " + std::to_string(1 + random_.below(100)) +
                " { yield; set i = i + 1; } try do " + calls[random_.below(calls.size())] +
                "; catch ; set n = n + 1; } transitions { if n > 1000 then select Last select " +
                (state == "One" ? "Two" : "One") + " } } ";
    return text + "final state Last { } }";
}

/// Returns a state of a loaded or an earlier state machine: "component.state".
std::string SwarmRun::any_state() {
    const auto rows = of_.machine.table.behaviours;
    if (rows.empty()) return {};
    const BehaviourRow& row = rows[random_.below(rows.size())];
    const std::string component = std::string{row.component} + ".";
    constexpr std::array<std::string_view, 3> loaded{"One", "Two", "Last"}; // of any_script()
    if (row.is_slot()) return component + std::string{loaded[random_.below(loaded.size())]};
    const ScriptUnit unit = row.unit();
    if (unit.types.empty() || unit.types.back().machine.states.empty()) return {};
    const auto states = unit.types.back().machine.states;
    return component + std::string{states[random_.below(states.size())].name};
}

void SwarmRun::anyone_asks(SwarmBrowser& by, std::string request, const SwarmBrowser::Then& then) {
    say(Sentence{&by == &browser_ ? "somebody asks: " : "a visitor asks: ", request}.view());
    // After a request to a driver itself, its wires may follow that request.
    for (const std::size_t c : drivers_)
        if (request.contains(std::string{of_.machine.table.components[c].name}))
            wires_.excuse(c, run_.now() + BrowserService::patience + longest_line);
    if (request.starts_with("force ")) wires_.excuse_axes(run_.now() + longest_force);
    const bool reads = request.starts_with("get ");
    const std::string name = reads ? request.substr(4) : std::string{};
    // No other engineer's request is pending.
    const bool is_alone = &by == &browser_ && by.waits_for() == 0 && run_.now() >= asked_by_others_until_;
    const std::string state = request.starts_with("why ") ? request.substr(request.rfind('.') + 1) : "";
    lines_.of_peers |= request.starts_with("send ") && request.contains(".execute ");
    by.ask(std::move(request), run_.now(), [this, name, state, is_alone, then](std::string_view answer) {
        if (then) then(answer);
        if (!state.empty() && is_good(answer) && !field_of(answer, "wanted").ends_with(state))
            deny(Sentence{"a question why \"", state, "\" is not reached was answered about \"",
                          field_of(answer, "wanted"), "\""});
        if (is_alone && field_of(answer, "error").starts_with("too many requests"))
            deny(Sentence{"an engineer's request is not served: lower roles occupy every place"});
        if (!name.empty() && is_good(answer)) judge_shown(name, answer);
    });
}

/// A value shown as good must have been written within the age that its row allows.
void SwarmRun::judge_shown(const std::string& name, std::string_view answer) {
    if (field_of(answer, "flow") != "fresh" || field_of(answer, "forced") == "true") return;
    const MachineView& table = of_.machine.table;
    Duration oldest{};
    for (std::size_t x = 0; x < table.connections.size(); ++x)
        if (name_of(of_.machine.index.connections[x].to) == name)
            oldest = std::max(oldest, table.connections[x].max_age);
    const Time stamp{Duration{std::strtoll(field_of(answer, "time_ns").c_str(), nullptr, 10)}};
    if (oldest > Duration{} && run_.now() - stamp > oldest + told_late)
        deny(Sentence{"input \"", name, "\" is shown as fresh, but was written ", (run_.now() - stamp) / 1ms,
                      " ms ago"});
}

bool SwarmRun::sends_command(std::string_view line) const {
    const auto rows = of_.machine.table.components;
    for (std::size_t c = 0; c < rows.size(); ++c)
        for (std::size_t f = 0; f < rows[c].type->facets.size(); ++f)
            if (rows[c].type->facets[f].kind == FacetKind::command && line.contains(name_of({c, f}) + "("))
                return true;
    return false;
}

/// Nobody of a lower role may delay an engineer's line for long.
void SwarmRun::execute(const std::string& line, std::optional<unsigned> begun_before) {
    anyone_asks(browser_, "execute " + in_quotes(line), [this, line, begun_before](std::string_view answer) {
        const std::string why = field_of(answer, "error");
        if (is_good(answer)) {
            ++lines_.at_work;
            ++lines_.begun;
            lines_.left_commands |= sends_command(line);
        }
        if (why.starts_with("commands of earlier lines") && !lines_.left_commands && !lines_.of_peers)
            deny(Sentence{"an engineer's line is refused: commands of operators' lines occupy every place"});
        if (!why.starts_with("another line is at work") || lines_.at_work > 0 || lines_.of_peers) return;
        if (begun_before && *begun_before == lines_.begun) // else the engineers broke off their own line
            return deny(Sentence{"an engineer stopped a line, but the next line of a lower role runs instead "
                                 "of the engineer's"});
        if (begun_before) return;
        // Not immediately: somebody else may be faster.
        anyone_asks(browser_, "break_off", [this, line, begun = lines_.begun](std::string_view broken_off) {
            if (!is_good(broken_off)) return;
            anyone_asks(browser_, "hello", [this, line, begun](std::string_view) { execute(line, begun); });
        });
    });
}

/// Sometimes repeats the last call: many faults appear only the second time.
void SwarmRun::call_anything(std::size_t component) {
    // Does not repeat commands: each of them holds a place until it ends.
    if (last_call_.empty() || last_call_.starts_with("send ") || !random_.one_in(4)) {
        const End end = any_of({FacetKind::method, FacetKind::operation, FacetKind::command}, component);
        if (end.component == nowhere) return;
        const Facet& facet = facet_at(of_.machine.table, end);
        const auto arguments = any_arguments(facet, " ");
        if (!arguments) return;
        last_call_ = (facet.command != nullptr ? "send " : "call ") + name_of(end) +
                     (arguments->empty() ? "" : " ") + *arguments;
    }
    ++verdict_.faults["called"];
    anyone_asks(browser_, last_call_);
}

/// Loads a script into a slot, or removes it.
void SwarmRun::load_anything() {
    std::vector<const BehaviourRow*> slots;
    for (const BehaviourRow& row : of_.machine.table.behaviours)
        if (row.is_slot()) slots.push_back(&row);
    if (slots.empty()) return;
    const BehaviourRow& row = *slots[random_.below(slots.size())];
    const std::string slot{row.component};
    const std::uint64_t how = random_.below(8);
    ++verdict_.faults["script"];
    if (how < 2) return anyone_asks(browser_, (how == 0 ? "unload " : "roll_back ") + slot);
    // One script leaves, and the next but one reuses its memory.
    const bool twice = random_.one_in(3);
    if (twice) anyone_asks(browser_, "unload " + slot);
    for (int n = 0; n < (twice ? 2 : 1); ++n) {
        const std::string script = any_script(row);
        if (script.empty()) return;
        anyone_asks(browser_, "script " + slot + " 0 " + in_quotes(script));
        anyone_asks(browser_, "load " + slot + " anything.osd");
    }
}

/// Sends one request about a component, or about another one.
void SwarmRun::ask_anything(std::size_t component, Duration lasts) {
    const MachineView& table = of_.machine.table;
    const std::string name{table.components[component].name};
    const std::uint64_t what = random_.below(100);
    if (what < 22) return call_anything(component);
    if (what < 34) {
        const End end = any_of({FacetKind::property}, component);
        if (end.component == nowhere) return;
        const Facet& facet = facet_at(table, end);
        const std::string value = random_.one_in(8) ? "nan" : draw(*facet.type, facet.range);
        if (value.empty()) return;
        ++verdict_.faults["set"];
        return anyone_asks(browser_, "set " + name_of(end) + " " + value);
    }
    if (what < 44) {
        const End end = any_of({FacetKind::input, FacetKind::output}, component);
        if (end.component == nowhere) return;
        const std::string value = random_.one_in(8) ? "nan" : draw(*facet_at(table, end).type, {});
        if (value.empty()) return;
        anyone_asks(browser_, "force " + name_of(end) + " " + value);
        return begin("forced", Sentence{"port \"", name_of(end), "\" is forced"}, lasts, {}, [this, end] {
            anyone_asks(browser_, "release " + name_of(end));
            return true;
        });
    }
    if (what < 66) return stop_a_part(component, lasts);
    if (what < 80) {
        const std::string line = random_.one_in(10) ? "" : any_line(component);
        ++verdict_.faults["line"];
        return line.empty() ? anyone_asks(browser_, "break_off") : execute(line);
    }
    if (what < 88) return load_anything();
    if (what < 94) {
        if (table.behaviours.empty()) return;
        const BehaviourRow& row = table.behaviours[random_.below(table.behaviours.size())];
        const ScriptUnit unit = row.unit();
        if (unit.instances.empty() || unit.types.empty()) return;
        const auto& instance = unit.instances[random_.below(unit.instances.size())];
        const auto states = unit.types.back().machine.states;
        const std::string behaviour = std::string{row.component} + "." + std::string{instance.name};
        ++verdict_.faults["behaviour"];
        if (!states.empty() && random_.one_in(2)) {
            const std::string state{states[random_.below(states.size())].name};
            return anyone_asks(browser_, random_.one_in(2) ? "why " + std::string{row.component} + "." + state
                                                           : "behave request " + behaviour + " " + state);
        }
        constexpr std::array<std::string_view, 6> actions{"start", "stop",  "pause",
                                                          "step",  "reset", "reactive"};
        return anyone_asks(browser_,
                           "behave " + std::string{actions[random_.below(actions.size())]} + " " + behaviour);
    }
    constexpr std::array<std::string_view, 5> all{"hello", "forced", "counters", "behaviours", "save"};
    ++verdict_.faults["read"];
    if (random_.one_in(2)) return anyone_asks(browser_, std::string{all[random_.below(all.size())]});
    const End end = readable_[random_.below(readable_.size())];
    anyone_asks(browser_, "get " + name_of(end));
}

/// Stops or restarts a component, or its whole activity; after a while somebody starts it again.
void SwarmRun::stop_a_part(std::size_t c, Duration lasts) {
    const std::size_t a = of_.machine.index.activity[c];
    if (service_ != nowhere && a == of_.machine.index.activity[service_]) return;
    const bool whole = random_.one_in(4), restarts = random_.one_in(4);
    const std::string part = whole ? "activity:" + std::string{of_.machine.table.activities[a].name}
                                   : std::string{of_.machine.table.components[c].name};
    anyone_asks(browser_, (restarts ? "restart " : "stop ") + part);
    const std::string kind =
        std::string{whole ? "activity " : "component "} + (restarts ? "restarted" : "stopped");
    begin(kind, Sentence{part, restarts ? " restarts" : " stops"}, std::max(lasts, Duration{300ms}),
          whole ? components_of(a) : std::vector{c}, [this, c, a, whole] {
              const bool runs = whole ? run_.instance().engines()[a].is_active()
                                      : run_.instance().life().state_of(c) == ComponentState::running;
              if (runs) return true;
              if (whole)
                  refusal_ = run_.world().change_activity(a, LifeChange::start);
              else
                  static_cast<void>(run_.instance().life().ask_component(c, LifeChange::start));
              return false;
          });
    faults_.back().of_activity = true; // a stopped part loses what it is sent
}

/// Sends a few requests, which the service finds in one cycle, most of them about one component.
void SwarmRun::strike_as_anyone(Duration lasts) {
    const std::size_t components = of_.machine.table.components.size();
    std::size_t focus = random_.below(components);
    if (run_.now() < busy_until_) return call_anything(busy_with_);
    if (random_.one_in(8)) return flood();
    if (random_.one_in(6)) { // somebody uses the component for a while, and stops nothing
        busy_with_ = focus;
        busy_until_ = run_.now() + Duration{random_.between(1'000'000'000, 10'000'000'000)};
    }
    for (std::int64_t n = random_.between(1, 4); n > 0; --n) {
        ask_anything(focus, lasts);
        if (random_.one_in(6)) focus = random_.below(components);
    }
}

/// Sends a request that anybody may send, or one that the sender may not.
void SwarmRun::ask_of_lower_role(SwarmBrowser& by) {
    const std::string port = name_of(readable_[random_.below(readable_.size())]);
    const std::string state = any_state();
    switch (random_.below(5)) {
    case 0: return anyone_asks(by, "set " + port + " 1");
    case 1: return anyone_asks(by, "execute \"" + port + "\"");
    case 2: return anyone_asks(by, state.empty() ? "behaviours" : "why " + state);
    default: anyone_asks(by, "get " + port);
    }
}

/// Sends the operator's line repeatedly until it is at work; then possibly breaks it off and starts the next
/// one.
void SwarmRun::insist(const std::string& line, unsigned times) {
    if (times == 0) return;
    anyone_asks(visitors_[0], "execute \"" + line + "\"", [this, line, times](std::string_view answer) {
        if (is_good(answer) && !random_.one_in(4))
            return anyone_asks(visitors_[0], "break_off",
                               [this, line, times](std::string_view) { insist(line, times - 1); });
        if (is_good(answer) || field_of(answer, "code") == "not_now") insist(line, times - 1);
    });
}

/// Asks a hung component, which does not answer before all senders have given up. No commands: each may hold
/// its place until it ends.
void SwarmRun::ask_who_hangs(std::size_t c) {
    const std::size_t a = of_.machine.index.activity[c];
    if (service_ == nowhere || a == of_.machine.index.activity[service_]) return;
    hang(a, BrowserService::patience + Duration{random_.between(500'000'000, 2'000'000'000)});
    for (std::size_t n = 0; n < most_at_once; ++n) {
        const End end = any_of({FacetKind::operation, FacetKind::property}, c);
        if (end.component == nowhere) return;
        const Facet& facet = facet_at(of_.machine.table, end);
        const bool calls = facet.kind == FacetKind::operation;
        const auto value = calls ? any_arguments(facet, " ") : draw(*facet.type, facet.range);
        if (!value || (!calls && value->empty())) continue;
        anyone_asks(browser_,
                    (calls ? "call " : "set ") + name_of(end) + (value->empty() ? "" : " ") + *value);
    }
}

/// People of lower roles, one or all at once, fill the service with requests, and an engineer sends one.
void SwarmRun::flood() {
    ++verdict_.faults["flood"];
    const std::size_t component = random_.below(of_.machine.table.components.size());
    const std::uint64_t how = random_.below(6);
    if (how == 2) return ask_who_hangs(component);
    if (how == 3 && !events_.empty()) {
        SwarmBrowser& by = visitors_[1 + random_.below(visitors_.size() - 1)];
        const std::size_t first = random_.below(events_.size()); // there may not be room for all
        for (std::size_t n = 0; n < events_.size(); ++n) {
            const std::size_t index = events_[(first + n) % events_.size()];
            anyone_asks(by, "subscribe " + name_of(of_.machine.plan.subscriptions[index].event));
        }
    } else if (const std::string state = any_state(); how == 0 && !state.empty()) {
        for (SwarmBrowser& each : visitors_)
            for (std::int64_t n = random_.between(1, 4); n > 0; --n) anyone_asks(each, "why " + state);
        if (random_.one_in(2)) return load_anything();
    } else if (how == 1 && !commands_.empty()) {
        End end = commands_[random_.below(commands_.size())];
        for (int n = 0; n < 4 && facet_at(of_.machine.table, end).kind != FacetKind::command; ++n)
            end = commands_[random_.below(commands_.size())];
        const std::string call = any_call(end);
        if (call.empty() || call.contains('"')) return;
        const bool waits = random_.one_in(2);
        insist((waits ? "wait(" + std::to_string(random_.below(1500)) + " ms); do " : "do ") + call + ";",
               static_cast<unsigned>(random_.between(3, 30)));
        if (std::string line = any_line(component); !line.empty()) execute(line);
        return;
    } else {
        SwarmBrowser& by = visitors_[random_.below(visitors_.size())];
        for (std::int64_t n = random_.between(1, most_at_once); n > 0; --n) ask_of_lower_role(by);
    }
    if (random_.one_in(2)) ask_anything(component, {});
}

} // namespace tappet
