// Actions of people on a machine of the swarm: over its own socket they read, set and save properties, force
// ports, send commands and load scripts. The answers and the saved files are judged.
#include "kernel/base/value_text.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "toolchain/machine/swarm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace tappet {

namespace {

constexpr Duration answered_within = BrowserService::patience + 1s; // while the service runs
constexpr Duration told_within = 100ms;                             // an emission, to its watcher
constexpr double most_of_all = std::numeric_limits<double>::max();
constexpr std::array largest{most_of_all, most_of_all, 1e306, 3.4e38}; // for values without a range

std::string text_of(const TypeTag& type, const std::byte* value) {
    std::array<char, 256> text;
    return {text.data(), format_value(type, value, text)};
}

/// Aligned for a value of any type of a property or an argument.
struct alignas(16) ValueBytes {
    std::array<std::byte, 64> bytes{};
    template <class T>
    void put(T value) {
        std::memcpy(bytes.data(), &value, sizeof value);
    }
    /// Stores the low bytes of an integer, in this processor's order.
    void put_whole(std::int64_t value, std::size_t size) { std::memcpy(bytes.data(), &value, size); }
};

} // namespace

void SwarmRun::find_what_people_may() {
    const MachineView& table = of_.machine.table;
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const ComponentType& type = *table.components[c].type;
        if (type.tag == type_id<BrowserService>) service_ = c;
        for (std::size_t f = 0; f < type.facets.size(); ++f) {
            const Facet& facet = type.facets[f];
            const bool asked = facet.kind == FacetKind::command || facet.kind == FacetKind::method ||
                               facet.kind == FacetKind::operation;
            if (asked && facet.least_role <= Role::machine_operator) commands_.push_back({c, f});
            if (facet.kind == FacetKind::input || facet.kind == FacetKind::output)
                readable_.push_back({c, f});
        }
    }
    const auto& rows = of_.machine.plan.subscriptions;
    for (std::size_t s = 0; s < rows.size(); ++s)
        if (rows[s].kind == SubscriberKind::observer) events_.push_back(s);
    browser_.tell_by([this](std::string_view packet) {
        if (const std::string line = field_of(packet, "line"); !line.empty()) {
            lines_.at_work -= std::min(lines_.at_work, 1u);
        }
        if (field_of(packet, "event").empty()) return;
        ++watched_.told;
        watched_.was_told = true;
        watched_.lost = std::strtoull(field_of(packet, "lost").c_str(), nullptr, 10);
    });
}

/// Reads all packets of the browsers, and judges that answers came, and came in time.
void SwarmRun::hear() {
    if (service_ == nowhere) return;
    const std::uint64_t connections = browser_.connections();
    const bool connected = browser_.hear();
    if (anything_goes_)
        for (SwarmBrowser& each : visitors_) static_cast<void>(each.hear());
    if (!connected || connections != browser_.connections()) {
        watched_ = {};
        asked_by_others_until_ = run_.now() + 2 * BrowserService::patience; // by browsers connected before
        if (lines_.was_connected) lines_ = {.left_commands = true, .of_peers = true};
        lines_.was_connected = true;
    }
    if (!connected) return;
    if (connections != browser_.connections()) watch();
    judge_watched();
    const auto* const oldest = browser_.oldest();
    if (oldest != nullptr && run_.now() - oldest->at > answered_within &&
        struck_.whole_for(service_, run_.now()) > answered_within)
        deny(Sentence{"nobody answered \"", oldest->request, "\""});
}

void SwarmRun::watch() {
    if (events_.empty()) return;
    const std::size_t index = events_[random_.below(events_.size())];
    const End event = of_.machine.plan.subscriptions[index].event;
    const ComponentRow& row = of_.machine.table.components[event.component];
    const SubscriptionCounts counts = run_.instance().observation().counts_of(index);
    ask("subscribe " + std::string{row.name} + "." + std::string{row.type->facets[event.facet].name},
        [this, index, before = counts.served - counts.outdated - counts.dropped,
         lost_when_asked = counts.lost + counts.dropped](std::string_view answer) {
            if (!is_good(answer)) return;
            const SubscriptionCounts now = run_.instance().observation().counts_of(index);
            watched_ = {.index = index,
                        .before = before,
                        .lost_before = now.lost + now.dropped,
                        .lost_when_asked = lost_when_asked,
                        .looked = run_.now()};
        });
}

