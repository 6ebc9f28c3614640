// Commands that change the machine: the browser checks names; the machine checks the rest, and may refuse.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/value.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>

namespace tappet::browser {

namespace {

using nlohmann::ordered_json;

/// Returns "[1.5, 2]" as the machine wrote it, without the quotes of a plain text.
std::string plain(const ordered_json& value) { return value.dump(); }

} // namespace

Result<void> told(const Work& work, const Result<ordered_json>& reply, const std::string& sentence) {
    if (!reply) return std::unexpected(reply.error());
    work.out << (work.line.json ? packet_text(work, *reply) : sentence) << "\n";
    return {};
}

Result<void> run_set(Work& work) {
    const auto arguments = work.arguments();
    if (arguments.size() % 2 != 0)
        return wrong("set takes pairs of a property and its value; '" + arguments.back() + "' has no value");
    for (std::size_t i = 0; i < arguments.size(); i += 2)
        if (const auto found = find_facet(work.session.map(), Takes::property, arguments[i]); !found)
            return std::unexpected(found.error());
    const auto reply = work.session.link().request(request_of(work));
    std::string sentence = "set:";
    for (std::size_t i = 0; i < arguments.size(); i += 2)
        sentence += (i > 0 ? ", " : " ") + arguments[i] + " = " + arguments[i + 1];
    return told(work, reply, sentence);
}

Result<void> run_call(Work& work) {
    if (const auto found = find_facet(work.session.map(), Takes::callable, work.arguments()[0]); !found)
        return std::unexpected(found.error());
    const auto reply = work.session.link().request(request_of(work));
    std::string sentence = work.arguments()[0] + ": done";
    if (reply && reply->contains("result"))
        sentence = work.arguments()[0] + " = " + plain((*reply)["result"]);
    return told(work, reply, sentence);
}

Result<void> run_send(Work& work) {
    if (const auto found = find_facet(work.session.map(), Takes::command, work.arguments()[0]); !found)
        return std::unexpected(found.error());
    Link& link = work.session.link();
    std::uint32_t number = 0;
    const auto reply = link.request(request_of(work), number);
    const std::string& name = work.arguments()[0];
    const auto begun = told(work, reply, name + ": sent");
    if (!begun || !work.line.follow) return begun;
    while (!work.stopped()) {
        auto packet = link.next(std::chrono::milliseconds{100});
        if (!packet) return std::unexpected(packet.error());
        if (!*packet || (*packet)->value("id", std::uint32_t{0}) != number) continue;
        const ordered_json& news = **packet;
        const auto state = news.value("state", std::string{});
        if (work.line.json)
            work.out << packet_text(work, news) << std::endl;
        else
            work.out << name << ": " << state
                     << (news.contains("results") && !news["results"].empty() ? " " + plain(news["results"])
                                                                              : "")
                     << std::endl;
        if (!news.value("final", false)) continue;
        if (state == "done") return {};
        return failure(Fault::failed, "'" + name + "' was not done: the machine says " + state);
    }
    return {};
}

Result<void> run_force(Work& work) {
    const auto arguments = work.arguments();
    if (const auto found = find_facet(work.session.map(), Takes::port, arguments[0]); !found)
        return std::unexpected(found.error());
    return told(work, work.session.link().request(request_of(work)),
                arguments.size() == 2 ? "forced: " + arguments[0] + " = " + arguments[1]
                                      : "released: " + arguments[0]);
}

Result<void> run_plain_request(Work& work) {
    const auto arguments = work.arguments();
    const Takes takes = find_command(work.line.words.front())->takes;
    if (!arguments.empty() && takes != Takes::nothing) {
        const std::vector<std::string> names = names_for(work.session.map(), takes);
        if (std::ranges::find(names, arguments[0]) == names.end()) {
            const std::string nearest = MapReader::nearest_of(arguments[0], names);
            return wrong("there is nothing '" + arguments[0] + "' to " + work.line.words.front() +
                         (nearest.empty() ? "; list shows the components" : nearest));
        }
    }
    const auto reply = work.session.link().request(request_of(work));
    std::string sentence = work.line.words.front() + ": done";
    ordered_json answer = reply.value_or(ordered_json::object());
    for (const char* const of_all : {"id", "ok", "dropped"}) answer.erase(of_all);
    if (!answer.empty()) sentence = work.line.words.front() + ": " + answer.dump();
    if (answer.contains("files")) sentence = "saved: " + plain(answer["files"]) + " files";
    return told(work, reply, sentence);
}

} // namespace tappet::browser
