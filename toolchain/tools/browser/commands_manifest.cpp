// The table of a running machine: with its effective values, derived priorities and all its rows.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/reading_text.hpp"

#include <algorithm>
#include <ostream>

namespace tappet::browser {

namespace {

using map::none;

/// One row of a section: fields in their order, as JSON or as words.
class Row {
public:
    Row(Work& work, std::string_view section) : work_{work} {
        work_.out << (json() ? "{\"section\": " + in_quotes(section) : std::string(3, ' '));
    }
    Row(const Row&) = delete;
    Row& operator=(const Row&) = delete;
    ~Row() { work_.out << (json() ? "}\n" : "\n"); }

    /// `words`: the form for people; empty when there is nothing to print.
    Row& add(std::string_view key, std::string_view value, const std::string& words) {
        if (json())
            work_.out << ", " << in_quotes(key) << ": " << in_quotes(value);
        else if (!value.empty())
            work_.out << words;
        return *this;
    }
    Row& add(std::string_view key, std::string_view value) {
        return add(key, value, " " + std::string{value});
    }
    Row& number(std::string_view key, std::int64_t value, const std::string& words) {
        if (json())
            work_.out << ", " << in_quotes(key) << ": " << value;
        else if (value != 0)
            work_.out << words;
        return *this;
    }
    Row& raw(std::string_view key, const std::string& value, const std::string& words) {
        work_.out << (json() ? ", " + in_quotes(key) + ": " + value : words);
        return *this;
    }

private:
    [[nodiscard]] bool json() const { return work_.line.json; }
    Work& work_;
};

class Manifest {
public:
    explicit Manifest(Work& work) : work_{work}, map_{work.session.map()} {}

