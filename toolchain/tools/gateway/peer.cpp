// Obeys the messages of one client.
#include "toolchain/tools/gateway/peer.hpp"

#include "toolchain/tools/browser/value.hpp"
#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/page.hpp"

#include <algorithm>
#include <cmath>

namespace tappet::network {

namespace {

using browser::in_quotes;

std::string ok(std::uint32_t id, const std::string& fields = {}) {
    return "{\"id\": " + std::to_string(id) + ", \"ok\": true" + (fields.empty() ? "" : ", " + fields) + "}";
}

/// Returns a JSON list of what `each` returns.
template <class Items, class Each> std::string list_of(const Items& items, Each&& each) {
    std::string text = "[";
    for (const auto& item : items) text += (text.size() > 1 ? ", " : "") + each(item);
    return text + "]";
}

} // namespace

Peer::Peer(Hub& hub, Outlet& outlet, std::string address, std::optional<LoggedIn> who, std::string token,
           Clock::time_point now)
    : hub_{hub},
      outlet_{&outlet},
      address_{std::move(address)},
      who_{std::move(who)},
      token_{std::move(token)},
      begun_{now} {
    hub_.join(*this);
}

Peer::~Peer() { close(); }

void Peer::close() {
    if (outlet_ == nullptr) return;
    outlet_ = nullptr;
    hub_.leave(*this);
    for (auto& [id, watch] : watches_) drop(watch);
    watches_.clear();
    carriages_.clear();
    for (auto& [id, each] : runs_) {
        each.run->leave();
        finish(each, "unknown: the client left before the end");
    }
    runs_.clear();
}

void Peer::refuse(std::uint32_t id, std::string_view code, std::string_view sentence) {
    outlet_->send(refusal_text(id, code, sentence));
}

bool Peer::uses(std::uint32_t id) const {
    return watches_.contains(id) || runs_.contains(id) ||
           std::ranges::any_of(carriages_, [&](const auto& each) { return each.second->uses(id); });
}

void Peer::receive(std::string_view text, Clock::time_point now) {
    if (outlet_ == nullptr) return;
    const auto message = parse_message(text);
    if (!message) return refuse(message.error().id, "bad_request", message.error().sentence);
    if (uses(message->id))
        return refuse(message->id, "bad_request", "this id is still in use; choose another");
    // Each message counts as use of the session.
    if (who_ && !hub_.access().local() && !hub_.access().find(token_, now))
        return outlet_->end("the session is over; log in again");
    obey(*message, now);
}

void Peer::obey(const Message& message, Clock::time_point now) {
    if (message.what == Do::login) return login(message, now);
    if (!who_)
        return refuse(message.id, "denied",
                      "log in first: {\"id\": 1, \"do\": \"login\", \"user\": .., \"password\": ..}");
    switch (message.what) {
    case Do::login: return;
    case Do::logout:
        hub_.access().end(token_);
        outlet_->send(ok(message.id));
        return outlet_->end("logged out");
    case Do::machines:
        return outlet_->send(
            ok(message.id, "\"machines\": " + list_of(hub_.stations(), [](const Station* each) {
                               return machine_json(*each);
                           })));
    case Do::facets: {
        const Station* const station = hub_.find(message.machine);
        if (station == nullptr || station->place() == nullptr)
            return refuse(message.id, "no_machine",
                          "no machine '" + as_utf8(message.machine) +
                              "' answers here; \"machines\" lists them");
        return outlet_->send(ok(message.id, "\"facets\": " + facets_json(*station)));
    }
    case Do::watch: return watch(message);
    case Do::unwatch: return unwatch(message);
    case Do::request: return request(message, now);
    case Do::run: return run(message);
    case Do::end: return end(message);
    }
}

void Peer::login(const Message& message, Clock::time_point now) {
    if (who_)
        return refuse(message.id, "not_now",
                      "this connection is logged in as " + who_->user + "; open another");
    // One login at a time: a second would find the connection in use by the first.
    if (logging_in_) return refuse(message.id, "not_now", "a login is being checked; wait for its answer");
    if (!message.session.empty()) {
        auto who = hub_.access().find(message.session, now);
        if (!who) return refuse(message.id, "denied", "the session is over; log in with user and password");
        return admit(message.id, std::move(*who), message.session);
    }
    logging_in_ = true;
    hub_.login(message.user, message.password, address_,
               [weak = weak_from_this(), id = message.id](auto outcome) {
                   const auto self = weak.lock();
                   if (self == nullptr || self->outlet_ == nullptr) return;
                   self->logging_in_ = false;
                   if (!outcome) return self->refuse(id, "denied", outcome.error());
                   self->admit(id, std::move(outcome->who), std::move(outcome->token));
               });
}

void Peer::admit(std::uint32_t id, LoggedIn who, std::string token) {
    who_ = std::move(who);
    token_ = std::move(token);
    outlet_->send(ok(id, "\"user\": " + in_quotes(who_->user) + ", \"role\": " +
                             in_quotes(tappet::to_text(who_->role)) + ", \"session\": " + in_quotes(token_)));
}

void Peer::watch(const Message& message) {
    if (watches_.size() >= bounds.watches)
        return refuse(message.id, "not_now",
                      "a connection has at most " + std::to_string(bounds.watches) + " watches; unwatch one");
    const double fastest = 1000.0 / static_cast<double>(bounds.tick.count());
    if (message.rate_hz > fastest || message.rate_hz < 0.01)
        return refuse(message.id, "bad_value", "rate_hz is from 0.01 to 20; choose a slower or a faster one");
    if (message.names.empty())
        return refuse(message.id, "bad_request", "names is empty; name at least one value");
    Station* const station = hub_.owner_of(message.names.front());
    if (station == nullptr || station->place() == nullptr)
        return refuse(message.id, "no_machine",
                      "no machine of '" + as_utf8(cut(message.names.front(), 200)) +
                          "' answers here; write MACHINE.COMPONENT.NAME");
    const browser::MapReader& map = station->place()->map;
    Watch watch{station->name(), station->life(), {}, 1, 1, Frames{message.id, message.names.size()}};
    for (const std::string& name : message.names) {
        const auto found = map.find(name);
        if (!found || found->record.value_at == 0)
            return refuse(message.id, "unknown",
                          "'" + as_utf8(cut(name, 200)) + "' is no value of '" + station->name() +
                              "'; a watch has values of one machine, and \"facets\" lists them");
        watch.facets.push_back(found->index);
    }
    std::vector<std::uint32_t> sorted = watch.facets;
    std::ranges::sort(sorted);
    if (std::ranges::adjacent_find(sorted) != sorted.end())
        return refuse(message.id, "bad_request", "a value is named twice; name each once");
    watch.every = static_cast<unsigned>(std::lround(fastest / message.rate_hz));
    const auto types = [&](std::uint32_t facet) { return map.facets()[facet].type; };
    outlet_->send(
        ok(message.id,
           "\"machine\": " + in_quotes(station->name()) + ", \"names\": " +
               list_of(message.names, [](const std::string& name) { return in_quotes(as_utf8(name)); }) +
               ", \"kinds\": " +
               list_of(watch.facets,
                       [&](std::uint32_t each) { return in_quotes(to_text(frame_kind(map, types(each)))); }) +
               ", \"types\": " +
               list_of(watch.facets,
                       [&](std::uint32_t each) {
                           return in_quotes(as_utf8(browser::type_name(map, types(each))));
                       }) +
               ", \"units\": " + list_of(watch.facets, [&](std::uint32_t each) {
                   return in_quotes(as_utf8(map.text(map.facets()[each].unit)));
               })));
    if (outlet_ == nullptr) return;
    station->want(watch.facets);
    watches_.emplace(message.id, std::move(watch));
}

void Peer::unwatch(const Message& message) {
    const auto found = watches_.find(message.of);
    if (found == watches_.end())
        return refuse(message.id, "unknown",
                      "there is no watch of this id; it may have ended with its machine");
    drop(found->second);
    watches_.erase(found);
    outlet_->send(ok(message.id));
}

void Peer::drop(const Watch& watch) {
    if (Station* const station = hub_.find(watch.machine)) station->drop(watch.facets, watch.life);
}

void Peer::request(const Message& message, Clock::time_point now) {
    const Station* const station = hub_.find(message.machine);
    if (station == nullptr)
        return refuse(message.id, "no_machine",
                      "there is no machine '" + as_utf8(cut(message.machine, 200)) +
                          "'; \"machines\" lists them");
    std::size_t under_way = 0;
    for (const auto& [name, each] : carriages_) under_way += each->under_way();
    if (under_way >= bounds.requests_under_way)
        return refuse(message.id, "not_now",
                      "a connection has at most " + std::to_string(bounds.requests_under_way) +
                          " requests and subscriptions under way; wait for an answer");
    if (!carriages_.contains(message.machine) && carriages_.size() >= bounds.relays_of_client)
        return refuse(message.id, "not_now",
                      "a connection asks at most " + std::to_string(bounds.relays_of_client) +
                          " machines at a time; wait " + std::to_string(bounds.relay_idle.count()) + " s");
    auto& carriage = carriages_[message.machine];
    if (carriage == nullptr)
        carriage =
            std::make_unique<Carriage>(hub_, message.machine, *who_, address_, [this](std::string text) {
                if (outlet_ != nullptr) outlet_->send(std::move(text));
            });
    carriage->request(message.id, message.line, now);
}

void Peer::run(const Message& message) {
    Running running;
    for (const std::string& word : message.words)
        running.line += (running.line.empty() ? "" : " ") + browser::as_word(word);
    // An observer changes nothing: the machine refuses it, so it does not fill the log.
    if (who_->role != Role::observer && !only_looks(message.words.empty() ? "" : message.words.front())) {
        running.logged =
            hub_.audit().asked({who_->user, address_, {}, running.line, hub_.values_of({}, running.line)});
        if (running.logged == 0)
            return refuse(message.id, "not_now",
                          "the gateway cannot write its log, so it runs no changes; is its disk full?");
    }
    auto started = hub_.run(message, *who_, [weak = weak_from_this()] {
        if (const auto self = weak.lock(); self != nullptr) self->forward();
    });
    if (!started) {
        finish(running, "refused: " + started.error());
        return refuse(message.id, "not_now", started.error());
    }
    running.run = std::move(*started);
    runs_.emplace(message.id, std::move(running));
    outlet_->send(ok(message.id));
}

void Peer::end(const Message& message) {
    const auto found = runs_.find(message.of);
    if (found == runs_.end())
        return refuse(message.id, "unknown", "there is no run of this id; it may have ended");
    found->second.run->stop();
    outlet_->send(ok(message.id));
}

void Peer::finish(const Running& running, std::string_view outcome) {
    if (running.logged != 0) hub_.audit().answered(running.logged, outcome, hub_.values_of({}, running.line));
}

void Peer::forward() {
    for (auto each = runs_.begin(); outlet_ != nullptr && each != runs_.end();) {
        while (outlet_->has_room()) {
            auto message = each->second.run->next();
            if (!message) break;
            outlet_->send(std::move(*message));
        }
        const auto code = each->second.run->exit_code();
        if (!code) {
            ++each;
            continue;
        }
        finish(each->second, *code == 0 ? "done" : "failed: exit code " + std::to_string(*code));
        outlet_->send("{\"id\": " + std::to_string(each->first) + ", \"exit\": " + std::to_string(*code) +
                      "}");
        each = runs_.erase(each);
    }
}

void Peer::tick(Clock::time_point, std::int64_t now_ns) {
    forward();
    for (auto& [id, watch] : watches_) {
        if (--watch.left != 0) continue;
        watch.left = watch.every;
        const Station* const station = hub_.find(watch.machine);
        if (station == nullptr || station->place() == nullptr || station->life() != watch.life) continue;
        if (outlet_->offer(watch.frames.make(*station, watch.facets, now_ns))) {
            watch.frames.keep();
            ++hub_.counters().frames_sent;
        } else {
            watch.frames.lose();
            ++hub_.counters().frames_lost;
        }
    }
}

void Peer::check(Clock::time_point now) {
    std::erase_if(carriages_, [&](const auto& each) { return each.second->is_idle(now); });
    if (!who_ && now - begun_ > bounds.unknown) return outlet_->end("nobody logged in within 30 s");
    if (who_ && !hub_.access().lasts(token_, now)) outlet_->end("the session is over; log in again");
}

void Peer::end_watches(Station& station, std::string_view reason) {
    if (outlet_ == nullptr) return;
    for (auto each = watches_.begin(); each != watches_.end();) {
        if (each->second.machine != station.name()) {
            ++each;
            continue;
        }
        outlet_->send("{\"id\": " + std::to_string(each->first) +
                      ", \"packet\": {\"final\": true, \"error\": " +
                      in_quotes("'" + station.name() + "': " + as_utf8(reason)) + "}}");
        if (outlet_ == nullptr) return;
        drop(each->second);
        each = watches_.erase(each);
    }
}

void Peer::tell(const Station& station) {
    if (who_ && outlet_ != nullptr)
        outlet_->send("{\"id\": 0, \"packet\": {\"machine\": " + machine_json(station) + "}}");
}

} // namespace tappet::network
