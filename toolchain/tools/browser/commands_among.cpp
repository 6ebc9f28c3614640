// Several machines side by side: which of them a line is about, and which are there (thesis 4.8).
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/reading_text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>
#include <thread>

namespace tappet::browser {

namespace {

using nlohmann::ordered_json;

/// A node known to the wire's component of a machine.
struct Heard {
    std::string node{};
    bool is_there = false;
};

/// Reads the facets "NODE.is_there" of the component that a system adds to each of its machines.
std::vector<Heard> heard_by(const Session& session) {
    constexpr std::string_view link = "systems::Link<", facet_end = ".is_there";
    const MapReader& map = session.map();
    std::vector<Heard> heard;
    for (std::uint32_t i = 0; i < map.facets().size(); ++i) {
        const map::Facet& facet = map.facets()[i];
        const std::string_view name = map.text(facet.name);
        if (!user_name(map.text(map.components()[facet.component].type)).starts_with(link)) continue;
        if (!name.ends_with(facet_end) || facet.value_at == 0) continue;
        const bool is_there = value_of(map, session.observer().read(i), Style::json) == "true";
        heard.push_back({std::string{name.substr(0, name.size() - facet_end.size())}, is_there});
    }
    return heard;
}

/// Returns the machine's message about a row of the system that differs at another node; empty: none.
std::string refused_by(const Session& session) {
    const MapReader& map = session.map();
    for (std::uint32_t i = 0; i < map.facets().size(); ++i) {
        const map::Facet& facet = map.facets()[i];
        if (map.text(facet.name) == "refused" &&
            user_name(map.text(map.components()[facet.component].type)).starts_with("systems::Link<")) {
            const auto text =
                ordered_json::parse(value_of(map, session.observer().read(i), Style::json), nullptr, false);
            return text.is_string() ? text.get<std::string>() : std::string{};
        }
    }
    return {};
}

/// Returns nodes of the systems without a socket here, each with the nodes that hear it.
std::vector<std::pair<std::string, std::string>> elsewhere(Machines& machines) {
    std::vector<std::pair<std::string, std::string>> nodes;
    for (const Machine& each : machines.all()) {
        if (each.session == nullptr) continue;
        for (const Heard& heard : heard_by(*each.session)) {
            if (machines.named(heard.node) != nullptr) continue;
            auto known = std::ranges::find(nodes, heard.node, &std::pair<std::string, std::string>::first);
            if (known == nodes.end()) known = nodes.insert(nodes.end(), {heard.node, ""});
            if (heard.is_there) known->second += (known->second.empty() ? "" : ", ") + each.name;
        }
    }
    return nodes;
}

/// Returns why the word begins with no machine, and the name probably meant.
std::unexpected<Failure> not_named(Machines& machines, const std::string& word) {
    static_cast<void>(machines.reachable());
    std::vector<std::string> with_it, names;
    for (const Machine& each : machines.all()) {
        names.push_back(each.name);
        if (each.session == nullptr) continue;
        const MapReader& map = each.session->map();
        if (map.find(map.place() + word) || map.find_component(map.place() + word))
            with_it.push_back(map.place() + word);
    }
    const std::string quoted = "'" + word + "'";
    if (!with_it.empty()) {
        std::string all;
        for (const std::string& each : with_it) all += (all.empty() ? "" : " or ") + each;
        return wrong(quoted + " does not say of which machine: write " + all);
    }
    const std::string first = word.substr(0, word.find('.'));
    for (const auto& [node, hearers] : elsewhere(machines))
        if (node == first)
            return failure(
                Fault::no_machine,
                "'" + node + "' is a node of this system, and has no socket " + machines.place() +
                    "; it is " +
                    (hearers.empty() ? "not heard on the wire" : "on another box, and heard by " + hearers));
    const std::string nearest = MapReader::nearest_of(first, names);
    return wrong("there is no machine '" + first + "' " + machines.place() +
                 (nearest.empty() ? "; there are " + machines.names() : nearest));
}

/// Returns the part for each machine, in the order of the words; or why a word belongs to none.
std::expected<std::vector<std::pair<Machine*, Part>>, Failure>
parts_of_words(Machines& machines, const Command& command, std::span<const std::string> arguments) {
    std::vector<std::pair<Machine*, Part>> parts;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (!is_name(command, arguments, i)) continue;
        Machine* const machine = machines.named(arguments[i]);
        if (machine == nullptr) return not_named(machines, arguments[i]);
        if (machine->name == arguments[i])
            return wrong("'" + arguments[i] + "' is a machine; name what is meant in it, as in " +
                         arguments[i] + ".component; list " + arguments[i] + " shows what it has");
        auto known = std::ranges::find(parts, machine, &std::pair<Machine*, Part>::first);
        if (known == parts.end()) known = parts.insert(parts.end(), {machine, {}});
        known->second.names.push_back(arguments[i]);
    }
    return parts;
}

struct AtMachines : Means {
    Machines& machines;
    const Line& line;
    std::vector<Failure> failures{};