/// A watcher of an event gets each emission that came to the service, and the number of lost ones.
void SwarmRun::judge_watched() {
    if (watched_.index == nowhere) return;
    const SubscriptionCounts counts = run_.instance().observation().counts_of(watched_.index);
    const std::uint64_t came = counts.served - counts.outdated - counts.dropped;
    if (struck_.whole_for(service_, run_.now()) < told_within) {
        watched_.looked = run_.now();
        watched_.owed = 0;
    }
    if (watched_.before + watched_.told > came)
        deny(Sentence{"a browser received more emissions than there were"});
    if (std::exchange(watched_.was_told, false) && watched_.lost < watched_.known_lost)
        deny(Sentence{"emissions were lost, but their watcher was told of fewer"});
    const std::uint64_t lost = counts.lost + counts.dropped - watched_.lost_before,
                        unseen = watched_.lost - std::min(watched_.lost, lost);
    if (watched_.lost > counts.lost + counts.dropped - watched_.lost_when_asked)
        deny(Sentence{
            "an engineer's only event is lost in the service: events of lower roles occupy every place"});
    watched_.known_lost = lost;
    if (run_.now() - watched_.looked < told_within) return;
    if (watched_.before + watched_.told + unseen < watched_.owed)
        deny(Sentence{"an emission was lost, but its watcher was not told"});
    watched_.looked = run_.now();
    watched_.owed = came;
}

void SwarmRun::ask(std::string request, SwarmBrowser::Then then) {
    say(Sentence{"somebody asks: ", request}.view());
    browser_.ask(std::move(request), run_.now(), std::move(then));
}

/// `then` is called with whether the set was accepted.
void SwarmRun::set(const std::string& name, const std::string& value, std::function<void(bool)> then) {
    ++sets_open_;
    ask("set " + name + " " + value,
        [this, name, value, order = ++sets_, then = std::move(then)](std::string_view answer) {
            --sets_open_;
            // Its component may refuse it because of another value; an unanswered set may still have worked.
            SetValue& last = set_values_[name];
            if (field_of(answer, "code") != "bad_value" && order > last.order)
                last = {order, is_good(answer) ? value : std::string{}};
            then(is_good(answer));
        });
}

/// `refusals`: the codes of allowed refusals, because people ask at any time.
void SwarmRun::ask_for(std::string request, std::string_view refusals) {
    ask(request, [this, request, refusals](std::string_view answer) {
        if (answer.empty() || is_good(answer) || refusals.contains(field_of(answer, "code"))) return;
        deny(Sentence{"\"", request.substr(0, 60), "\" was refused: ", field_of(answer, "error")});
    });
}

std::function<bool()> SwarmRun::until_accepted(std::function<void(std::function<void(bool)>)> asks) {
    enum class Stage : std::uint8_t { not_asked, asked, accepted };
    return [asks = std::move(asks), stage = std::make_shared<Stage>(Stage::not_asked)] {
        if (*stage == Stage::not_asked) {
            *stage = Stage::asked;
            asks([stage](bool accepted) { *stage = accepted ? Stage::accepted : Stage::not_asked; });
        }
        return *stage == Stage::accepted;
    };
}

/// Returns a value of the type; empty when none can be drawn.
std::string SwarmRun::draw(const TypeTag& type, Range range) {
    ValueBytes value;
    const bool bounded = std::isfinite(range.low) && std::isfinite(range.high);
    const double most = std::pow(10.0, static_cast<double>(random_.below(4)));
    const double least = random_.one_in(4) ? -most : 0.0;
    const double low = bounded ? range.low : least, high = bounded ? range.high : most;
    const double number = random_.one_in(8)   ? low
                          : random_.one_in(7) ? high
                                              : low + random_.unit() * (high - low);
    switch (type.kind) {
    case ValueKind::boolean: value.put(random_.one_in(2)); break;
    case ValueKind::enumeration:
        value.put_whole(static_cast<std::int64_t>(random_.below(type.names.size())), type.size);
        break;
    case ValueKind::integer: value.put_whole(std::llround(number), type.size); break;
    case ValueKind::natural: value.put_whole(std::llround(std::abs(number)), type.size); break;
    case ValueKind::real:
        if (type.size == sizeof(float))
            value.put(static_cast<float>(number));
        else if (anything_goes_ && !bounded && random_.one_in(4))
            value.put((random_.one_in(2) ? -1 : 1) * largest[random_.below(largest.size())]);
        else
            value.put(number);
        break;
    case ValueKind::duration: value.put(std::int64_t{1000} * std::llround(number * 1e6)); break;
    case ValueKind::text: {
        const auto rows = of_.machine.table.components;
        return anything_goes_ ? "\"" + std::string{rows[random_.below(rows.size())].name} + "\""
                              : std::string{};
    }
    default: return {};
    }
    return text_of(type, value.bytes.data());
}

