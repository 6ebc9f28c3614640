// Passes on what the scout saw, ticks, and starts logins and runs.
#include "toolchain/tools/gateway/hub.hpp"

#include "toolchain/tools/browser/reading_text.hpp"
#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/peer.hpp"

namespace tappet::network {

void Hub::see(const std::vector<Sighting>& sightings) {
    for (const Sighting& each : sightings) {
        const auto found = stations_.find(each.name);
        if (found != stations_.end() && each.gone && found->second.place() == nullptr) {
            stations_.erase(found);
            continue;
        }
        Station& station = found == stations_.end()
                               ? stations_.emplace(each.name, Station{each}).first->second
                               : found->second;
        // Watches end while their readings are still there.
        const std::vector<Peer*> told{peers_.begin(), peers_.end()};
        for (Peer* peer : told)
            peer->end_watches(station, each.place == nullptr ? each.reason : "it has started again");
        station.see(each);
        for (Peer* peer : told)
            if (peers_.contains(peer)) peer->tell(station);
        if (each.gone) stations_.erase(each.name);
    }
}

void Hub::tick(Clock::time_point now) {
    const std::int64_t now_ns = monotonic_ns();
    for (auto& [name, station] : stations_) station.look(now_ns);
    const std::vector<Peer*> present{peers_.begin(), peers_.end()};
    for (Peer* peer : present)
        if (peers_.contains(peer)) peer->tick(now, now_ns);
}

std::string Hub::each_second(Clock::time_point now) {
    std::string fault = access_.refresh();
    const std::vector<Peer*> present{peers_.begin(), peers_.end()};
    for (Peer* peer : present)
        if (peers_.contains(peer)) peer->check(now);
    return fault;
}

void Hub::close() {
    while (!peers_.empty()) (*peers_.begin())->close();
}

Station* Hub::find(std::string_view machine) {
    const auto found = stations_.find(machine);
    return found == stations_.end() ? nullptr : &found->second;
}

Station* Hub::owner_of(std::string_view name) {
    Station* longest = nullptr;
    for (auto& [machine, station] : stations_)
        if (name.starts_with(machine) && name.substr(machine.size(), 1) == "." &&
            (longest == nullptr || machine.size() > longest->name().size()))
            longest = &station;
    return longest;
}

std::vector<const Station*> Hub::stations() const {
    std::vector<const Station*> all;
    for (const auto& [name, station] : stations_) all.push_back(&station);
    return all;
}

std::string Hub::values_of(std::string_view machine, std::string_view line) {
    std::string values;
    for (const std::string& name : names_in(line)) {
        // Without a machine the name begins with it, unless there is only one.
        const Station* station = machine.empty() ? owner_of(name) : find(machine);
        if (machine.empty() && station == nullptr && stations_.size() == 1)
            station = &stations_.begin()->second;
        if (station == nullptr || station->place() == nullptr) continue;
        const browser::MapReader& map = station->place()->map;
        const auto facet = map.find(map.place() + std::string{map.own_name(name)});
        if (!facet || facet->record.value_at == 0) continue;
        const browser::Reading reading = station->read(std::span{&facet->index, 1}).front();
        values += (values.empty() ? "{" : ", ") + browser::in_quotes(as_utf8(name)) + ": " +
                  as_utf8(browser::value_of(map, reading, browser::Style::json));
    }
    return values.empty() ? values : values + "}";
}

std::expected<std::shared_ptr<Run>, std::string> Hub::run(const Message& message, const LoggedIn& who,
                                                          std::function<void()> woken) {
    std::size_t all = 0;
    for (const auto& [user, count] : runs_) all += count;
    if (all >= bounds.runs || runs_[who.user] >= bounds.runs_of_user)
        return std::unexpected("at most " + std::to_string(bounds.runs_of_user) +
                               " commands of a user run at once, and " + std::to_string(bounds.runs) +
                               " of all; end one");
    ++runs_[who.user];
    const auto wake = [network = outside_.on_network, woken = std::move(woken)] { network(woken); };
    auto run = std::make_shared<Run>(message, who, outside_.directory, outside_.black_boxes, wake);
    outside_.start([this, run, network = outside_.on_network, user = who.user] {
        run->run();
        network([this, user] {
            if (--runs_[user] == 0) runs_.erase(user);
        });
    });
    return run;
}

void Hub::login(const std::string& user, const std::string& password, const std::string& address,
                OnLogin done) {
    auto attempt = access_.begin(user, password, address, Clock::now());
    if (!attempt) {
        ++counters_.logins_failed;
        done(std::unexpected(attempt.error()));
        return;
    }
    const auto shared = std::make_shared<Attempt>(std::move(*attempt));
    const auto finish = [this, shared, done](bool matched) {
        auto outcome = access_.finish(*shared, matched, Clock::now());
        audit_.note(shared->name, shared->address, outcome ? "logged in" : "login failed");
        if (!outcome) ++counters_.logins_failed;
        done(std::move(outcome));
    };
    if (outside_.in_background([shared] { return shared->matches(); }, finish)) return;
    access_.cancel(*shared);
    done(std::unexpected("too many people log in at once; try again"));
}

} // namespace tappet::network
