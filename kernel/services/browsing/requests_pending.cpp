// Pending requests of all kinds: accepted, checked, and given up by one rule.
#include "kernel/services/browsing/browser_service.hpp"

#include <algorithm>

namespace tappet {

using browsing::Asker;

BrowserService::Pending* BrowserService::free_place(Role role) noexcept {
    const auto is_free = [](const Pending& each) { return each.look == nullptr; };
    const auto first = std::ranges::find_if(pending_, is_free);
    const auto count = static_cast<std::size_t>(std::ranges::count_if(pending_, is_free));
    return count > kept_from(role, max_pending) ? &*first : nullptr;
}

BrowserService::Verdict BrowserService::no_place() noexcept {
    return {Refusal::not_now, Sentence{"too many requests are under way; ask again"}};
}

BrowserService::Verdict BrowserService::await(Pending& place, const Asker& asker,
                                              Look BrowserService::* look) {
    place.asker = asker;
    place.look = look;
    place.is_told = false;
    return {};
}

BrowserService::Verdict BrowserService::await_engine(Pending& place, const Asker& asker,
                                                     std::size_t component, const Message& call,
                                                     Look BrowserService::* look) {
    const AcceptedMachine& machine = machine_->machine();
    if (Verdict alive = check_alive(component); !alive.good()) return alive;
    Message message = call;
    message.id = machine.plan.part_of[component];
    if (!place.call.post(*machine_, machine.index.activity[component], message, asker.role))
        return {Refusal::not_now, Sentence{"that engine has too many requests to serve; ask again"}};
    return await(place, asker, look);
}

void BrowserService::follow_pending() {
    for (Pending& each : pending_) {
        if (each.look == nullptr) continue;
        if ((this->*each.look)(each)) {
            each.look = nullptr;
        } else if (!each.is_told && now_ - each.asker.since > patience) {
            // A withdrawn call is over, and the next check frees its place; a call that may still run keeps
            // it.
            answer_bad(each, Refusal::not_now,
                       each.call.withdraw()
                           ? Sentence{"its engine did not execute it in time; nothing was done: look at its "
                                      "activity"}
                           : Sentence{"it has not happened yet and may still happen: look at its activity"});
            each.is_told = true;
        }
    }
}

BrowserService::Client* BrowserService::who_waits(const Pending& place) noexcept {
    return place.is_told ? nullptr : connections_.find(place.asker.client);
}

bool BrowserService::answer_good(const Pending& place) noexcept {
    if (Client* client = who_waits(place)) {
        Reply reply{place.asker.number, true};
        finish(*client, reply);
    }
    return true;
}

bool BrowserService::answer_bad(const Pending& place, Refusal code, const Sentence& why) noexcept {
    note_end(place, to_text(code), why.view());
    if (Client* client = who_waits(place)) {
        Reply reply{place.asker.number, code, why};
        finish(*client, reply);
    }
    return true;
}

} // namespace tappet
