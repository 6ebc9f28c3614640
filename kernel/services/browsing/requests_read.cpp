// Requests that only read: answered at once.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/browsing/names.hpp"

#include <algorithm>

namespace tappet {

BrowserService::Verdict BrowserService::serve_hello(Client& client, const Request& request) {
    const auto& header =
        *reinterpret_cast<const map::Header*>(machine_->observation().shared_memory().data());
    const AcceptedMachine& machine = machine_->machine();
    Reply reply{request.number, true};
    reply.json()
        .field("protocol", browsing::protocol_version)
        .field("machine", machine.table.name)
        .field("board", machine.board->name)
        .field("world", machine.board->world)
        .field("role", to_text(client.rights.role))
        .field("build_id", std::string_view{header.build_id.data()})
        .field("framework", std::string_view{header.framework.data()})
        .field("time_ns", to_ns(now_));
    return finish(client, reply);
}

BrowserService::Verdict BrowserService::serve_as(Client& client, const Request& request) {
    if (client.has_asked)
        return {Refusal::bad_request,
                Sentence{"\"as\" is the first request of a connection, and comes once; connect anew"}};
    Rights asked;
    browsing::UserName user;
    const auto& words = request.arguments;
    if (const Sentence fault = browsing::parse_user(words[0], words[1], words[2], user, asked);
        !fault.empty())
        return {Refusal::bad_value, fault};
    if (asked.origin == Origin::panel && client.gateway != nullptr && !client.gateway->with_panel)
        return {Refusal::denied,
                Sentence{"this gateway has no panel; add with_panel to its row in the board's "
                         "list of roles, or say \"network\""}};
    const Role bound = client.gateway != nullptr ? client.gateway->role : client.rights.role;
    client.rights = {std::min(bound, asked.role), asked.origin};
    client.user = user;
    client.must_name_user = false;
    Reply reply{request.number, true};
    reply.json().field("role", to_text(client.rights.role));
    return finish(client, reply);
}

BrowserService::Verdict BrowserService::serve_map(Client& client, const Request& request) {
    Reply reply{request.number, true};
    reply.json().field("bytes", machine_->observation().shared_memory().size());
    connections_.send(client, reply.finish(), machine_->observation().shared_descriptor());
    return {};
}

BrowserService::Verdict BrowserService::serve_counters(Client& client, const Request& request) {
    Reply reply{request.number, true};
    JsonText& json = reply.json();
    const MachineObservation& seen = machine_->observation();
    json.key("stacks").open('[');
    const auto engines = machine_->engines();
    for (std::size_t a = 0; a < engines.size(); ++a)
        json.open('{')
            .field("activity", engines[a].name())
            .field("bytes", machine_->stack_of(a).size())
            .field("used_bytes", seen.stack_high_water_bytes(a))
            .close('}');
    json.close(']').key("held_back").open('[');
    for (std::size_t section = 0; section < machine_->machine().table.extras->size(); ++section)
        for (std::size_t row = 0; !seen.counted(section, row).what.empty(); ++row) {
            const SectionCount count = seen.counted(section, row);
            json.open('{').field("row", count.what).field("times", count.times).close('}');
        }
    json.close(']').key("unsent").open('[');
    constexpr std::size_t most_unsent_rows = 16; // a reply is one packet
    std::size_t rows = 0;
    machine_->each_unsent([&](std::string_view component, const Facet& row, const Unsent& unsent) {
        if (++rows > most_unsent_rows) return;
        const bool came = row.kind == FacetKind::output;
        json.open('{').field(came ? "output" : "input", Sentence{component, ".", row.name}.view());
        json.field("clamped", unsent.clamped).field("no_number", unsent.no_number).close('}');
    });
    json.close(']').field("unsent_rows", rows);
    return finish(client, reply);
}

BrowserService::Verdict BrowserService::serve_get(Client& client, const Request& request) {
    Reply reply{request.number, true};
    reply.json().key("values").open('[');
    for (const std::string_view name : request.arguments) {
        End end;
        const Sentence fault = browsing::find_facet(
            machine_->machine().table, name, {FacetKind::input, FacetKind::output, FacetKind::property}, end);
        if (!fault.empty()) return {Refusal::unknown, fault};
        put_value(reply, end, name);
    }
    reply.json().close(']');
    return finish(client, reply);
}

void BrowserService::put_value(Reply& reply, End end, std::string_view name) {
    const auto view = map::View::open(machine_->observation().shared_memory());
    const Facet& facet = facet_at(machine_->machine().table, end);
    JsonText& json = reply.json();
    json.open('{').field("name", name);
    alignas(16) std::array<std::byte, 2048> value;
    if (!view || facet.type->size > value.size()) {
        json.field("error", "it is too large; read it from the map").close('}');
        return;
    }
    const map::Component& component = view->components()[end.component];
    const map::Facet& record = view->facets()[component.first_facet + end.facet];
    bool is_forced = false;
    std::uint64_t writes = 0;
    std::int64_t stamp = 0;
    bool there = true;
    const auto copy = [&] {
        is_forced = record.forced_at != 0 && view->word<std::uint8_t>(record.forced_at) != 0;
        const bool hidden = is_forced && record.forced_value_at != 0;
        there = view->copy(hidden ? record.forced_value_at : record.value_at,
                           std::span{value}.first(facet.type->size));
        writes = view->word<std::uint64_t>(record.writes_at);
        stamp = view->word<std::int64_t>(record.stamp_at);
    };
    // Its own activity is in the middle of this cycle and writes nothing meanwhile.
    bool whole = true;
    if (component.activity == own_activity_)
        copy();
    else
        whole = view->consistent(component.activity, reading_attempts, copy);
    if (!whole || !there) {
        json.field("error", whole ? "it has no value" : "its activity is busy; ask again").close('}');
        return;
    }
    json.key("value");
    reply.value(*facet.type, value.data());
    if (facet.port != nullptr) {
        Duration max_age{};
        bool was_written = false; // an input's `writes` counts only the values that its component read
        for (const map::Connection& row : view->connections()) {
            if (&view->facets()[row.to] != &record) continue;
            max_age = Duration{row.max_age_ns};
            was_written |= view->word<std::uint64_t>(view->facets()[row.from].writes_at) != 0;
        }
        // A reader that is stopped, or hangs, reads nothing: its own time would keep a value fresh for ever.
        const std::int64_t seen = view->word<std::int64_t>(view->activities()[component.activity].now_at);
        const Duration age{std::max(seen, to_ns(now_)) - stamp};
        const bool stale = max_age > Duration::zero() && age > max_age;
        json.field("flow", is_forced                    ? "fresh"
                           : writes == 0 && was_written ? "unread"
                           : writes == 0                ? "never_written"
                           : stale                      ? "stale"
                                                        : "fresh");
        json.field("forced", is_forced).field("time_ns", stamp);
    }
    json.close('}');
}

BrowserService::Verdict BrowserService::serve_forced(Client& client, const Request& request) {
    Reply reply{request.number, true};
    reply.json().key("forced").open('[');
    const auto view = map::View::open(machine_->observation().shared_memory());
    if (view)
        for (const map::Facet& each : view->facets()) {
            if (each.forced_at == 0 || view->word<std::uint8_t>(each.forced_at) == 0) continue;
            const Sentence name{view->text(view->components()[each.component].name), ".",
                                view->text(each.name)};
            reply.json().value(name.view());
        }
    reply.json().close(']');
    return finish(client, reply);
}

} // namespace tappet
