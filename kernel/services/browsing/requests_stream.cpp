// Passes events (thesis 4.6) to the clients that subscribed to them.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/browsing/names.hpp"

#include <cstring>

namespace tappet {

BrowserService::Verdict BrowserService::serve_subscribe(Client& client, const Request& request) {
    End event;
    const MachineView& table = machine_->machine().table;
    const Sentence unknown = browsing::find_facet(table, request.arguments[0], {FacetKind::event}, event);
    if (!unknown.empty()) return {Refusal::unknown, unknown};
    Subscribed* place = nullptr;
    std::size_t free = 0;
    for (Subscribed& each : subscribed_) {
        if (!each.taken) place = &each;
        free += each.taken ? 0u : 1u;
        if (each.taken && each.asker.client == client.serial && each.event == event)
            return {Refusal::not_now, Sentence{"\"", request.arguments[0], "\" is subscribed to already"}};
    }
    if (free <= kept_from(client.rights.role, max_subscriptions))
        return {Refusal::not_now, Sentence{"all subscriptions that your role may have are taken; end one"}};
    const EventHandle handle = machine_->observation().observe_event(event.component, event.facet);
    if (!handle.valid())
        return {Refusal::unsupported,
                Sentence{"\"", request.arguments[0], "\" has ", facet_at(table, event).type->size,
                         " bytes of arguments, more than the ", most_observed_bytes,
                         " that browsers are told; read its component's ports instead"}};
    *place = {asker(client, request), true, event, machine_->observation().observed_index(event), handle};
    handle.connect();
    place->lost = -lost_of(*place); // from now on
    Reply reply{request.number, true};
    return finish(client, reply);
}

BrowserService::Verdict BrowserService::serve_unsubscribe(Client& client, const Request& request) {
    End event;
    const MachineView& table = machine_->machine().table;
    const Sentence unknown = browsing::find_facet(table, request.arguments[0], {FacetKind::event}, event);
    if (!unknown.empty()) return {Refusal::unknown, unknown};
    for (Subscribed& each : subscribed_) {
        if (!each.taken || each.asker.client != client.serial || !(each.event == event)) continue;
        drop(each);
        Reply reply{request.number, true};
        return finish(client, reply);
    }
    return {Refusal::not_now, Sentence{"\"", request.arguments[0], "\" is not subscribed to"}};
}

/// Ends a subscription. The row stays connected while any other client subscribes to the event.
void BrowserService::drop(Subscribed& subscribed) noexcept {
    subscribed.taken = false;
    for (const Subscribed& each : subscribed_)
        if (each.taken && each.index == subscribed.index) return;
    subscribed.handle.disconnect();
}

/// Returns the emissions lost on the way here, for all subscribers of the event.
std::int64_t BrowserService::lost_of(const Subscribed& subscribed) const noexcept {
    const SubscriptionCounts counts = machine_->observation().counts_of(subscribed.index);
    return static_cast<std::int64_t>(counts.lost + counts.dropped);
}

/// Runs in this engine, between two cycles.
void BrowserService::observe(void* self, std::size_t index, const std::byte* arguments, Time now) noexcept
    TAPPET_REALTIME {
    auto& service = *static_cast<BrowserService*>(self);
    const AcceptedMachine& machine = service.machine_->machine();
    const std::size_t bytes = facet_at(machine.table, machine.plan.subscriptions[index].event).type->size;
    const std::size_t begin = service.seen_bytes_used_;
    Role role = Role::observer;
    for (const Subscribed& each : service.subscribed_)
        if (each.taken && each.index == index) role = std::max(role, each.asker.role);
    if (service.seen_count_ + kept_from(role, max_events) >= max_events ||
        begin + bytes + kept_from(role, service.seen_bytes_.size()) > service.seen_bytes_.size()) {
        for (Subscribed& each : service.subscribed_) each.lost += each.taken && each.index == index ? 1 : 0;
        return;
    }
    service.seen_[service.seen_count_++] = {index, now, begin};
    std::memcpy(service.seen_bytes_.data() + begin, arguments, bytes);
    service.seen_bytes_used_ = (begin + bytes + value_alignment - 1) / value_alignment * value_alignment;
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
            reply.value(*facet.type, seen_bytes_.data() + seen_[i].arguments);
            reply.json().field("lost", each.lost + lost_of(each));
            finish(*client, reply);
        }
    seen_count_ = seen_bytes_used_ = 0;
}

} // namespace tappet
