// Merging, strictly: which keys there must be, of which type, and where they end up.
#include "apps/carpet_loom/demo/merge.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace tappet::demo {

namespace {

using Json = nlohmann::ordered_json;
using Error = std::unexpected<std::string>;

enum class Type { text, flag, count, number, object, list };
struct Key {
    std::string_view name;
    Type type;
};

constexpr std::array machine_keys{
    Key{"machine", Type::text},
    Key{"board", Type::text},
    Key{"world", Type::text},
    Key{"kernel_release", Type::text},
    Key{"realtime", Type::flag},
    Key{"stop_reason", Type::text},
    Key{"can_frames_lost", Type::count},
    Key{"gpio_edges_lost", Type::count},
    Key{"counters", Type::object},
    Key{"emissions_lost", Type::count},
    Key{"heap_allocations_after_arming", Type::count},
    Key{"page_faults_after_arming", Type::count},
    Key{"deadline_misses", Type::count},
    Key{"binary_bytes", Type::count},
    Key{"static_memory_bytes", Type::count},
    Key{"rss_bytes", Type::count},
    Key{"activities", Type::list},
    Key{"slots", Type::list},
};
// Without a script its name is empty.
constexpr std::array slot_keys{Key{"loads", Type::count}, Key{"roll_backs", Type::count}};
constexpr std::array counter_keys{Key{"utility.outages_survived", Type::count}};
constexpr std::array activity_keys{Key{"name", Type::text},
                                   Key{"cycles", Type::count},
                                   Key{"longest_busy_us", Type::number},
                                   Key{"most_processor_us", Type::number},
                                   Key{"claim_us", Type::number},
                                   Key{"over_claim", Type::count},
                                   Key{"longest_response_us", Type::number},
                                   Key{"deadline_misses", Type::count}};

/// Of the plant, to stand beside the machine's.
constexpr std::array judging_keys{
    Key{"seed", Type::count},
    Key{"picks", Type::count},
    Key{"picks_per_minute", Type::number},
    Key{"weft_breaks_injected", Type::count},
    Key{"warp_breaks_injected", Type::count},
    Key{"stops", Type::list},
    Key{"cam_error_deg", Type::object},
    Key{"damage", Type::object},
    Key{"patterns", Type::list},
};
constexpr std::array plant_keys{Key{"stops_total", Type::count}, Key{"time_s", Type::number}};
constexpr std::array stop_keys{Key{"cause", Type::text}, Key{"angle_deg", Type::number},
                               Key{"error_deg", Type::number}, Key{"at_pick", Type::count}};
constexpr std::array cam_keys{Key{"p50", Type::number}, Key{"p99", Type::number}, Key{"max", Type::number},
                              Key{"samples", Type::count}};
constexpr std::array pattern_keys{Key{"pattern", Type::count}, Key{"picks", Type::count},
                                  Key{"first_at_pick", Type::count}};
constexpr std::array damage_keys{Key{"total", Type::count}};

bool is(const Json& value, Type type) {
    switch (type) {
    case Type::text: return value.is_string() && !value.get_ref<const std::string&>().empty();
    case Type::flag: return value.is_boolean();
    case Type::count: return value.is_number_unsigned();
    case Type::number: return value.is_number();
    case Type::object: return value.is_object();
    case Type::list: return value.is_array();
    }
    return false;
}

const char* name_of(Type type) {
    switch (type) {
    case Type::text: return "a text";
    case Type::flag: return "true or false";
    case Type::count: return "a whole number from 0";
    case Type::number: return "a number";
    case Type::object: return "an object";
    case Type::list: return "a list";
    }
    return "?";
}

/// What is wrong with these keys of `value`; empty when nothing is.
std::string fault_of(const Json& value, std::string_view whose, std::span<const Key> keys) {
    if (!value.is_object()) return std::string{whose} + " is no object";
    for (const Key& key : keys) {
        const auto found = value.find(key.name);
        if (found == value.end()) return std::string{whose} + " lacks \"" + std::string{key.name} + "\"";
        if (!is(*found, key.type))
            return std::string{whose} + ": \"" + std::string{key.name} + "\" is not " + name_of(key.type);
    }
    return {};
}

std::string fault_of_each(const Json& list, const std::string& whose, std::span<const Key> keys) {
    for (const Json& item : list)
        if (auto fault = fault_of(item, whose, keys); !fault.empty()) return fault;
    return {};
}

std::expected<Json, std::string> parse(std::string_view text, std::string_view whose) {
    // The library lets the last of two equal keys win.
    std::vector<std::set<std::string>> open;
    std::string twice;
    const auto watch = [&](int, Json::parse_event_t event, Json& value) {
        if (event == Json::parse_event_t::object_start) open.emplace_back();
        if (event == Json::parse_event_t::object_end) open.pop_back();
        if (event == Json::parse_event_t::key && !open.back().insert(value.get<std::string>()).second)
            twice = value.get<std::string>();
        return true;
    };
    try {
        Json json = Json::parse(text, watch);
        if (!twice.empty()) return Error{std::string{whose} + ": \"" + twice + "\" is there twice"};
        return json;
    } catch (const Json::exception& error) {
        return Error{std::string{whose} + " is no JSON: " + error.what()};
    }
}

} // namespace

std::expected<std::string, std::string> merge(std::string_view machine_text, std::string_view plant_text) {
    constexpr std::string_view machines = "the firmware's summary";
    constexpr std::string_view plants = "the plant's report";
    auto machine = parse(machine_text, machines);
    if (!machine) return Error{machine.error()};
    auto plant = parse(plant_text, plants);
    if (!plant) return Error{plant.error()};

    for (const auto& fault : {fault_of(*machine, machines, machine_keys),
                              fault_of(*plant, plants, judging_keys), fault_of(*plant, plants, plant_keys)})
        if (!fault.empty()) return Error{fault};
    for (const auto& fault : {fault_of_each((*machine)["activities"], "an activity", activity_keys),
                              fault_of_each((*machine)["slots"], "a slot", slot_keys),
                              fault_of((*machine)["counters"], "\"counters\"", counter_keys),
                              fault_of_each((*plant)["stops"], "a stop", stop_keys),
                              fault_of_each((*plant)["patterns"], "a pattern", pattern_keys),
                              fault_of((*plant)["cam_error_deg"], "\"cam_error_deg\"", cam_keys),
                              fault_of((*plant)["damage"], "\"damage\"", damage_keys)})
        if (!fault.empty()) return Error{fault};
    if ((*machine)["slots"].empty())
        return Error{std::string{machines} + " has no slot, and the loom has one"};

    Json activities = std::move((*machine)["activities"]);
    machine->erase("activities");
    Json merged = *std::move(machine);
    for (const Key& key : judging_keys) {
        if (merged.contains(key.name))
            return Error{"both the firmware and the plant say \"" + std::string{key.name} + "\""};
        merged[std::string{key.name}] = (*plant)[std::string{key.name}];
        plant->erase(std::string{key.name});
    }
    if (merged.contains("plant")) return Error{"the firmware's summary has a \"plant\" of its own"};
    merged["activities"] = std::move(activities);
    merged["plant"] = *std::move(plant);
    return merged.dump(2) + "\n";
}

} // namespace tappet::demo