void SwarmRun::strike_people(Duration lasts) {
    const std::uint64_t what = random_.below(100);
    lasts = std::max(lasts, Duration{std::int64_t{1} << random_.between(24, 32)}); // as long as answers take
    if (anything_goes_) return strike_as_anyone(lasts);
    if (what < 25) return strike_property(lasts);
    if (what < 45) return strike_port(lasts);
    if (what < 60) return strike_slot();
    if (what < 75) return ask_a_command();
    if (what < 85) return ask_to_save();
    ask_to_read();
}

void SwarmRun::strike_property(Duration lasts) {
    const auto names = rules_->people().properties;
    if (names.empty()) return;
    const std::string name{names[random_.below(names.size())]};
    End end;
    if (const Sentence unknown = resolve(of_.machine.table, name, FacetKind::property, end); !unknown.empty())
        return deny(unknown);
    const Facet& facet = facet_at(of_.machine.table, end);
    const auto& first =
        *first_values_
             .try_emplace(name, text_of(*facet.type, static_cast<std::byte*>(run_.instance().facet(end))))
             .first;
    if (random_.one_in(3)) {
        ++verdict_.faults["property wrong"];
        const bool over = random_.one_in(2) && std::isfinite(facet.range.high);
        const std::string wrong = over ? std::to_string(2.0 * std::abs(facet.range.high) + 1.0) : "nan";
        return ask("set " + name + " " + wrong, [this, name, wrong](std::string_view answer) {
            if (is_good(answer)) deny(Sentence{"property \"", name, "\" takes ", wrong});
        });
    }
    const std::string value = draw(*facet.type, facet.range);
    if (value.empty()) return;
    set(name, value, [](bool) {});
    // After a restart of the machine, the saved value is back.
    begin("property set", Sentence{"property \"", name, "\" is ", value}, lasts, {},
          until_accepted([this, name, first = first.second](std::function<void(bool)> then) {
              set(name, first, std::move(then));
          }));
    faults_.back().outlives_machine = true;
}

void SwarmRun::strike_port(Duration lasts) {
    const auto names = rules_->people().ports;
    if (names.empty()) return;
    const std::string name{names[random_.below(names.size())]};
    End end;
    if (!resolve(of_.machine.table, name, FacetKind::input, end).empty())
        if (const Sentence unknown = resolve(of_.machine.table, name, FacetKind::output, end);
            !unknown.empty())
            return deny(unknown);
    const std::string value = draw(*facet_at(of_.machine.table, end).type, {});
    if (value.empty()) return deny(Sentence{"port \"", name, "\" has no type that a value can be drawn of"});
    ask_for("force " + name + " " + value, "not_now");
    begin("port forced", Sentence{"port \"", name, "\" is forced to ", value}, lasts, {},
          until_accepted([this, name](std::function<void(bool)> then) {
              ask("release " + name, [this, then = std::move(then)](std::string_view answer) {
                  if (!is_good(answer) && refusal_.empty()) refusal_ = Sentence{field_of(answer, "error")};
                  then(is_good(answer));
              });
          }));
}

/// Loads a script, at once or at an angle, or unloads or rolls back the slot, which cancels a script that
/// still waits for its angle.
void SwarmRun::strike_slot() {
    const auto scripts = rules_->people().scripts;
    if (scripts.empty()) return;
    const SwarmScript& script = scripts[random_.below(scripts.size())];
    const std::string slot{script.slot};
    if (random_.one_in(3)) {
        const bool unloads = random_.one_in(2);
        ++verdict_.faults[unloads ? "script unloaded" : "script rolled back"];
        return ask_for((unloads ? "unload " : "roll_back ") + slot, "not_now");
    }
    if (sends_script_) return; // pieces of two scripts would be mixed
    sends_script_ = true;
    ++verdict_.faults[script.compiles ? "script loaded" : "script wrong"];
    const std::string load = "load " + slot + " " + std::string{script.name} +
                             (random_.one_in(2) ? " now" : " " + std::to_string(random_.below(360)));
    const auto judge_load = [this, &script](std::string_view answer) {
        if (is_good(answer) && !script.compiles)
            deny(Sentence{"\"", script.name, "\" was accepted, but does not compile"});
        if (field_of(answer, "code") == "bad_value" && script.compiles)
            deny(Sentence{"\"", script.name, "\" was refused: ", field_of(answer, "error")});
    };
    ask("script " + slot + " 0 \"" + std::string{script.text} + "\"",
        [this, load, judge_load](std::string_view answer) {
            sends_script_ = false;
            if (is_good(answer)) ask(load, judge_load);
        });
}

