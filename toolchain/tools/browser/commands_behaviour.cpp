// Behaviours: shows, watches and commands them, and loads scripts into a slot of the running machine.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/value.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <ostream>

namespace tappet::browser {

namespace {

using nlohmann::ordered_json;

// A quoted piece of a script must fit into one packet: each character may need an escape.
constexpr std::size_t piece_characters = (browsing::max_packet_bytes - 256) / 2;

std::string text_of(const ordered_json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) return {};
    return found->is_string() ? found->get<std::string>() : found->dump();
}

void print_behaviour(std::ostream& out, const std::string& place, const ordered_json& each) {
    out << place << text_of(each, "name") << ": " << text_of(each, "status");
    if (const std::string state = text_of(each, "state"); !state.empty()) out << ", in " << state;
    if (const std::string line = text_of(each, "line"); !line.empty()) out << ", line " << line;
    if (const std::string reason = text_of(each, "reason"); !reason.empty()) out << " (" << reason << ")";
    if (const std::string fault = text_of(each, "fault"); !fault.empty()) out << ": " << fault;
    out << "\n";
    if (const auto variables = each.find("variables"); variables != each.end())
        for (const auto& [name, value] : variables->items())
            out << "    " << name << " = " << value.dump() << "\n";
}

void print_slot(std::ostream& out, const std::string& place, const ordered_json& each) {
    out << "slot of " << place << text_of(each, "slot") << ": " << text_of(each, "phase");
    if (const std::string script = text_of(each, "script"); !script.empty()) out << ", " << script;
    if (const std::string news = text_of(each, "news"); !news.empty()) out << "; " << news;
    out << "\n";
}

/// Returns the machine's own form of the name, as a word of a request.
std::string own_word(const Work& work, std::string_view name) {
    return as_word(work.session.map().own_name(name));
}

Result<ordered_json> ask(Work& work, std::string_view name) {
    return work.session.link().request("behaviours" + (name.empty() ? "" : " " + own_word(work, name)));
}

Result<void> show(Work& work, std::string_view name) {
    auto reply = ask(work, name);
    if (!reply) return std::unexpected(reply.error());
    if (work.line.json) {
        work.out << packet_text(work, std::move(*reply)) << std::endl;
        return {};
    }
    for (const ordered_json& each : (*reply)["behaviours"]) print_behaviour(work.out, work.place(), each);
    for (const ordered_json& each : (*reply)["slots"]) print_slot(work.out, work.place(), each);
    work.out.flush();
    return {};
}

Result<void> watch(Work& work, std::string_view name) {
    for (long shown = 0; !work.stopped() && (work.line.count == 0 || shown < work.line.count); ++shown) {
        if (shown != 0) work.pause(work.line.every);
        if (const auto done = show(work, name); !done) return done;
    }
    return {};
}

Result<void> asked(Work& work, const std::string& line, const std::string& sentence) {
    return told(work, work.session.link().request(line), sentence);
}

Result<void> load(Work& work, const std::string& file, const std::string& slot) {
    const auto read = work.files.read(file);
    if (!read || read->empty()) return wrong("'" + file + "' cannot be read, or is empty; name a script");
    const std::string& text = *read;
    for (std::size_t at = 0; at < text.size(); at += piece_characters) {
        const auto sent =
            work.session.link().request("script " + own_word(work, slot) + " " + std::to_string(at) + " " +
                                        quoted_word(std::string_view{text}.substr(at, piece_characters)));
        if (!sent) return std::unexpected(sent.error());
    }
    const std::string name = std::filesystem::path{file}.filename().string();
    const std::string moment = work.line.at.empty() ? "now" : work.line.at;
    return asked(work, "load " + own_word(work, slot) + " " + as_word(name) + " " + as_word(moment),
                 name + ": compiled; it takes over " + (moment == "now" ? "now" : "at " + moment));
}

void print_way(std::ostream& out, const ordered_json& way) {
    const std::string answer = text_of(way, "answer"), event = text_of(way, "event");
    std::string reason = text_of(way, "because");
    if (const std::string detail = text_of(way, "detail"); !detail.empty()) reason += ": " + detail;
    out << "    " << text_of(way, "from") << " -> " << text_of(way, "to");
    if (const std::string taken = text_of(way, "reason"); !taken.empty()) out << " (" << taken << ")";
    out << (event.empty() ? ":" : " awaits " + event);
    const std::string_view link = event.empty() ? " " : ", and ";
    if (answer == "open")
        out << (event.empty() ? " its condition holds, it is taken in the next step" : "");
    else if (answer == "guard")
        out << link << (event.empty() ? "its condition does not hold" : "its guard says no")
            << (reason.empty() ? "" : ": " + reason);
    else if (answer == "precondition")
        out << link << "the precondition of " << text_of(way, "state") << " says no"
            << (reason.empty() ? "" : ": " + reason);
    else if (answer == "too_early")
        out << " in " << moment_text(way.value("left_ns", std::int64_t{0}));
    else if (answer == "arguments")
        out << ", whose arguments its guard is asked with";
    else if (answer == "failed")
        out << link << "its guard fails";
    else
        out << link << "the machine's state changed meanwhile: ask again";
    out << "\n";
}

} // namespace