    void tell() {
        machine();
        section("components", map_.components().size());
        for (std::uint32_t c = 0; c < map_.components().size(); ++c) component(c);
        section("activities", map_.activities().size());
        for (std::uint32_t a = 0; a < map_.activities().size(); ++a) activity(a);
        section("connections", map_.connections().size());
        for (const map::Connection& each : map_.connections()) connection(each);
        section("reactions", map_.reactions().size());
        for (const map::Reaction& each : map_.reactions()) reaction(each);
        section("behaviours", map_.behaviours().size());
        for (const map::Behaviour& each : map_.behaviours()) behaviour(each);
    }

private:
    void section(std::string_view name, std::size_t rows) {
        if (!work_.line.json) work_.out << name << ": " << rows << "\n";
    }
    void machine() {
        const map::Header& header = map_.header();
        std::string_view build{header.build_id.data(), header.build_id.size()};
        build = build.substr(0, build.find('\0'));
        if (!work_.line.json)
            work_.out << "machine " << map_.text(header.machine) << " on board " << map_.text(header.board)
                      << " (" << map_.text(header.world) << "), build "
                      << (build.empty() ? "without an id" : build) << "\n";
        else
            Row{work_, "machine"}
                .add("name", map_.text(header.machine))
                .add("board", map_.text(header.board))
                .add("world", map_.text(header.world))
                .add("build_id", build);
    }
    void component(std::uint32_t index) {
        const map::Component& each = map_.components()[index];
        Row{work_, "component"}
            .add("name", map_.text(each.name))
            .add("type", user_name(map_.text(each.type)))
            .add("device", map_.text(each.device), ", device " + std::string{map_.text(each.device)});
        for (std::uint32_t f = each.first_facet; f < each.first_facet + each.facet_count; ++f) {
            const map::Facet& facet = map_.facets()[f];
            if (map_.text(facet.kind) != "property" || facet.value_at == 0) continue;
            const Reading reading = work_.session.observer().read(f);
            const std::string_view unit = map_.text(facet.unit);
            const bool bears_unit = map_.types()[facet.type].shape == map::Shape::duration;
            Row{work_, "property"}
                .add("name", map_.full_name(f), "    " + std::string{map_.text(facet.name)})
                .raw("value", value_of(map_, reading, Style::json),
                     " = " + value_of(map_, reading, Style::brief) +
                         (bears_unit || unit.empty() ? "" : " " + std::string{unit}))
                .add("unit", unit, "");
        }
    }
    void activity(std::uint32_t index) {
        const map::Activity& each = map_.activities()[index];
        std::vector<const map::Component*> runs;
        for (const map::Component& component : map_.components())
            if (component.activity == index) runs.push_back(&component);
        std::ranges::sort(runs, {}, &map::Component::position);
        std::string names;
        for (const map::Component* component : runs)
            names += (names.empty() ? "" : " ") + std::string{map_.text(component->name)};
        const bool real_time = each.real_time != 0;
        Row{work_, "activity"}
            .add("name", map_.text(each.name))
            .add("trigger", map_.text(each.trigger))
            .number("period_ns", each.period_ns, " " + duration_text(each.period_ns))
            .number("at_most", each.period_ns == 0 ? each.at_most_n : 0,
                    ", at most " + std::to_string(each.at_most_n) + " in " +
                        duration_text(each.at_most_per_ns))
            .number("at_most_per_ns", each.at_most_per_ns, "")
            .number("deadline_ns", real_time ? each.deadline_ns : 0,
                    ", deadline " + duration_text(each.deadline_ns))
            .number("budget_ns", real_time ? each.budget_ns : 0, ", budget " + duration_text(each.budget_ns))
            .number("priority", real_time ? each.priority : 0, ", priority " + std::to_string(each.priority))
            .raw("processor", std::to_string(each.processor), ", processor " + std::to_string(each.processor))
            .raw("real_time", real_time ? "true" : "false", real_time ? "" : ", not real-time")
            .add("runs", names, ", runs " + names);
    }
    [[nodiscard]] std::string name_of(std::uint32_t facet) const {
        return facet == none ? std::string{} : map_.full_name(facet);
    }
    [[nodiscard]] std::string component_of(const map::Behaviour& behaviour) const {
        return behaviour.component == none
                   ? std::string{}
                   : std::string{map_.text(map_.components()[behaviour.component].name)};
    }
    void connection(const map::Connection& each) {
        const auto flag = [&](map::ConnectionFlag which) { return (each.flags & which) != 0; };
        Row{work_, "connection"}
            .add("from", name_of(each.from))
            .add("to", name_of(each.to), " -> " + name_of(each.to))
            .number("stale_after_ns", each.max_age_ns, ", stale after " + duration_text(each.max_age_ns))
            .add("when_stale", each.max_age_ns > 0 ? map_.text(each.when_stale) : "",
                 ": " + std::string{map_.text(each.when_stale)})
            .number("buffer", flag(map::connection_buffered) ? each.capacity : 0,
                    ", buffer of " + std::to_string(each.capacity))
            .raw("wakes", flag(map::connection_wakes) ? "true" : "false",
                 flag(map::connection_wakes) ? ", wakes" : "")
            .raw("delayed", flag(map::connection_delayed) ? "true" : "false",
                 flag(map::connection_delayed) ? ", delayed" : "");
    }
    void reaction(const map::Reaction& each) {
        const std::string how{map_.text(each.how)};
        const std::string to = each.behaviour == none || each.to != none
                                   ? name_of(each.to)
                                   : component_of(map_.behaviours()[each.behaviour]);
        Row{work_, "reaction"}
            .add("from", name_of(each.from))
            .add("how", how, ", " + how)
            .add("to", to, " " + to)
            .number("quota", each.quota, ", quota " + std::to_string(each.quota));
    }
    void behaviour(const map::Behaviour& each) {
        const std::string component = component_of(each);
        Row{work_, "behaviour"}
            .add("of", component)
            .raw("slot", each.is_slot != 0 ? "true" : "false", each.is_slot != 0 ? ", a slot" : "")
            .number("bytes", static_cast<std::int64_t>(each.bytes),
                    " of " + std::to_string(each.bytes) + " bytes")
            .number("states", each.states, ", " + std::to_string(each.states) + " states");
    }

    Work& work_;
    const MapReader& map_;
};

} // namespace

Result<void> run_manifest(Work& work) {
    Manifest{work}.tell();
    return {};
}

} // namespace tappet::browser
