// One cycle of the service: accepts clients, receives, answers, and follows pending requests.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/os/terminal.hpp"

namespace tappet {

Sentence BrowserService::configure(Setup& setup) {
    machine_ = setup.machine;
    own_activity_ = activity_of(machine_->machine().table, setup.component);
    machine_->observation().show_events_to({&observe, this});
    machine_->observation().answer_by({&answer_for_nobody, this});
    return initialise();
}

Sentence BrowserService::initialise() {
    const std::string_view directory = machine_->browsing_directory();
    if (directory.empty() || connections_.is_open()) return {};
    const AcceptedMachine& machine = machine_->machine();
    const auto opened = connections_.open(directory, machine.table.name, machine.board->browsing);
    return opened ? Sentence{} : opened.error();
}

void BrowserService::finalise() {
    for (Subscribed& each : subscribed_)
        if (each.taken) drop(each);
    seen_count_ = 0; // no client is left to be told
    connections_.close();
}

void BrowserService::work(const Cycle& cycle) {
    if (!connections_.is_open()) return;
    now_ = cycle.now;
    accept();
    for (Client& each : connections_.clients()) hear(each);
    follow_pending();
    tell_events();
    std::int64_t connected = 0;
    for (const Client& each : connections_.clients()) connected += each.serial != 0;
    clients.write(connected);
    requests.write(static_cast<std::int64_t>(accepted_));
    refused.write(static_cast<std::int64_t>(refused_));
}

void BrowserService::accept() {
    for (std::size_t i = 0; i < browsing::Connections::most_each_cycle; ++i) {
        const Client* client = connections_.accept();
        if (client == nullptr) break;
        note(*client, "connected", {}, {});
    }
    if (turned_away_ == connections_.turned_away()) return;
    turned_away_ = connections_.turned_away();
    if (log)
        os::print("browser: a client was turned away: all places are taken, or one of a higher role took its "
                  "own\n");
}

void BrowserService::hear(Client& client) {
    for (std::size_t i = 0; i < browsing::Connections::packets_each_cycle && client.serial != 0; ++i) {
        bool cut = false;
        const Client before{{}, client.peer, client.rights, client.serial, client.user};
        const auto packet = connections_.receive(client, packet_, cut);
        if (packet)
            handle(client, *packet, cut);
        else if (client.serial == 0)
            note(before, "left", {}, {});
        if (!packet) return;
    }
}

void BrowserService::handle(Client& client, std::string_view packet, bool cut) {
    Request request;
    Verdict verdict;
    if (cut)
        verdict.why = Sentence{"a request has at most ", browsing::max_packet_bytes, " bytes; send several"};
    if (verdict.good()) verdict.why = browsing::parse_request(packet, request);
    // A connection whose user is not accepted asks for nobody: it is not a local one again.
    const std::string_view verb = request.verb != nullptr ? request.verb->name : std::string_view{};
    client.must_name_user |= verb == "as" && !client.has_asked;
    if (verdict.good() && client.must_name_user && verb != "as" && verb != "hello")
        verdict = {Refusal::denied,
                   Sentence{"this connection asks for a user whom it has not named; begin with "
                            "\"as NAME ROLE network|panel\""}};
    if (verdict.good()) verdict = check_role(client, request.verb->name, request.verb->role);
    if (verdict.good()) verdict = answer(client, request);
    client.has_asked |= !client.must_name_user && !verb.empty() && verb != "hello";
    ++(verdict.good() ? accepted_ : refused_);
    note(client, verdict.good() ? "accepted" : "refused", packet, verdict);
    if (verdict.good()) return;
    Reply reply{request.number, verdict.code, verdict.why};
    finish(client, reply);
}

std::size_t BrowserService::answer_for_nobody(void* self, std::string_view packet, std::span<char> into) {
    auto& service = *static_cast<BrowserService*>(self);
    service.for_nobody_ = into;
    Request request;
    Client nobody;
    const bool good = browsing::parse_request(packet, request).empty() &&
                      request.verb->role == Role::observer && service.answer(nobody, request).good();
    return good ? into.size() - service.for_nobody_.size() : 0;
}

BrowserService::Verdict BrowserService::finish(Client& client, Reply& reply) noexcept {
    const std::string_view text = reply.finish();
    if (for_nobody_.data() == nullptr)
        connections_.send(client, text);
    else
        for_nobody_ = for_nobody_.subspan(text.copy(for_nobody_.data(), for_nobody_.size()));
    return {};
}

BrowserService::Verdict BrowserService::check_role(const Client& client, std::string_view what, Role least) {
    if (client.rights.role >= least) return {};
    return {Refusal::denied,
            Sentence{"\"", what, "\" needs the role of an ", to_text(least), ", you are an ",
                     to_text(client.rights.role), "; ask for it in the board's list of roles"}};
}

BrowserService::Verdict BrowserService::check_facet(const Client& client, std::string_view name,
                                                    const Facet& facet) {
    if (Verdict role = check_role(client, name, facet.least_role); !role.good()) return role;
    return {Refusal::denied, check_origin(name, facet.for_people, facet.motion, client.rights.origin)};
}

BrowserService::Verdict BrowserService::answer(Client& client, const Request& request) {
#define TAPPET_X(name, ...) &BrowserService::serve_##name,
    constexpr std::array<Serve BrowserService::*, browsing::verbs.size()> serve{TAPPET_REQUESTS(TAPPET_X)};
#undef TAPPET_X
    const auto row = static_cast<std::size_t>(request.verb - browsing::verbs.data());
    return (this->*serve[row])(client, request);
}

/// Prints one line: event, time, user, and the request without characters that a terminal would interpret.
void BrowserService::note(const Client& client, std::string_view what, std::string_view packet,
                          const Verdict& verdict) {
    if (!log) return;
    Sentence line{"browser: ", what};
    if (!verdict.good()) line.add(" (").add(to_text(verdict.code)).add(")");
    line.add(" at ").add(to_ns(now_) / 1000).add(" us, uid ").add(client.peer.user).add(", pid ");
    line.add(static_cast<int>(client.peer.process)).add(", ").add(to_text(client.rights.role));
    if (!client.user.view().empty())
        line.add(" ").add(client.user.view()).add(" from the ").add(to_text(client.rights.origin));
    if (!packet.empty()) line.add(": ");
    for (const char character : packet.substr(0, 240)) {
        const bool shown =
            static_cast<unsigned char>(character) >= 0x20 && static_cast<unsigned char>(character) < 0x7f;
        line.add(shown ? std::string_view{&character, 1} : std::string_view{character == '\n' ? "" : "?"});
    }
    os::print(line.add("\n").view());
}

// Logs that an accepted request is not done. The line of the request names the client.
void BrowserService::note_end(const Pending& place, std::string_view how,
                              std::string_view why) const noexcept {
    if (!log.get() || place.is_told) return;
    os::print(Sentence{"browser: not done (", how, ") at ", to_ns(now_) / 1000, " us, request ",
                       place.asker.number, ", ", to_text(place.asker.role),
                       place.asker.user.view().empty() ? "" : " ", place.asker.user.view(), ": ", why, "\n"}
                  .view());
}

} // namespace tappet
