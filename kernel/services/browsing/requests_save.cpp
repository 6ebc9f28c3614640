// Properties to their files (thesis 4.7.1): copied by the engines that own them, written by this activity.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"

namespace tappet {

BrowserService::Verdict BrowserService::save(Client& client, const Request& request) {
    if (save_.saving.busy()) return {Refusal::not_now, Sentence{"properties are being saved; ask again"}};
    const MachineView& table = machine_->machine().table;
    std::size_t component = nowhere;
    if (!request.arguments.empty()) {
        component = find_component(table, request.arguments[0]);
        if (component == nowhere) return {Refusal::unknown, unknown_component(table, request.arguments[0])};
        if (!table.components[component].has_properties_file)
            return {Refusal::unsupported,
                    Sentence{"component \"", request.arguments[0],
                             "\" has no properties file; give its row properties_file(...)"}};
    }
    save_.asker = asker(client, request);
    save_.given_up = false;
    save_.saving.begin(*machine_, own_activity_, component);
    return {};
}

void BrowserService::follow_saving() {
    if (!save_.saving.busy()) return;
    if (save_.saving.step()) {
        if (save_.given_up || now_ - save_.asker.since <= patience) return;
        save_.given_up = true;
        reply_bad(
            save_.asker, Refusal::not_now,
            Sentence{
                "an engine did not come to it yet, the files before it are saved: look at its activity"});
        return;
    }
    if (save_.given_up) return;
    if (!save_.saving.fault().empty()) {
        reply_bad(save_.asker, Refusal::unsupported, save_.saving.fault());
        return;
    }
    Client* client = door_.find(save_.asker.client);
    if (client == nullptr) return;
    Reply reply{save_.asker.number, true};
    reply.json().field("files", save_.saving.saved());
    finish(*client, reply);
}

} // namespace tappet
