// Saves properties to their files (thesis 4.7.1): the engines that own them copy them, this activity writes
// them.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"

namespace tappet {

BrowserService::Verdict BrowserService::serve_save(Client& client, const Request& request) {
    for (const Pending& each : pending_)
        if (each.look == &BrowserService::look_at_saving)
            return {Refusal::not_now, Sentence{"properties are being saved; ask again"}};
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
    Pending* place = free_place(client.rights.role);
    if (place == nullptr) return no_place();
    place->work.emplace<PropertySaving>().begin(*machine_, own_activity_, component);
    return await(*place, asker(client, request), &BrowserService::look_at_saving);
}

bool BrowserService::look_at_saving(Pending& place) {
    auto& saving = std::get<PropertySaving>(place.work);
    if (saving.step()) return false;
    if (!saving.fault().empty())
        return answer_bad(place, saving.gave_up() ? Refusal::not_now : Refusal::unsupported, saving.fault());
    if (Client* client = who_waits(place)) {
        Reply reply{place.asker.number, true};
        reply.json().field("files", saving.saved());
        finish(*client, reply);
    }
    return true;
}

} // namespace tappet
