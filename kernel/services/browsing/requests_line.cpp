// Lines of the script language (thesis 3.3): passes them to the component that executes them, and reports
// their ends.
#include "kernel/services/browsing/browser_service.hpp"

#include "kernel/machine/instance/instance.hpp"

#include <cstring>

namespace tappet {

using browsing::FacetCall;
using browsing::FollowedLine;

FollowedLine BrowserService::find_interpreter_of_lines() noexcept {
    const std::size_t c = find_interpreter(machine_->machine().table);
    if (c == nowhere) return {};
    return {machine_->machine().table.components[c].type->lines, machine_->component(c)};
}

BrowserService::Verdict BrowserService::no_interpreter() noexcept {
    return {Refusal::unsupported,
            Sentence{"this machine executes no lines; add component<CommandInterpreter> to "
                     "its table, or load a script into a slot"}};
}

BrowserService::Verdict BrowserService::serve_execute(Client& client, const Request& request) {
    const FollowedLine line = find_interpreter_of_lines();
    if (line.functions == nullptr) return no_interpreter();
    if (for_nobody_.data() != nullptr)
        return {Refusal::unsupported,
                Sentence{"the machine no longer runs and executes nothing; only read it"}};
    Pending* place = free_place(client.rights.role);
    if (place == nullptr) return no_place();
    std::array<char, browsing::max_packet_bytes> text;
    std::size_t length = 0;
    if (!browsing::unquote(request.arguments[0], [&](char character) { text[length++] = character; }))
        return {Refusal::bad_request,
                Sentence{"the line is not quoted well; it is spelled: ", request.verb->usage}};
    LineRefusal refusal{};
    const Sentence fault =
        line.functions->begin(line.interpreter, {text.data(), length}, client.rights, refusal);
    if (!fault.empty())
        return {refusal == LineRefusal::denied    ? Refusal::denied
                : refusal == LineRefusal::not_now ? Refusal::not_now
                                                  : Refusal::bad_value,
                fault};
    place->work.emplace<FollowedLine>(line);
    Reply reply{request.number, true};
    reply.json().field("state", to_text(CommandState::sent));
    finish(client, reply);
    return await(*place, asker(client, request), &BrowserService::look_at_line);
}

bool BrowserService::look_at_line(Pending& place) {
    place.asker.since = now_; // it may take as long as a line may
    const auto& line = std::get<FollowedLine>(place.work);
    Client* const client = who_waits(place);
    const LineEnd* const end = line.functions->end(line.interpreter);
    if (end == nullptr && client != nullptr) return false;
    if (end != nullptr && client != nullptr) {
        Reply reply{place.asker.number};
        JsonText& json = reply.json();
        json.field("line", to_text(end->state)).field("time_ns", to_ns(now_)).field("final", true);
        if (!end->why.empty()) json.field("error", end->why.view());
        const bool has_value = !end->values.empty() && end->values[0].kind == VariableKind::result;
        if (!has_value && !end->values.empty()) json.key("variables").open('{');
        for (const VariableRow& each : end->values) {
            alignas(value_alignment) std::array<std::byte, FacetCall::max_value_bytes> value{};
            json.key(has_value ? "value" : each.name);
            if (each.type->size <= value.size()) {
                std::memcpy(value.data(), end->data + each.at, each.type->size);
                reply.value(*each.type, value.data());
            } else {
                json.value("too large to be shown");
            }
        }
        if (!has_value && !end->values.empty()) json.close('}');
        finish(*client, reply);
    }
    line.functions->let_go(line.interpreter);
    return true;
}

BrowserService::Verdict BrowserService::serve_break_off(Client& client, const Request& request) {
    const FollowedLine line = find_interpreter_of_lines();
    if (line.functions == nullptr) return no_interpreter();
    switch (line.functions->break_off(line.interpreter, client.rights.role)) {
    case LineRefusal::not_now:
        return {Refusal::not_now, Sentence{"no line is at work; there is nothing to break off"}};
    case LineRefusal::denied:
        return {Refusal::denied, Sentence{"the line at work is of somebody of a higher role than an ",
                                          to_text(client.rights.role), "; ask them to break it off"}};
    default: break;
    }
    Reply reply{request.number, true};
    return finish(client, reply);
}

} // namespace tappet
