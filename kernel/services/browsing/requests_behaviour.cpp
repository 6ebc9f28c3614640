// Requests about behaviours (thesis 5.1.2, 5.2.5): shows them, commands them and loads them into slots.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"

#include <charconv>
#include <cstring>

namespace tappet {

using browsing::BehaviourOrder;

namespace {

constexpr std::size_t shown_characters = 64;

/// Runs in the engine of the behaviour. Another behaviour may have taken over since the request.
void command_behaviour(void* self, const std::byte*) noexcept TAPPET_REALTIME {
    auto& order = *static_cast<BehaviourOrder*>(self);
    if (order.slot != nullptr && order.slot->active() != order.unit) return;
    order.done =
        act(*order.unit, order.unit->parts()[order.part], order.action, order.state, order.engine->now());
}

/// Whether a name is that of an instance: "component.instance".
bool is_of(std::string_view name, std::string_view component, const UnitPart& part) noexcept {
    return is_named(name, component, part.row->name);
}

} // namespace

BehaviourUnit* BrowserService::unit_of(std::size_t row) noexcept {
    BehaviourSlot* slot = machine_->slot_of_row(row);
    return slot != nullptr ? slot->active() : machine_->unit_of_row(row);
}

Sentence BrowserService::find_behaviour(std::string_view name, FoundBehaviour& found) noexcept {
    const MachineView& table = machine_->machine().table;
    Nearest nearest{name};
    std::array<Sentence, 8> names; // Nearest keeps views of the names it considered
    std::size_t kept = 0;
    for (std::size_t b = 0; b < table.behaviours.size(); ++b) {
        BehaviourUnit* unit = unit_of(b);
        if (unit == nullptr) continue;
        for (std::size_t i = 0; i < unit->parts().size(); ++i) {
            const UnitPart& part = unit->parts()[i];
            if (is_of(name, table.behaviours[b].component, part)) {
                found = {b, unit, i};
                return {};
            }
            if (kept == names.size()) continue;
            names[kept] = Sentence{table.behaviours[b].component, ".", part.row->name};
            nearest.consider(names[kept++].view());
        }
    }
    Sentence text{"there is no behaviour \"", name.substr(0, nearest_max_length), "\""};
    if (nearest.best().empty()) return text.add("; list them with behaviours");
    return text.add("; did you mean \"").add(nearest.best()).add("\"?");
}

Sentence BrowserService::find_slot(std::string_view name, BehaviourSlot*& slot) noexcept {
    slot = machine_->slot_of(name);
    if (slot != nullptr) return {};
    Nearest nearest{name};
    for (const BehaviourRow& row : machine_->machine().table.behaviours)
        if (row.is_slot()) nearest.consider(row.component);
    Sentence text{"no slot is reserved for \"", name.substr(0, nearest_max_length), "\""};
    if (nearest.best().empty()) return text.add("; add behaviour(\"...\", slot(...)) to the machine's table");
    return text.add("; did you mean \"").add(nearest.best()).add("\"?");
}

void BrowserService::put_behaviour(Reply& reply, std::size_t row, const BehaviourUnit& unit,
                                   const UnitPart& part, bool all) {
    const AcceptedMachine& machine = machine_->machine();
    const BehaviourRow& behaviour = machine.table.behaviours[row];
    const std::size_t activity = machine.index.activity[find_component(machine.table, behaviour.component)];
    struct {
        std::string_view status{};
        StateIndex state = no_state;
        std::string_view reason{};
        NodeIndex node = no_node;
        std::uint64_t transitions = 0;
    } seen;
    const bool whole = read_between_steps(activity, [&] {
        if (part.machine != nullptr) {
            seen.status = to_text(part.machine->machine_status());
            seen.state = part.machine->status().active;
            seen.reason = part.machine->reason();
            seen.transitions = part.machine->status().transitions;
            seen.node = part.machine->in_error() ? part.machine->fault().node : part.machine->node_in_hand();
            for (const ActiveState& each : part.machine->states())
                if (seen.node == no_node && each.run == RunPhase::waits) seen.node = each.position.node;
        } else {
            seen.status = to_text(part.program->status());
            seen.node = part.program->position().node;
        }
    });
    JsonText& json = reply.json();
    const Sentence name{behaviour.component, ".", part.row->name};
    json.open('{').field("name", name.view()).field("kind", part.machine != nullptr ? "machine" : "program");
    if (!whole) {
        json.field("error", "its activity is busy; ask again").close('}');
        return;
    }
    json.field("status", seen.status);
    if (part.machine != nullptr) {
        Sentence path;
        // By the binding of the unit, which stays: the machine itself may be dropped and bound again
        // meanwhile.
        for (const std::string_view state : path_of(part.binding.machine, seen.state))
            path.add(path.empty() ? "" : "/").add(state);
        json.field("state", path.view());
    }
    const auto nodes = part.type->tables.nodes;
    if (seen.node < nodes.size() && nodes[seen.node].line != 0)
        json.field("line", unsigned{nodes[seen.node].line});
    if (const Sentence fault = seen.status == "error" ? unit.describe_fault() : Sentence{}; !fault.empty())
        json.field("fault", fault.view());
    if (all) {
        if (!seen.reason.empty()) json.field("reason", seen.reason);
        json.field("transitions", seen.transitions).field("left_over", unit.steps_left_over());
        json.key("variables").open('{');
        for (const VariableRow& each : part.type->tables.variables) {
            if (each.kind == VariableKind::argument || each.name.empty() || each.at == no_data) continue;
            alignas(16) std::array<std::byte, 1024> value;
            if (each.type->size > value.size()) continue;
            if (!read_between_steps(activity,
                                    [&] { std::memcpy(value.data(), part.data + each.at, each.type->size); }))
                continue;
            json.key(each.name);
            reply.value(*each.type, value.data());
        }
        json.close('}');
    }
    json.close('}');
}

void BrowserService::put_slot(Reply& reply, const BehaviourSlot& slot) {
    JsonText& json = reply.json();
    json.open('{').field("slot", slot.row().component).field("phase", to_text(slot.phase()));
    json.field("script", slot.script()).field("loads", slot.loads()).field("roll_backs", slot.roll_backs());
    if (const Sentence why = slot.describe_roll_back(); !why.empty()) json.field("news", why.view());
    json.close('}');
}

BrowserService::Verdict BrowserService::serve_behaviours(Client& client, const Request& request) {
    Reply reply{request.number, true};
    const bool one = !request.arguments.empty();
    FoundBehaviour wanted;
    BehaviourSlot* only = one ? machine_->slot_of(request.arguments[0]) : nullptr;
    if (one && only == nullptr)
        if (const Sentence unknown = find_behaviour(request.arguments[0], wanted); !unknown.empty())
            return {Refusal::unknown, unknown};
    reply.json().key("behaviours").open('[');
    const std::size_t rows = machine_->machine().table.behaviours.size();
    for (std::size_t b = 0; b < rows; ++b) {
        const BehaviourUnit* unit = unit_of(b);
        if (unit == nullptr) continue;
        for (std::size_t i = 0; i < unit->parts().size(); ++i)
            if (!one || (wanted.unit == unit && wanted.part == i) ||
                (only != nullptr && only == machine_->slot_of_row(b)))
                put_behaviour(reply, b, *unit, unit->parts()[i], one);
    }
    reply.json().close(']').key("slots").open('[');
    for (std::size_t b = 0; b < rows; ++b)
        if (const BehaviourSlot* slot = machine_->slot_of_row(b);
            slot != nullptr && (!one || slot == only || slot == machine_->slot_of_row(wanted.row)))
            put_slot(reply, *slot);
    reply.json().close(']');
    return finish(client, reply);
}

BrowserService::Verdict BrowserService::serve_behave(Client& client, const Request& request) {
    BehaviourOrder order;
    if (!browsing::parse(request.arguments[0], order.action))
        return {Refusal::bad_request,
                Sentence{"a behaviour does not \"", request.arguments[0].substr(0, shown_characters),
                         "\"; it is spelled: ", request.verb->usage}};
    FoundBehaviour found;
    if (const Sentence unknown = find_behaviour(request.arguments[1], found); !unknown.empty())
        return {Refusal::unknown, unknown};
    const AcceptedMachine& machine = machine_->machine();
    const UnitPart& part = found.unit->parts()[found.part];
    if ((order.action == BehaviourAction::request) != (request.arguments.size() == 3))
        return {Refusal::bad_request,
                Sentence{"only request names a state; it is spelled: ", request.verb->usage}};
    if (order.action == BehaviourAction::request) {
        const auto states = part.type->machine.states;
        Nearest nearest{request.arguments[2]};
        for (std::size_t s = 0; s < states.size(); ++s) {
            nearest.consider(states[s].name);
            if (states[s].name == request.arguments[2]) order.state = static_cast<StateIndex>(s);
        }
        if (order.state == no_state) {
            Sentence text{"\"", request.arguments[1], "\" has no state \"",
                          request.arguments[2].substr(0, shown_characters), "\""};
            if (!nearest.best().empty()) text.add("; did you mean \"").add(nearest.best()).add("\"?");
            return {Refusal::unknown, text};
        }
    }
    const std::size_t c = find_component(machine.table, machine.table.behaviours[found.row].component);
    Pending* place = free_place(client.rights.role);
    if (place == nullptr) return no_place();
    order.unit = found.unit;
    order.slot = machine_->slot_of_row(found.row);
    order.part = found.part;
    order.engine = &machine_->engines()[machine.index.activity[c]];
    Message call;
    call.run = &command_behaviour;
    call.object = &place->work.emplace<BehaviourOrder>(order);
    return await_engine(*place, asker(client, request), c, call, &BrowserService::look_at_behave);
}

bool BrowserService::look_at_behave(Pending& place) {
    if (!place.call.is_over()) return false;
    if (std::get<BehaviourOrder>(place.work).done) return answer_good(place);
    return answer_bad(place, Refusal::not_now,
                      Sentence{"it does not do that in its present state; look at it with behaviours"});
}

// ---- slots

BrowserService::Verdict BrowserService::serve_script(Client& client, const Request& request) {
    BehaviourSlot* slot = nullptr;
    if (const Sentence unknown = find_slot(request.arguments[0], slot); !unknown.empty())
        return {Refusal::unknown, unknown};
    std::size_t at = 0;
    const std::string_view number = request.arguments[1];
    if (std::from_chars(number.data(), number.data() + number.size(), at).ptr !=
        number.data() + number.size())
        return {Refusal::bad_request,
                Sentence{"a piece of a script begins at a number of bytes; it is spelled: ",
                         request.verb->usage}};
    const bool mine = upload_.slot == slot && upload_.client == client.serial;
    if (at != 0 && (!mine || at != upload_.characters))
        return {Refusal::bad_request,
                Sentence{"the pieces of a script come one after the other from 0 on, from "
                         "one browser; begin again"}};
    if (!mine && upload_.slot != nullptr && connections_.find(upload_.client) != nullptr &&
        now_ - upload_.since < patience)
        return {Refusal::not_now, Sentence{"another browser is sending a script; ask again"}};
    upload_ = {slot, client.serial, at, now_};
    const std::span<char> room = slot->text();
    std::size_t end = at;
    const bool fits = browsing::unquote(request.arguments[2], [&](char character) {
        if (end < room.size()) room[end] = character;
        ++end;
    });
    if (!fits) return {Refusal::bad_request, Sentence{"the piece is not quoted well; see protocol.hpp"}};
    if (end > room.size())
        return {Refusal::unsupported,
                Sentence{"the slot of \"", request.arguments[0], "\" has room for ", room.size(),
                         " characters of a script; shorten it, or raise text_bytes(...)"}};
    upload_.characters = end;
    Reply reply{request.number, true};
    reply.json().field("bytes", end);
    return finish(client, reply);
}

BrowserService::Verdict BrowserService::serve_load(Client& client, const Request& request) {
    BehaviourSlot* slot = nullptr;
    if (const Sentence unknown = find_slot(request.arguments[0], slot); !unknown.empty())
        return {Refusal::unknown, unknown};
    if (upload_.slot != slot || upload_.client != client.serial || upload_.characters == 0)
        return {Refusal::not_now, Sentence{"no script was sent for the slot of \"", request.arguments[0],
                                           "\"; send one with script"}};
    const std::size_t characters = upload_.characters;
    upload_ = {};
    SlotMoment moment;
    if (request.arguments.size() > 2)
        if (const Sentence fault = slot->parse_moment(request.arguments[2], moment); !fault.empty())
            return {Refusal::bad_value, fault};
    if (const Sentence fault = slot->may_load(); !fault.empty()) return {Refusal::not_now, fault};
    if (const Sentence fault = slot->compile(characters, request.arguments[1]); !fault.empty())
        return {Refusal::bad_value, fault};
    return change_slot(client, request, *slot, BehaviourSlot::Change::take_over, moment);
}

BrowserService::Verdict BrowserService::change_slot(Client& client, const Request& request,
                                                    BehaviourSlot& slot, BehaviourSlot::Change change,
                                                    const SlotMoment& moment) {
    if (const Sentence fault = slot.may(change); !fault.empty()) return {Refusal::not_now, fault};
    if (Verdict alive = check_alive(slot.component()); !alive.good()) return alive;
    if (!slot.ask(change, moment))
        return {Refusal::not_now, Sentence{"another change is under way; ask again"}};
    if (!machine_->requests().post_change(slot)) {
        slot.withdraw();
        return {Refusal::not_now, Sentence{"that engine has too many requests to serve; ask again"}};
    }
    Reply reply{request.number, true};
    return finish(client, reply);
}

BrowserService::Verdict BrowserService::empty_slot(Client& client, const Request& request,
                                                   BehaviourSlot::Change change) {
    BehaviourSlot* slot = nullptr;
    if (const Sentence unknown = find_slot(request.arguments[0], slot); !unknown.empty())
        return {Refusal::unknown, unknown};
    return change_slot(client, request, *slot, change, {});
}

BrowserService::Verdict BrowserService::serve_unload(Client& client, const Request& request) {
    return empty_slot(client, request, BehaviourSlot::Change::unload);
}

BrowserService::Verdict BrowserService::serve_roll_back(Client& client, const Request& request) {
    return empty_slot(client, request, BehaviourSlot::Change::roll_back);
}

} // namespace tappet
