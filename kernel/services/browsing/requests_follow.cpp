// Requests with more than one answer: commands, followed to their end, and starting and stopping parts of the
// machine.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/browsing/names.hpp"

#include <algorithm>

namespace tappet {

using browsing::FollowedCommand;
using browsing::FollowedLife;

BrowserService::Verdict BrowserService::serve_send(Client& client, const Request& request) {
    End end;
    const MachineView& table = machine_->machine().table;
    const Sentence unknown = browsing::find_facet(table, request.arguments[0], {FacetKind::command}, end);
    if (!unknown.empty()) return {Refusal::unknown, unknown};
    if (Verdict barred = check_facet(client, request.arguments[0], facet_at(table, end)); !barred.good())
        return barred;
    // Commands may take any time, even after their client has left: the other places are for requests that
    // end them.
    const auto commands = static_cast<std::size_t>(std::ranges::count_if(
        pending_, [](const Pending& each) { return each.look == &BrowserService::look_at_command; }));
    if (commands + kept_from(client.rights.role, max_commands) >= max_commands)
        return {Refusal::not_now,
                Sentence{"too many commands are under way; await one, or stop what they wait for"}};
    Pending* place = free_place(client.rights.role);
    if (place == nullptr) return no_place();
    auto& call = place->work.emplace<FollowedCommand>();
    const Facet& facet = facet_at(table, end);
    if (facet.command->value_bytes() > call.values.size())
        return {Refusal::unsupported, Sentence{"its arguments are too large to come from outside"}};
    if (Verdict read = read_arguments(facet, request, call.values); !read.good()) return read;
    if (!machine_->requests().bind_command(end, call.slot, call.values) || !call.slot.send())
        return {Refusal::not_now, Sentence{"it cannot be sent now; ask again"}};
    call.command = end;
    Reply reply{request.number, true};
    reply.json().field("state", "sent");
    finish(client, reply);
    return await(*place, asker(client, request), &BrowserService::look_at_command);
}

bool BrowserService::look_at_command(Pending& place) {
    place.asker.since = now_; // it may take any time, and its client knows that it was sent
    auto& call = std::get<FollowedCommand>(place.work);
    const CommandState state = call.slot.state();
    if (state == call.told) return false;
    call.told = state;
    const bool is_final = !in_flight(state);
    const MachineView& table = machine_->machine().table;
    const Facet& facet = facet_at(table, call.command);
    const Sentence name{table.components[call.command.component].name, ".", facet.name};
    if (is_final && state != CommandState::done) note_end(place, to_text(state), name.view());
    Client* client = who_waits(place);
    if (client == nullptr) return is_final;
    Reply reply{place.asker.number};
    JsonText& json = reply.json();
    json.field("command", name.view()).field("state", to_text(state)).field("time_ns", to_ns(now_));
    if (is_final) json.field("final", true);
    if (state == CommandState::done) {
        json.key("results").open('[');
        std::size_t at = facet.command->argument_bytes;
        for (const TypeId type : facet.command->results->elements) {
            alignas(16) std::array<std::byte, sizeof call.values> value{};
            std::memcpy(value.data(), call.values.data() + at, type->size);
            reply.value(*type, value.data());
            at += type->size;
        }
        json.close(']');
    }
    finish(*client, reply);
    return is_final;
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
    Pending* place = free_place(client.rights.role);
    if (place == nullptr) return no_place();
    const LifeTicket ticket = target.component != nowhere
                                  ? machine_->life().ask_component(target.component, change)
                                  : machine_->life().ask_activity(target.activity, change);
    place->work.emplace<FollowedLife>(target.component, activity, ticket, change);
    return await(*place, asker(client, request), &BrowserService::look_at_life);
}

BrowserService::Verdict BrowserService::serve_start(Client& client, const Request& request) {
    return change_life(client, request, LifeChange::start);
}

BrowserService::Verdict BrowserService::serve_stop(Client& client, const Request& request) {
    return change_life(client, request, LifeChange::stop);
}

BrowserService::Verdict BrowserService::serve_restart(Client& client, const Request& request) {
    return change_life(client, request, LifeChange::restart);
}

bool BrowserService::look_at_life(Pending& place) {
    const auto& call = std::get<FollowedLife>(place.work);
    const LifeAnswer answer = call.component != nowhere
                                  ? machine_->life().answer_of_component(call.component, call.ticket)
                                  : machine_->life().answer_of_activity(call.activity, call.ticket);
    switch (answer.outcome) {
    case LifeOutcome::pending: return false;
    case LifeOutcome::done: break;
    case LifeOutcome::superseded:
        return answer_bad(place, Refusal::not_now,
                          Sentence{"another request replaced it; look at its state"});
    case LifeOutcome::refused:
        if (answer.refusal == LifeRefusal::left_unsafe) break;
        return answer_bad(place, Refusal::not_now, machine_->life().describe(call.activity, answer));
    }
    if (answer.outcome == LifeOutcome::done) return answer_good(place);
    return answer_bad(place, Refusal::not_now, machine_->life().describe(call.activity, answer));
}

} // namespace tappet