    void run();
    void list();
    void fail(const auto& none) { failures.push_back(none.error()); }
    void at(Machine& machine, const Line& asked) {
        const auto session = machines.reach(machine);
        if (!session) return fail(session);
        Work work{*this, **session, asked};
        if (auto done = run_command(work); !done)
            failures.push_back({done.error().fault, machine.name + ": " + done.error().sentence});
    }
    /// The only machine needs no name, but accepts one, as the system's table spells it.
    void at_only() {
        Machine& machine = machines.all().front();
        const MapReader& map = machine.session->map();
        Line own = line;
        const Command& command = *find_command(line.words.front());
        const std::span arguments = std::span{line.words}.subspan(1);
        for (std::size_t i = 0; i < arguments.size(); ++i) {
            if (!is_name(command, arguments, i) || map.find(arguments[i])) continue;
            if (!arguments[i].starts_with(machine.name + ".")) continue;
            const std::string rest = arguments[i].substr(machine.name.size() + 1);
            // A component may have the machine's name.
            if (map.find_component(rest.substr(0, rest.find('.')))) own.words[i + 1] = rest;
        }
        Work work{*this, *machine.session, own};
        if (auto done = run_command(work); !done) fail(done);
    }
    void at_each() {
        for (Machine& each : machines.all()) {
            if (line.json)
                out << "{\"machine\": " << in_quotes(each.name) << "}\n";
            else
                out << each.name << ":\n";
            at(each, line);
        }
    }
    void at_parts(std::vector<std::pair<Machine*, Part>>& wanted) {
        std::vector<Part> parts;
        for (auto& [machine, part] : wanted) {
            const auto session = machines.reach(*machine);
            if (!session) fail(session);
            if (session) parts.push_back({*session, std::move(part.names)});
        }
        if (parts.empty()) return;
        Work work{*this, *parts.front().session, line, parts};
        if (auto done = run_command(work); !done) fail(done);
    }
};

/// A machine's status, as list prints it.
struct Told {
    ordered_json behaviours{};
    std::vector<Heard> heard{};
    std::string refused{};
    std::uint32_t forced = 0;
};

Result<Told> look_at(Session& session) {
    auto reply = session.link().request("behaviours");
    if (!reply) return std::unexpected(reply.error());
    return Told{reply->value("behaviours", ordered_json::array()), heard_by(session), refused_by(session),
                session.observer().forced()};
}

std::string json_of(const Session& session, const Machine& machine, const Told& told) {
    const map::Header& header = session.map().header();
    ordered_json all{{"machine", machine.name},         {"board", session.map().text(header.board)},
                     {"process", header.process},       {"role", session.role()},
                     {"forced", told.forced},           {"behaviours", told.behaviours},
                     {"hears", ordered_json::object()}, {"refused", told.refused}};
    for (const Heard& each : told.heard) all["hears"][each.node] = each.is_there;
    return all.dump();
}

std::string line_of(const Session& session, const Told& told) {
    const map::Header& header = session.map().header();
    std::string line =
        "on " + std::string{session.map().text(header.board)} + ", process " + std::to_string(header.process);
    for (const ordered_json& each : told.behaviours) {
        const auto state = each.value("state", std::string{});
        line += "; " + each.value("name", std::string{}) + " " +
                (state.empty() ? each.value("status", std::string{}) : "in " + state);
    }
    if (told.forced > 0) line += "; " + std::to_string(told.forced) + " FORCED";
    for (const bool is_there : {true, false}) {
        std::string nodes;
        for (const Heard& each : told.heard)
            if (each.is_there == is_there) nodes += (nodes.empty() ? " " : ", ") + each.node;
        if (!nodes.empty()) line += (is_there ? "; hears" : "; does NOT hear") + nodes;
    }
    return line + (told.refused.empty() ? "" : "; refuses " + told.refused);
}

/// Runs list with several machines: which are there, and the status of each.
void AtMachines::list() {
    std::size_t width = 0;
    for (const Machine& each : machines.all()) width = std::max(width, each.name.size());
    const auto named = [&](const std::string& name) -> std::ostream& {
        return out << name << std::string(std::max(width, name.size()) - name.size() + 2, ' ');
    };
    for (Machine& each : machines.all()) {
        const auto session = machines.reach(each);
        auto told = session ? look_at(**session) : std::unexpected(session.error());
        if (told && line.json) {
            out << json_of(**session, each, *told) << "\n";
        } else if (told) {
            named(each.name) << line_of(**session, *told) << "\n";
        } else {
            if (session) told.error().sentence = "'" + each.name + "': " + told.error().sentence;
            if (line.json)
                out << "{\"machine\": " << in_quotes(each.name)
                    << ", \"error\": " << in_quotes(told.error().sentence) << "}\n";
            else
                named(each.name) << "does not answer\n";
            fail(told);
        }
    }
    for (const auto& [node, hearers] : elsewhere(machines))
        if (line.json)
            out << "{\"machine\": " << in_quotes(node) << ", \"heard_by\": " << in_quotes(hearers) << "}\n";
        else
            named(node) << "has no socket " << machines.place()
                        << (hearers.empty() ? "; nobody hears it" : "; heard by " + hearers) << "\n";
}

void AtMachines::run() {
    const Command* const command = find_command(line.words.front());
    if (command == nullptr) return fail(wrong(unknown_command(line.words.front())));
    if (auto fits = check_options(command, line); !fits) return fail(fits);
    if (!machines.are_several()) return at_only();
    const std::span arguments = std::span{line.words}.subspan(1);
    if (arguments.empty() && command->name == "list") return list();
    if (arguments.empty() && command->among == Among::each) return at_each();
    const auto given_first = arguments.empty()
                                 ? machines.all().end()
                                 : std::ranges::find(machines.all(), arguments[0], &Machine::name);
    if (given_first != machines.all().end() && command->among != Among::values) {
        Line of_it = line;
        of_it.words.erase(of_it.words.begin() + 1);
        return at(*given_first, of_it);
    }
    auto parts = parts_of_words(machines, *command, arguments);
    if (!parts) return fail(parts);
    if (command->among == Among::values && !parts->empty()) return at_parts(*parts);
    if (parts->size() > 1)
        return fail(wrong("'" + std::string{command->name} + "' takes names of one machine; these are of " +
                          (*parts)[0].first->name + " and " + (*parts)[1].first->name));
    if (parts->empty())
        return fail(wrong("name one machine, as in '" + std::string{command->name} + " " +
                          machines.all().front().name + "'; there are " + machines.names()));
    at(*parts->front().first, line);
}

} // namespace

void Means::pause(std::chrono::milliseconds time) const {
    using Steady = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds between_looks{20};
    const auto until = Steady::now() + time;
    while (!stopped() && Steady::now() < until)
        std::this_thread::sleep_for(std::min<Steady::duration>(until - Steady::now(), between_looks));
}

std::vector<Failure> list_machines(Machines& machines, const Line& line, const Means& means) {
    AtMachines among{means, machines, line};
    among.list();
    return among.failures;
}

std::vector<Failure> run_among(Machines& machines, const Line& line, const Means& means) {
    AtMachines among{means, machines, line};
    among.run();
    return among.failures;
}

} // namespace tappet::browser
