// Requests with more than one answer: commands, followed to their end, and the starting and stopping of parts
// of the machine.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/browsing/names.hpp"

namespace tappet {

BrowserService::Verdict BrowserService::send(Client& client, const Request& request) {
    End end;
    const MachineView& table = machine_->machine().table;
    const Sentence unknown = browsing::find_facet(table, request.arguments[0], {FacetKind::command}, end);
    if (!unknown.empty()) return {Refusal::unknown, unknown};
    if (Verdict role = check_role(client, request.arguments[0], facet_at(table, end).least_role);
        !role.good())
        return role;
    CommandInFlight* place = nullptr;
    for (CommandInFlight& each : commands_)
        if (!each.taken) place = &each;
    if (place == nullptr)
        return {Refusal::not_now,
                Sentence{"all ", max_commands, " places for commands are taken; ask again"}};
    const Facet& facet = facet_at(table, end);
    if (facet.command->value_bytes() > place->values.size())
        return {Refusal::unsupported, Sentence{"its arguments are too large to come from outside"}};
    place->values = {};
    if (Verdict read = read_arguments(facet, request, place->values); !read.good()) return read;
    if (!machine_->bind_command(end, place->slot, place->values) || !place->slot.send())
        return {Refusal::not_now, Sentence{"it cannot be sent now; ask again"}};
    place->asker = asker(client, request);
    place->command = end;
    place->told = CommandState::sent;
    place->taken = true;
    Reply reply{request.number, true};
    reply.json().field("state", "sent");
    finish(client, reply);
    return {};
}

void BrowserService::follow_commands() {
    const MachineView& table = machine_->machine().table;
    for (CommandInFlight& each : commands_) {
        if (!each.taken) continue;
        const CommandState state = each.slot.state();
        if (state == each.told) continue;
        each.told = state;
        const bool is_final = !in_flight(state);
        each.taken = !is_final;
        Client* client = door_.find(each.asker.client);
        if (client == nullptr) continue;
        const Facet& facet = facet_at(table, each.command);
        const Sentence name{table.components[each.command.component].name, ".", facet.name};
        Reply reply{each.asker.number};
        JsonText& json = reply.json();
        json.field("command", name.view()).field("state", to_text(state)).field("time_ns", to_ns(now_));
        if (is_final) json.field("final", true);
        if (state == CommandState::done) {
            json.key("results").open('[');
            std::size_t at = facet.command->argument_bytes;
            for (const TypeId type : facet.command->results->elements) {
                alignas(16) std::array<std::byte, sizeof each.values> value{};
                std::memcpy(value.data(), each.values.data() + at, type->size);
                reply.value(*type, value.data());
                at += type->size;
            }
            json.close(']');
        }
        finish(*client, reply);
    }
}

BrowserService::Verdict BrowserService::change_life(Client& client, const Request& request,
                                                    LifeChange change) {
    browsing::LifeTarget target;
    const AcceptedMachine& machine = machine_->machine();
    if (const Sentence fault = browsing::find_life(machine.table, request.arguments[0], target);
        !fault.empty())
        return {Refusal::unknown, fault};
    const std::size_t activity =
        target.activity != nowhere ? target.activity : machine.index.activity[target.component];
    if (activity == own_activity_)
        return {Refusal::unsupported,
                Sentence{"the browser answers from activity \"", machine.table.activities[activity].name,
                         "\" itself and does not stop or start it; stop the machine instead"}};
    LifeRequest* place = nullptr;
    for (LifeRequest& each : lives_)
        if (!each.taken) place = &each;
    if (place == nullptr) return {Refusal::not_now, Sentence{"too many of these are under way; ask again"}};
    place->taken = true;
    place->asker = asker(client, request);
    place->component = target.component;
    place->activity = activity;
    place->change = change;
    place->ticket = target.component != nowhere ? machine_->ask_component(target.component, change)
                                                : machine_->ask_activity(target.activity, change);
    return {};
}

void BrowserService::follow_lives() {
    for (LifeRequest& each : lives_) {
        if (!each.taken) continue;
        const LifeAnswer answer = each.component != nowhere
                                      ? machine_->answer_of_component(each.component, each.ticket)
                                      : machine_->answer_of_activity(each.activity, each.ticket);
        if (answer.outcome == LifeOutcome::pending) {
            if (now_ - each.asker.since <= patience) continue;
            reply_bad(
                each.asker, Refusal::not_now,
                Sentence{"it has not happened yet; look at its state: what it waits for may still come"});
        } else if (answer.outcome == LifeOutcome::done) {
            if (each.change != LifeChange::start && !release_behind(each)) continue;
            reply_good(each.asker);
        } else if (answer.outcome == LifeOutcome::superseded) {
            reply_bad(each.asker, Refusal::not_now,
                      Sentence{"somebody asked for something else meanwhile; look at its state"});
        } else {
            reply_bad(each.asker, Refusal::not_now, machine_->describe(each.activity, answer));
        }
        each.taken = false;
    }
}

} // namespace tappet