/// Sends a call that an interface offers to operators: they may send it at any time.
void SwarmRun::ask_a_command() {
    if (commands_.empty()) return;
    const End end = commands_[random_.below(commands_.size())];
    const ComponentRow& row = of_.machine.table.components[end.component];
    const Facet& facet = row.type->facets[end.facet];
    const bool is_command = facet.command != nullptr;
    std::string request =
        std::string{is_command ? "send " : "call "} + std::string{row.name} + "." + std::string{facet.name};
    for (const TypeId each : (is_command ? *facet.command->arguments : *facet.type).elements) {
        const std::string value = draw(*each, {});
        if (value.empty()) return;
        request += " " + value;
    }
    ++verdict_.faults["command sent"];
    ask_for(request, "not_now");
}

void SwarmRun::ask_to_read() {
    constexpr std::array<std::string_view, 4> all{"hello", "forced", "counters", "behaviours"};
    ++verdict_.faults["read"];
    if (random_.one_in(2)) return ask_for(std::string{all[random_.below(all.size())]}, "not_now");
    const End end = readable_[random_.below(readable_.size())];
    const ComponentRow& row = of_.machine.table.components[end.component];
    ask_for("get " + std::string{row.name} + "." + std::string{row.type->facets[end.facet].name}, "not_now");
}

void SwarmRun::ask_to_save() {
    ++verdict_.faults["save"];
    ask("save", [this, sets = sets_](std::string_view answer) {
        if (is_good(answer)) judge_saved(sets == sets_ && sets_open_ == 0);
        if (field_of(answer, "code") == "unsupported")
            deny(Sentence{"the properties cannot be saved: ", field_of(answer, "error")});
    });
}

/// Judges that the next start accepts the saved file, with the last values if nobody sets anything now.
void SwarmRun::judge_saved(bool with_values) {
    const MachineView& table = of_.machine.table;
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const ComponentRow& row = table.components[c];
        if (!row.has_properties_file) continue;
        PropertyTransaction saved;
        saved.begin(row.name, *row.type, run_.instance().component(c));
        if (const Sentence refused = files_->load(row, saved); !refused.empty())
            return deny(Sentence{"the saved properties are refused: ", refused});
        for (const auto& [name, set] : set_values_) {
            End end;
            static_cast<void>(resolve(table, name, FacetKind::property, end));
            if (!with_values || end.component != c || set.value.empty()) continue;
            const Facet& facet = row.type->facets[end.facet];
            const std::string kept =
                saved.changes(end.facet) ? text_of(*facet.type, saved.change(end.facet)) : "nothing";
            if (kept != set.value)
                return deny(Sentence{"property \"", name, "\" is saved as ", kept, ", though it was set to ",
                                     set.value});
        }
    }
}

std::map<std::string, std::string> SwarmRun::kept_values() {
    std::map<std::string, std::string> kept;
    const auto rows = of_.machine.table.components;
    for (std::size_t c = 0; c < rows.size(); ++c)
        for (std::size_t f = 0; rows[c].has_properties_file && f < rows[c].type->facets.size(); ++f)
            if (const Facet& facet = rows[c].type->facets[f]; facet.kind == FacetKind::property)
                kept[name_of({c, f})] =
                    text_of(*facet.type, static_cast<std::byte*>(run_.instance().facet({c, f})));
    return kept;
}

/// The values kept at the halt must be back.
void SwarmRun::judge_kept() {
    const auto now = kept_values();
    for (const auto& [name, value] : kept_)
        if (const auto found = now.find(name); found == now.end() || found->second != value)
            deny(Sentence{"property \"", name, "\" was kept as ", value, " at the halt, and is ",
                          found == now.end() ? "gone" : found->second, " after the start"});
}

/// Call after everybody has released their forces.
void SwarmRun::judge_forces() {
    if (service_ == nowhere || anything_goes_) return;
    if (const auto forced = run_.instance().observation().forced_ports().load(); forced != 0)
        deny(Sentence{forced, " ports are still forced, though all were released"});
}

} // namespace tappet