Result<void> run_why(Work& work) {
    auto reply = work.session.link().request("why " + own_word(work, work.arguments()[0]));
    if (!reply) return std::unexpected(reply.error());
    if (work.line.json) {
        work.out << packet_text(work, std::move(*reply)) << "\n";
        return {};
    }
    const auto path = (*reply)["path"];
    const std::string state = text_of(*reply, "state"), wanted = text_of(*reply, "wanted");
    work.out << text_of(*reply, "name") << " is " << text_of(*reply, "status");
    if (!state.empty()) work.out << ", in " << state;
    if (path.empty()) {
        work.out << "; no transition leads from here to " << wanted;
        if ((*reply)["is_final"] == true)
            work.out << ", behaviour stop " << text_of(*reply, "name") << " asks for it";
        work.out << "\n";
    } else if (path.size() == 1) {
        work.out << ": that is " << wanted << "\n";
    } else {
        work.out << "; the way to " << wanted << ": ";
        for (std::size_t i = 0; i < path.size(); ++i)
            work.out << (i == 0 ? "" : " -> ") << path[i].get<std::string>();
        work.out << "\n";
    }
    for (const ordered_json& way : (*reply)["ways"]) print_way(work.out, way);
    return {};
}

Result<void> run_behaviour(Work& work) {
    const auto words = work.arguments();
    const std::string action = words.empty() ? "list" : words[0];
    const std::size_t given = words.empty() ? 0 : words.size() - 1;
    const auto needs = [&](std::size_t fewest, std::size_t most) { return given >= fewest && given <= most; };
    if (action == "list" && needs(0, 1)) return show(work, given == 0 ? std::string_view{} : words[1]);
    if (action == "watch" && needs(0, 1)) return watch(work, given == 0 ? std::string_view{} : words[1]);
    if (action == "load" && needs(2, 2)) return load(work, words[1], words[2]);
    if (action == "unload" && needs(1, 1))
        return asked(work, "unload " + own_word(work, words[1]), words[1] + ": the slot is emptied");
    if (action == "rollback" && needs(1, 1))
        return asked(work, "roll_back " + own_word(work, words[1]),
                     words[1] + ": the earlier behaviour comes back");
    const std::vector<std::string> actions{"start",      "stop",     "pause",  "step",  "reset",
                                           "deactivate", "reactive", "list",   "watch", "load",
                                           "unload",     "rollback", "request"};
    const auto known = std::ranges::find(actions, action);
    if (known < std::ranges::find(actions, "list") && needs(1, 1))
        return asked(work, "behave " + action + " " + own_word(work, words[1]),
                     words[1] + ": " + action + " done");
    if (action == "request" && needs(2, 2))
        return asked(work, "behave request " + own_word(work, words[1]) + " " + as_word(words[2]),
                     words[1] + ": goes to " + words[2]);
    if (known == actions.end())
        if (const std::string nearest = MapReader::nearest_of(action, actions); !nearest.empty())
            return wrong("there is no 'behaviour " + action + "'" + nearest);
    return wrong("'behaviour " + action +
                 "' has the wrong arguments; usage: " + std::string{find_command("behaviour")->usage});
}

} // namespace tappet::browser
