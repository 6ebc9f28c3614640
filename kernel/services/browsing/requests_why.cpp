// Explains why a state machine is not in a state: the transitions that lead there are found here, and the
// engine that owns their guards evaluates them.
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/statechart/ways.hpp"

namespace tappet {

using browsing::WhyOrder;
using Look = StateMachineExecution::Look;

namespace {

constexpr std::size_t shown_characters = 64;

/// Runs in the engine of the behaviour.
void ask_guards(void* self, const std::byte*) noexcept TAPPET_REALTIME {
    auto& order = *static_cast<WhyOrder*>(self);
    if (!order.holds()) return;
    StateMachineExecution& machine = *order.unit->parts()[order.part].machine;
    for (std::size_t i = 0; i < order.transitions.size(); ++i)
        order.looks[i] = machine.look(order.transitions[i], order.engine->now());
    order.done = true;
}

std::string_view word_of(Look::Answer answer) {
    switch (answer) {
    case Look::Answer::open: return "open";
    case Look::Answer::too_early: return "too_early";
    case Look::Answer::guard: return "guard";
    case Look::Answer::precondition: return "precondition";
    case Look::Answer::arguments: return "arguments";
    case Look::Answer::failed: return "failed";
    case Look::Answer::elsewhere: return "elsewhere";
    }
    return "elsewhere";
}

StateIndex state_named(const ResolvedView& machine, std::string_view name, Nearest& nearest) {
    for (std::size_t s = 0; s < machine.table.states.size(); ++s) {
        if (machine.table.states[s].name == name) return static_cast<StateIndex>(s);
        nearest.consider(machine.table.states[s].name);
    }
    return no_state;
}

void put_path(JsonText& json, std::string_view key, const ResolvedView& machine, StateIndex state) {
    Sentence path;
    for (const std::string_view name : path_of(machine, state)) path.add(path.empty() ? "" : "/").add(name);
    json.field(key, path.view());
}

void put_way(JsonText& json, const ResolvedView& machine, TransitionIndex transition, const Look& look) {
    const TransitionRow& row = machine.table.transitions[transition];
    json.open('{').field("from", row.from).field("to", row.to);
    if (row.on_event) json.field("event", row.event);
    if (!row.because.empty()) json.field("reason", row.because);
    json.field("answer", word_of(look.answer));
    if (look.left > Duration{}) json.field("left_ns", look.left.count());
    const bool entered = look.answer == Look::Answer::precondition;
    if (entered) json.field("state", machine.table.states[look.state].name);
    const GuardReason& reason = entered ? machine.table.states[look.state].refusal : row.refusal;
    if (entered || look.answer == Look::Answer::guard) {
        if (!reason.text.empty()) json.field("because", reason.text);
        if (!look.detail.empty()) json.field("detail", look.detail);
    }
    json.close('}');
}

} // namespace

/// Finds "component.state", or "component.instance.state".
Sentence BrowserService::find_state(std::string_view name, WhyOrder& order) {
    const std::size_t dot = name.rfind('.');
    const std::string_view owner = name.substr(0, std::min(dot, name.size()));
    const std::string_view state = dot == std::string_view::npos ? "" : name.substr(dot + 1);
    const MachineView& table = machine_->machine().table;
    Nearest nearest_owner{owner}, nearest{state};
    bool known = false;
    for (std::size_t b = 0; b < table.behaviours.size(); ++b) {
        BehaviourUnit* unit = unit_of(b);
        for (std::size_t i = 0; unit != nullptr && i < unit->parts().size(); ++i) {
            const UnitPart& part = unit->parts()[i];
            const std::string_view component = table.behaviours[b].component;
            nearest_owner.consider(component);
            if (part.machine == nullptr ||
                (owner != component && !is_named(owner, component, part.row->name)))
                continue;
            known = true;
            order.wanted = state_named(part.binding.machine, state, nearest);
            if (order.wanted == no_state) continue;
            order.unit = unit;
            order.placed = unit->placed();
            order.slot = machine_->slot_of_row(b);
            order.row = b;
            order.part = i;
            return {};
        }
    }
    Sentence text =
        known ? Sentence{"no state machine of \"", owner.substr(0, shown_characters), "\" has a state \"",
                         state.substr(0, shown_characters), "\""}
              : Sentence{"there is no state machine of \"", owner.substr(0, shown_characters), "\""};
    const std::string_view best = (known ? nearest : nearest_owner).best();
    if (best.empty()) return text.add("; spell it COMPONENT.STATE, behaviours lists them");
    return text.add("; did you mean \"").add(best).add("\"?");
}

BrowserService::Verdict BrowserService::serve_why(Client& client, const Request& request) {
    WhyOrder order;
    if (const Sentence unknown = find_state(request.arguments[0], order); !unknown.empty())
        return {Refusal::unknown, unknown};
    const AcceptedMachine& machine = machine_->machine();
    const UnitPart& part = order.unit->parts()[order.part];
    const std::size_t c = find_component(machine.table, machine.table.behaviours[order.row].component);
    const Ways ways{part.binding.machine, order.wanted};
    const bool whole = read_between_steps(machine.index.activity[c], [&] {
        order.leaf = no_state;
        order.status = part.machine->machine_status();
        for (const ActiveState& each : part.machine->states())
            if (order.leaf == no_state || ways.away(each.state) < ways.away(order.leaf) ||
                part.binding.machine.plans[order.leaf].regions != 0)
                order.leaf = each.state;
    });
    if (!whole) return {Refusal::not_now, Sentence{"its activity is busy; ask again"}};
    for (std::size_t t = 0; order.leaf != no_state && t < part.binding.machine.table.transitions.size(); ++t)
        if (ways.leads_nearer(t, order.leaf))
            static_cast<void>(order.transitions.push(static_cast<TransitionIndex>(t)));
    Pending* place = free_place(client.rights.role);
    if (place == nullptr) return no_place();
    order.engine = &machine_->engines()[machine.index.activity[c]];
    Message call;
    call.run = &ask_guards;
    call.object = &place->work.emplace<WhyOrder>(order);
    return await_engine(*place, asker(client, request), c, call, &BrowserService::look_at_why);
}

bool BrowserService::look_at_why(Pending& place) {
    if (!place.call.is_over()) return false;
    const auto& order = std::get<WhyOrder>(place.work);
    if (!order.done || !order.holds())
        return answer_bad(place, Refusal::not_now, Sentence{"another script took over; ask again"});
    Client* client = who_waits(place);
    if (client == nullptr) return true;
    const UnitPart& part = order.unit->parts()[order.part];
    const ResolvedView& machine = part.binding.machine;
    const Ways ways{machine, order.wanted};
    Reply reply{place.asker.number, true};
    JsonText& json = reply.json();
    const Sentence name{machine_->machine().table.behaviours[order.row].component, ".", part.row->name};
    json.field("name", name.view()).field("status", to_text(order.status));
    put_path(json, "state", machine, order.leaf);
    put_path(json, "wanted", machine, order.wanted);
    json.field("is_final", machine.table.states[order.wanted].final);
    json.key("path").open('[');
    for (StateIndex leaf = order.leaf; leaf != no_state && ways.away(leaf) != Ways::none;
         leaf = ways.next(leaf))
        json.value(machine.table.states[leaf].name);
    json.close(']').key("ways").open('[');
    for (std::size_t i = 0; i < order.transitions.size(); ++i)
        put_way(json, machine, order.transitions[i], order.looks[i]);
    json.close(']');
    finish(*client, reply);
    return true;
}

} // namespace tappet
