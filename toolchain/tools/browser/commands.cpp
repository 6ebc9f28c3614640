// The table of commands, and the check of names before a request to the machine.
#include "toolchain/tools/browser/commands.hpp"

#include "toolchain/tools/browser/value.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace tappet::browser {

// One function per row, in the commands_*.cpp of its topic.
Run run_list, run_get, run_watch, run_tree, run_info, run_manifest, run_reactions, run_forced, run_events,
    run_set, run_call, run_send, run_execute, run_force, run_plain_request, run_behaviour, run_why,
    run_post_mortem, run_scope, run_report;

namespace {

constexpr std::size_t any = browsing::max_words;

/// Makes a request to the machine: sends the typed line, and prints its answer.
constexpr Command plain(std::string_view name, std::string_view spelled, std::size_t fewest, std::size_t most,
                        Takes takes, std::string_view help, std::string_view usage = {}) {
    return {name, usage.empty() ? spelled : usage, help, takes, fewest, most, run_plain_request};
}

#define TAPPET_X(name, role, fewest, most, arguments, answer, ...)                                           \
    __VA_OPT__(plain(#name, #name arguments, fewest, most, Takes::__VA_ARGS__), )
constexpr auto requests = std::to_array<Command>({TAPPET_REQUESTS(TAPPET_X)});
#undef TAPPET_X

/// Makes a request whose answer a function of its own prints.
constexpr Command asks(std::string_view name, Run* run, Names names = Names::first) {
    Command command = *std::ranges::find(requests, name, &Command::name);
    command.run = run;
    command.names = names;
    return command;
}

// clang-format off
constexpr auto own = std::to_array<Command>({
    {"list",    "list [COMPONENT]",                        "components, or the facets of one with type, unit and meaning", Takes::component, 0, 1, run_list, Among::each},
    {"get",     "get NAME...",                             "values; those of one activity are of one moment; a component's name stands for all of its values", Takes::value, 1, any, run_get, Among::values},
    {"watch",   "watch NAME... [--every TIME] [--count N]", "values repeatedly; on a terminal a view that refreshes, q ends it", Takes::value, 1, any, run_watch, Among::values},
    {"tree",    "tree [COMPONENT]",                        "components, facets and what is connected to them", Takes::component, 0, 1, run_tree, Among::each},
    {"info",    "info [NAME]",                             "the machine and its activities, or everything about one name", Takes::anything, 0, 1, run_info, Among::each},
    {"manifest", "manifest",                               "the machine's table as it is in effect: properties, derived priorities, all rows", Takes::nothing, 0, 0, run_manifest, Among::each},
    {"reactions", "reactions",                             "how long each row took, from the edge or frame that triggered it to the end of its last effect", Takes::nothing, 0, 0, run_reactions, Among::each},
    {"forced",  "forced",                                  "the ports that are forced now", Takes::nothing, 0, 0, run_forced, Among::each},
    {"events",  "events EVENT... [--count N]",             "prints each emission with its arguments", Takes::event, 1, any, run_events, Among::values},
    asks("set", run_set, Names::every_other), asks("call", run_call), asks("send", run_send),
    {"execute", "execute LINE... [--stop]",                "runs a line of the script language to its end: an expression, whose value is printed, or statements such as do, set, wait (operator); --stop: ends the running line", Takes::anything, 0, any, run_execute, Among::one, Names::none},
    asks("force", run_force), asks("release", run_force),
    {"behaviour", "behaviour [list [NAME] | watch [NAME] [--every TIME] [--count N] | start|stop|pause|step|reset|deactivate|reactive NAME | request NAME STATE | load FILE SLOT [--at EVENT|DEGREES] | unload SLOT | rollback SLOT]",
                                                           "state machines and programs: their states and variables, commands to them, scripts into a slot (engineer)", Takes::nothing, 0, 3, run_behaviour, Among::each, Names::behind_action},
    asks("why", run_why),
    {"post-mortem", "post-mortem FILE [COMMAND...] [--to FILE] [--count N]",       "the guardian's black box of a machine that ended unexpectedly: the reason, and where each activity stood; or a reading command, as for a running machine", Takes::nothing, 1, any, run_post_mortem, Among::one, Names::none},
    {"scope", "scope [worst [ACTIVITY] [--count N] | record [--for TIME]] [--to FILE.vcd|FILE.json]",
                                                           "the worst cycles and what ran in and around them; record: everything that runs from now on; as text, and as a file for GTKWave or ui.perfetto.dev", Takes::nothing, 0, 2, run_scope, Among::one, Names::second},
    {"report", "report [list | start FILE.mcap [--for TIME] | stop FILE.mcap | convert FILE.mcap FILE.csv]",
                                                           "the values that the machine's table selects for recording; start: records them into a file, until ^C, stop or TIME; convert: writes such a file as a table", Takes::nothing, 0, 3, run_report, Among::each, Names::none},
});
// clang-format on

/// Adds the plain requests, which need no row above.
std::vector<Command> with_plain_requests() {
    std::vector<Command> all(own.begin(), own.end());
    auto at = std::ranges::find(all, "behaviour", &Command::name) - all.begin();
    for (const Command& each : requests)
        if (std::ranges::find(all, each.name, &Command::name) == all.end())
            all.insert(all.begin() + at++, each);
    return all;
}

std::string_view wanted_of(Takes takes) {
    switch (takes) {
    case Takes::value: return "a facet with a value, nor a component";
    case Takes::property: return "a property";
    case Takes::callable: return "a method or an operation";
    case Takes::command: return "a command";
    case Takes::event: return "an event";
    case Takes::port: return "a data port";
    default: return "a facet";
    }
}

/// Returns the command that the user probably meant.
std::string_view cure_of(std::string_view kind) {
    if (kind == "property") return "; read it with get, write it with set";
    if (kind == "command") return "; send it with send";
    if (kind == "method" || kind == "operation") return "; call it with call";
    if (kind == "event") return "; follow it with events";
    if (kind == "input" || kind == "output") return "; read it with get, hold it with force";
    return "";
}

/// Returns true when the command takes names of such facets.
bool takes_facet(const MapReader& map, Takes takes, const map::Facet& facet) {
    const std::string_view kind = map.text(facet.kind);
    switch (takes) {
    case Takes::value: return facet.value_at != 0;
    case Takes::property: return kind == "property";
    case Takes::callable: return kind == "method" || kind == "operation";
    case Takes::command: return kind == "command";
    case Takes::event: return kind == "event";
    case Takes::port: return (facet.flags & map::facet_can_force) != 0;
    case Takes::anything: return true;
    default: return false;
    }
}

/// Resolves names of facets, and names of components to all their values.
Result<std::vector<std::uint32_t>> find_values(const MapReader& map, std::span<const std::string> names) {
    std::vector<std::uint32_t> facets;
    for (const std::string& name : names) {
        const auto component = map.find_component(name);
        if (!component) {
            const auto facet = find_facet(map, Takes::value, name);
            if (!facet) return std::unexpected(facet.error());
            facets.push_back(facet->index);
            continue;
        }
        const map::Component& record = map.components()[*component];
        for (std::uint32_t i = record.first_facet; i < record.first_facet + record.facet_count; ++i)
            if (map.facets()[i].value_at != 0) facets.push_back(i);
    }
    return facets;
}

} // namespace

std::span<const Command> commands() {
    static const std::vector<Command> all = with_plain_requests();
    return all;
}

const Command* find_command(std::string_view name) {
    const auto found = std::ranges::find(commands(), name, &Command::name);
    return found == commands().end() ? nullptr : &*found;
}

std::string unknown_command(std::string_view name) {
    std::vector<std::string> names;
    for (const Command& each : commands()) names.emplace_back(each.name);
    const std::string nearest = MapReader::nearest_of(name, names);
    return "there is no command '" + std::string{name} + "'" +
           (nearest.empty() ? "; help lists them" : nearest);
}

Result<void> check_options(const Command* command, const Line& line) {
    const auto takes = [](const Command& each, const std::string& option) {
        return each.usage.find("[" + option) != std::string_view::npos;
    };
    for (const std::string& option : line.given) {
        if (std::ranges::find(options(), option, &Option::name)->of_all ||
            (command != nullptr && takes(*command, option)))
            continue;
        std::string sentence = (command == nullptr ? "only a command takes "
                                                   : "'" + std::string{command->name} + "' takes no ") +
                               option + "; ";
        for (const Command& each : commands())
            if (takes(each, option)) sentence += std::string{each.name} + " ";
        return wrong(sentence + "may");
    }
    return {};
}

Result<void> run_command(Work& work) {
    const Command* command = find_command(work.line.words.front());
    if (command == nullptr) return wrong(unknown_command(work.line.words.front()));
    if (auto fits = check_options(command, work.line); !fits) return fits;
    const std::size_t count = work.arguments().size();
    if (count < command->fewest || count > command->most)
        return wrong("'" + std::string{command->name} + "' was given " + std::to_string(count) +
                     " arguments; usage: " + std::string{command->usage});
    return command->run(work);
}

bool is_name(const Command& command, std::span<const std::string> arguments, std::size_t argument) {
    if (command.among == Among::values) return true;
    switch (command.names) {
    case Names::none: return false;
    case Names::first: return argument == 0;
    case Names::second: return argument == 1;
    case Names::every_other: return argument % 2 == 0;
    case Names::behind_action:
        return arguments.size() > argument && argument == (arguments[0] == "load" ? 2u : 1u);
    }
    return false;
}

std::string request_of(const Work& work) {
    const Command& command = *find_command(work.line.words.front());
    std::string text{command.name};
    const auto arguments = work.arguments();
    for (std::size_t i = 0; i < arguments.size(); ++i)
        text += " " + as_word(is_name(command, arguments, i) ? work.session.map().own_name(arguments[i])
                                                             : std::string_view{arguments[i]});
    return text;
}

std::string packet_text(const Work& work, nlohmann::ordered_json packet) {
    packet.erase("id");
    if (!work.place().empty()) packet["machine"] = work.place().substr(0, work.place().size() - 1);
    return packet.dump();
}

Result<FoundFacet> find_facet(const MapReader& map, Takes takes, std::string_view name) {
    const auto found = map.find(name);
    if (found && takes_facet(map, takes, found->record)) return *found;
    const std::string quoted = "'" + std::string{name} + "'";
    if (found) {
        const std::string_view kind = map.text(found->record.kind);
        if (takes == Takes::port)
            return wrong(quoted + " (" + std::string{kind} +
                         ") cannot be forced; data ports can: list shows them");
        return wrong(quoted + " is not " + std::string{wanted_of(takes)} + " but of kind " +
                     std::string{kind} + std::string{cure_of(kind)});
    }
    std::string nearest = MapReader::nearest_of(name, names_for(map, takes));
    if (nearest.empty()) nearest = MapReader::nearest_of(name, names_for(map, Takes::anything));
    return wrong("the machine has no " + quoted + (nearest.empty() ? "; list shows what it has" : nearest));
}

std::vector<std::string> names_for(const MapReader& map, Takes takes) {
    std::vector<std::string> names;
    const bool components = takes == Takes::component || takes == Takes::component_or_activity ||
                            takes == Takes::value || takes == Takes::anything;
    if (components)
        for (const map::Component& each : map.components()) names.push_back(map.named(each.name));
    if (takes == Takes::component_or_activity || takes == Takes::anything)
        for (const map::Activity& each : map.activities()) names.push_back(map.named(each.name));
    for (std::uint32_t i = 0; i < map.facets().size(); ++i)
        if (takes_facet(map, takes, map.facets()[i])) names.push_back(map.full_name(i));
    // A component and its activity often have the same name.
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

Result<std::vector<Seen>> find_seen(const Work& work) {
    std::vector<Seen> all;
    for (const Part& part : work.parts()) {
        auto facets = find_values(part.session->map(), part.names);
        if (!facets) return std::unexpected(facets.error());
        all.push_back({part.session, std::move(*facets)});
    }
    return all;
}

std::string usage() {
    std::string text =
        "tappet-browse: looks into a running machine, and asks it to change.\n\n"
        "  tappet-browse [OPTION...] COMMAND [ARGUMENT...]     one command\n"
        "  tappet-browse [OPTION...]                           a prompt\n"
        "  tappet-browse ADDRESS:PORT [OPTION...] [COMMAND..]  one command, at the machines behind a "
        "gateway; without one: which they are\n\n";
    for (const Command& each : commands()) {
        text += "  " + std::string{each.usage};
        text += text.size() - text.rfind('\n') - 1 < 44
                    ? std::string(44 - (text.size() - text.rfind('\n') - 1), ' ')
                    : "\n" + std::string(44, ' ');
        text += std::string{each.help} + "\n";
    }
    text +=
        "\n"
        "  --socket [NAME=]FILE  socket of a machine, once for each (default: all in the directory)\n"
        "  --directory DIR       where machines have their sockets (/run/tappet)\n"
        "  --json                one JSON object a line\n"
        "  --timeout TIME        how long an answer may take (3s)\n"
        "  --user NAME           behind an ADDRESS: the gateway's user (USER); its password is asked for, or "
        "read "
        "from the file that TAPPET_PASSWORD_FILE names\n"
        "  --ca FILE             behind an ADDRESS: authorities of its certificate (default: the one of the "
        "first "
        "use, in ~/.config/tappet/known_boxes)\n\n"
        "With several machines, list shows them, and names begin with the machine's name, as in "
        "saw.station.number;\n"
        "any command may name a machine first, as in manifest saw. A machine that does not answer is "
        "reported; the others continue.\n\n"
        "Values are written as they are shown: 4ms, 0.25, true, \"text\", [1, 2, 3]; --json shows all "
        "digits.\n"
        "Negative numbers need no quotes; after -- each word is an argument.\n\n"
        "Exit codes: 0 done; 1 refused by the machine; 2 a wrong command line or a name that it does not "
        "have;\n"
        "3 no machine; 4 the command was rejected or failed; 5 no answer in time, or a value always busy.\n";
    return text;
}

std::string help_of(const Command& command) {
    return std::string{command.usage} + "\n    " + std::string{command.help} + "\n";
}

} // namespace tappet::browser
