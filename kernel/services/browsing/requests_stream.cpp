// Events (thesis 4.6), told to whoever subscribed to them.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/browsing/names.hpp"

#include <cstring>

namespace tappet {

BrowserService::Verdict BrowserService::subscribe(Client& client, const Request& request) {
    End event;
    const MachineView& table = machine_->machine().table;
    const Sentence unknown = browsing::find_facet(table, request.arguments[0], {FacetKind::event}, event);
    if (!unknown.empty()) return {Refusal::unknown, unknown};
    Subscribed* place = nullptr;
    for (Subscribed& each : subscribed_) {
        if (!each.taken) place = &each;
        if (each.taken && each.asker.client == client.serial && each.event == event)
            return {Refusal::not_now, Sentence{"\"", request.arguments[0], "\" is subscribed to already"}};
    }
    if (place == nullptr)
        return {Refusal::not_now, Sentence{"all ", max_subscriptions, " subscriptions are taken; end one"}};
    const EventHandle handle = machine_->observation().observe_event(event.component, event.facet);
    if (!handle.valid())
        return {Refusal::unsupported,
                Sentence{"\"", request.arguments[0],
                         "\" has arguments that exceed a message; read its ports instead"}};
    *place = {asker(client, request), true, event, machine_->observation().observed_index(event), handle};
    handle.connect();
    Reply reply{request.number, true};
    finish(client, reply);
    return {};
}

BrowserService::Verdict BrowserService::unsubscribe(Client& client, const Request& request) {
    End event;
    const MachineView& table = machine_->machine().table;
    const Sentence unknown = browsing::find_facet(table, request.arguments[0], {FacetKind::event}, event);
    if (!unknown.empty()) return {Refusal::unknown, unknown};
    for (Subscribed& each : subscribed_) {
        if (!each.taken || each.asker.client != client.serial || !(each.event == event)) continue;
        drop(each);
        Reply reply{request.number, true};
        finish(client, reply);
        return {};
    }
    return {Refusal::not_now, Sentence{"\"", request.arguments[0], "\" is not subscribed to"}};
}

/// The row stays connected while anybody else wants the event.
void BrowserService::drop(Subscribed& subscribed) noexcept {
    subscribed.taken = false;
    for (const Subscribed& each : subscribed_)
        if (each.taken && each.index == subscribed.index) return;
    subscribed.handle.disconnect();
}

/// In this engine, between two cycles.
void BrowserService::observe(void* self, std::size_t index, const std::byte* arguments, Time now) noexcept
    TAPPET_REALTIME {
    auto& service = *static_cast<BrowserService*>(self);
    if (service.seen_count_ == max_events) {
        ++service.unseen_;
        return;
    }
    Seen& seen = service.seen_[service.seen_count_++];
    seen.index = index;
    seen.at = now;
    std::memcpy(seen.arguments.data(), arguments, seen.arguments.size());
}

void BrowserService::tell_events() {
    const MachineView& table = machine_->machine().table;
    for (Subscribed& each : subscribed_)
        if (each.taken && connections_.find(each.asker.client) == nullptr) drop(each);
    for (std::size_t i = 0; i < seen_count_; ++i)
        for (const Subscribed& each : subscribed_) {
            Client* client = connections_.find(each.asker.client);
            if (!each.taken || each.index != seen_[i].index || client == nullptr) continue;
            const Facet& facet = facet_at(table, each.event);
            const Sentence name{table.components[each.event.component].name, ".", facet.name};
            Reply reply{each.asker.number};
            reply.json().field("event", name.view()).field("time_ns", to_ns(seen_[i].at)).key("arguments");
            reply.value(*facet.type, seen_[i].arguments.data());
            const SubscriptionCounts counts = machine_->observation().counts_of(each.index);
            reply.json().field("lost", counts.lost + counts.dropped + unseen_);
            finish(*client, reply);
        }
    seen_count_ = 0;
}

} // namespace tappet
