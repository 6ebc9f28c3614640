// Requests to a machine and their answers, one log entry each.
#include "toolchain/tools/gateway/carriage.hpp"

#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/message.hpp"

#include "kernel/services/browsing/protocol.hpp"

#include <nlohmann/json.hpp>

namespace tappet::network {

namespace {

using nlohmann::json;

/// The number of the first request; clients' ids end at half of the numbers.
constexpr std::uint32_t introduction = 4'294'967'295;

std::string_view first_word(std::string_view line) {
    std::string_view word;
    static_cast<void>(browsing::detail::take_word(line, word));
    return word;
}

std::string text_of(const json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

bool is_true(const json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_boolean() && found->get<bool>();
}

} // namespace

Carriage::~Carriage() {
    while (!pending_.empty()) finish(pending_.begin(), "unknown: the client left before the answer");
}

void Carriage::finish(std::map<std::uint32_t, Pending>::iterator pending, std::string_view outcome) {
    if (pending->second.logged != 0)
        hub_.audit().answered(pending->second.logged, outcome,
                              hub_.values_of(machine_, pending->second.line));
    pending_.erase(pending);
}

bool Carriage::is_idle(Clock::time_point now) const {
    return pending_.empty() && now - used_ > bounds.relay_idle;
}

void Carriage::fail(std::string_view code, const std::string& sentence) {
    waiting_.clear();
    while (!pending_.empty()) {
        const auto first = pending_.begin();
        const std::uint32_t id = first->first;
        if (first->second.replied)
            send_("{\"id\": " + std::to_string(id) +
                  ", \"packet\": {\"final\": true, \"error\": " + json(as_utf8(sentence)).dump() + "}}");
        else
            send_(refusal_text(id, code, sentence));
        // Before it was admitted, nothing was sent.
        finish(first, (admitted_ ? "unknown: " : "refused: ") + sentence);
    }
}

void Carriage::request(std::uint32_t id, const std::string& line, Clock::time_point now) {
    used_ = now;
    const std::string_view verb = first_word(line);
    if (verb == "map" || verb == "as")
        return send_(
            refusal_text(id, "unsupported",
                         "\"" + std::string{verb} + "\" is the gateway's own request; use watch or facets"));
    if (line.size() + 12 > browsing::max_packet_bytes)
        return send_(refusal_text(id, "bad_request",
                                  "the request is longer than " +
                                      std::to_string(browsing::max_packet_bytes - 12) +
                                      " bytes; ask for less at a time"));
    const Station* const station = hub_.find(machine_);
    if (ended_) {
        relay_.reset();
        ended_ = admitted_ = false;
    }
    if (relay_ == nullptr) {
        std::string fault;
        if (station != nullptr)
            relay_ = hub_.outside().connect(
                station->socket(), [this](std::string_view packet) { receive(packet); }, fault);
        const std::string name =
            "as " + who_.user + " " + std::string{tappet::to_text(who_.role)} + " network";
        if (relay_ == nullptr || !relay_->send(std::to_string(introduction) + " " + name)) {
            relay_.reset();
            return send_(refusal_text(id, "no_machine",
                                      "'" + machine_ + "' does not answer: " +
                                          (fault.empty() ? "it accepts no request now; try again" : fault)));
        }
    }
    Pending pending{0, line, false, {}};
    if (verb == "subscribe") pending.event = line.substr(verb.size());
    if (who_.role != Role::observer && is_change(line)) {
        pending.logged =
            hub_.audit().asked({who_.user, address_, machine_, line, hub_.values_of(machine_, line)});
        if (pending.logged == 0)
            return send_(
                refusal_text(id, "not_now",
                             "the gateway cannot write its log, so it relays no changes; is its disk full?"));
    }
    ++hub_.counters().requests;
    pending_.emplace(id, std::move(pending));
    if (!admitted_)
        waiting_.push_back(id);
    else
        static_cast<void>(pass_on(id));
}

bool Carriage::pass_on(std::uint32_t id) {
    const auto found = pending_.find(id);
    if (found == pending_.end() || relay_->send(std::to_string(id) + " " + found->second.line)) return true;
    const std::string sentence = "the machine accepts no request now, because others flood it; try again";
    send_(refusal_text(id, "not_now", sentence));
    finish(found, "refused: " + sentence);
    return false;
}

void Carriage::receive(std::string_view packet) {
    used_ = Clock::now();
    if (packet.empty()) {
        ended_ = true;
        return fail("no_machine", "'" + machine_ + "' has ended, or it has closed the connection");
    }
    const json object = json::parse(packet, nullptr, false);
    if (!object.is_object()) return;
    const auto number = object.find("id");
    const auto id = number != object.end() && number->is_number_unsigned() ? number->get<std::uint64_t>() : 0;
    const bool is_reply = object.contains("ok");
    if (id == 0 || (id == introduction && !is_true(object, "ok"))) {
        ended_ = true;
        const std::string error = text_of(object, "error");
        return fail(id == 0 ? "not_now" : "denied",
                    error.empty() ? "the machine refused the connection" : error);
    }
    if (id == introduction) {
        admitted_ = true;
        for (const std::uint32_t each : std::exchange(waiting_, {})) static_cast<void>(pass_on(each));
        return;
    }
    const auto found = pending_.find(static_cast<std::uint32_t>(id));
    if (found == pending_.end()) return;
    while (packet.ends_with('\n') || packet.ends_with('\0')) packet.remove_suffix(1);
    if (!is_reply) {
        send_("{\"id\": " + std::to_string(id) + ", \"packet\": " + as_utf8(packet) + "}");
        if (!is_true(object, "final")) return;
        const bool done = text_of(object, "state") == "done" || text_of(object, "line") == "done";
        const std::string how = text_of(object, "error") + text_of(object, "state");
        return finish(found, done ? "done" : "failed: " + how);
    }
    send_(as_utf8(packet));
    const std::string_view verb = first_word(found->second.line);
    if (!is_true(object, "ok")) return finish(found, "refused: " + text_of(object, "error"));
    found->second.replied = true;
    if (verb == "unsubscribe")
        std::erase_if(pending_, [&](const auto& each) {
            return !each.second.event.empty() && each.second.event == found->second.line.substr(verb.size());
        });
    if (verb != "send" && verb != "execute" && verb != "subscribe") finish(found, "done");
}

} // namespace tappet::network
