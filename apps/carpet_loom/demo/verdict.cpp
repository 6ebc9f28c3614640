// Merges two summaries into one; the table and the faults are read from it and from nothing else.
#include "apps/carpet_loom/demo/verdict.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace tappet::demo {

namespace {

using Json = nlohmann::ordered_json;

template <class... Values> std::string format(const char* pattern, Values... values) {
    std::array<char, 512> text{};
    std::snprintf(text.data(), text.size(), pattern, values...);
    return text.data();
}

std::string text(const Json& json, const char* key) { return json.at(key).get<std::string>(); }
unsigned long long count(const Json& json, const char* key) {
    return json.at(key).get_ref<const Json::number_unsigned_t&>(); // throws on a negative number
}
double number(const Json& json, const char* key) { return json.at(key).get<double>(); }

/// Returns true for a stop that the machine brakes towards the stop angle; an emergency stop ends anywhere.
bool aims_at_stop_angle(const Json& stop) {
    const std::string cause = text(stop, "cause");
    return cause == "weft" || cause == "warp" || cause == "operator";
}

std::string row(const char* name, const std::string& words) {
    return format("  %-10s %s\n", name, words.c_str());
}

/// Returns the processor time that the activity used and its row's claim; empty when the row claims nothing.
std::string claim_of(const Json& activity) {
    const double claimed = number(activity, "claim_us");
    if (claimed == 0) return "";
    const double measured = number(activity, "most_processor_us"); // 0: the claim was never in doubt
    const double used = measured > 0 ? measured : number(activity, "longest_busy_us");
    return format("%.0f/%.0f us", used, claimed);
}

std::string table_of(const Json& run) {
    const Json& plant = run.at("plant");
    const Json& cams = run.at("cam_error_deg");
    std::string table;
    table += row("machine", text(run, "machine") + " on board " + text(run, "board") + ", kernel " +
                                text(run, "kernel_release") +
                                (run.at("realtime").get<bool>() ? ", real-time" : ", NOT real-time"));
    table +=
        row("woven", format("%llu picks at %.0f picks/min of running time, in %.1f s of the loom's time",
                            count(run, "picks"), number(run, "picks_per_minute"), number(plant, "time_s")));
    table += row("injected", format("%llu weft breaks, %llu warp breaks; %llu Modbus outages survived",
                                    count(run, "weft_breaks_injected"), count(run, "warp_breaks_injected"),
                                    count(run.at("counters"), "utility.outages_survived")));
    table += row("stops", format("%llu, measured at the true shaft", count(plant, "stops_total")));
    for (const Json& stop : run.at("stops")) {
        std::string words = format("  pick %4llu  %-9s at %6.2f deg", count(stop, "at_pick"),
                                   text(stop, "cause").c_str(), number(stop, "angle_deg"));
        if (aims_at_stop_angle(stop)) words += format(", error %+6.2f deg", number(stop, "error_deg"));
        table += row("", words);
    }
    table += row("cams", format("error p50 %.2f, p99 %.2f, max %.2f deg over %llu wefts", number(cams, "p50"),
                                number(cams, "p99"), number(cams, "max"), count(cams, "samples")));
    table +=
        row("lost", format("%llu CAN frames, %llu GPIO edges, %llu emissions", count(run, "can_frames_lost"),
                           count(run, "gpio_edges_lost"), count(run, "emissions_lost")));
    table += row("after", format("arming: %llu heap allocations, %llu page faults, %llu deadline misses",
                                 count(run, "heap_allocations_after_arming"),
                                 count(run, "page_faults_after_arming"), count(run, "deadline_misses")));
    table += row("damage", format("%llu", count(run.at("damage"), "total")));
    std::string lifted;
    for (const Json& each : run.at("patterns"))
        lifted += format("%s%04llx from pick %llu on", lifted.empty() ? "" : ", ", count(each, "pattern"),
                         count(each, "first_at_pick"));
    table += row("weave", "the harnesses were lifted to " + lifted);
    if (const Json& weave = run.at("slots").at(0); count(weave, "loads") != 0)
        table += row("", format("%s is at work; %llu scripts took over; %s", text(weave, "script").c_str(),
                                count(weave, "loads"), text(weave, "news").c_str()));
    table += row("timing", "activity   cycles   longest busy   of the claimed   worst response   misses");
    for (const Json& activity : run.at("activities"))
        table += row("", format("%-9s %7llu %11.0f us %13s %13.0f us %8llu", text(activity, "name").c_str(),
                                count(activity, "cycles"), number(activity, "longest_busy_us"),
                                claim_of(activity).c_str(), number(activity, "longest_response_us"),
                                count(activity, "deadline_misses")));
    table += row("memory", format("firmware %.2f MB, static memory %.2f MB, resident %.2f MB",
                                  static_cast<double>(count(run, "binary_bytes")) * 1e-6,
                                  static_cast<double>(count(run, "static_memory_bytes")) * 1e-6,
                                  static_cast<double>(count(run, "rss_bytes")) * 1e-6));
    return table;
}

constexpr std::pair<const char*, const char*> must_be_none[] = {
    {"can_frames_lost", "CAN frames were lost"},
    {"gpio_edges_lost", "GPIO edges were lost"},
    {"emissions_lost", "emissions of events were lost"},
    {"heap_allocations_after_arming", "heap allocations after arming"},
    {"page_faults_after_arming", "page faults in real-time threads after arming"},
    {"deadline_misses", "deadlines were missed"}};

std::vector<std::string> faults_of(const Json& run, std::int64_t picks_wanted) {
    std::vector<std::string> faults;
    if (!run.at("realtime").get<bool>()) faults.push_back("the kernel was not real-time");
    if (count(run, "picks") < static_cast<unsigned long long>(picks_wanted))
        faults.push_back(format("only %llu of %lld picks were woven", count(run, "picks"),
                                static_cast<long long>(picks_wanted)));
    for (const Json& stop : run.at("stops")) {
        const std::string cause = text(stop, "cause");
        const unsigned long long pick = count(stop, "at_pick");
        if (aims_at_stop_angle(stop) && std::abs(number(stop, "error_deg")) > most_stop_error_deg)
            faults.push_back(format("the %s stop after pick %llu was %.1f degrees off; %.0f are allowed",
                                    cause.c_str(), pick, number(stop, "error_deg"), most_stop_error_deg));
        if (cause == "machine" || cause == "fault")
            faults.push_back(
                format("the loom stopped after pick %llu (%s), and nothing had been injected for that", pick,
                       cause.c_str()));
    }
    if (picks_wanted >= least_picks_for_weaves) {
        const Json& weave = run.at("slots").at(0);
        std::uint64_t picks_of_it = 0;
        for (const Json& each : run.at("patterns"))
            if (count(each, "pattern") == pattern_of_new_weave) picks_of_it = count(each, "picks");
        if (text(weave, "script") != new_weave || picks_of_it < 2)
            faults.push_back(format(
                "%s was loaded, and \"%s\" is at work; %llu picks were woven with its pattern", new_weave,
                text(weave, "script").c_str(), static_cast<unsigned long long>(picks_of_it)));
        if (count(weave, "roll_backs") != 1)
            faults.push_back(format("one script that misbehaves was loaded, and %llu were rolled back",
                                    count(weave, "roll_backs")));
    }
    for (const auto& [key, what] : must_be_none)
        if (const auto found = count(run, key); found != 0) faults.push_back(format("%llu %s", found, what));
    for (const Json& activity : run.at("activities"))
        if (const auto over = count(activity, "over_claim"); over != 0)
            faults.push_back(
                format("activity \"%s\" used more of the processor than its row claims, %llu times, "
                       "up to %.0f us of %.0f",
                       text(activity, "name").c_str(), over, number(activity, "most_processor_us"),
                       number(activity, "claim_us")));
    if (const auto damage = count(run.at("damage"), "total"); damage != 0)
        faults.push_back(format("%llu times the loom or its cloth took damage", damage));
    return faults;
}

Json merged(std::string_view machine, std::string_view plant) {
    Json run = Json::parse(machine), rest = Json::parse(plant);
    Json activities = run.at("activities");
    run.erase("activities");
    for (const char* key : {"seed", "picks", "picks_per_minute", "weft_breaks_injected",
                            "warp_breaks_injected", "stops", "cam_error_deg", "damage", "patterns"}) {
        run[key] = rest.at(key);
        rest.erase(key);
    }
    run["activities"] = std::move(activities);
    run["plant"] = std::move(rest);
    return run;
}

} // namespace

std::expected<Verdict, std::string> judge(std::string_view machine, std::string_view plant,
                                          std::int64_t picks_wanted) {
    try {
        const Json run = merged(machine, plant);
        return Verdict{run.dump(2) + "\n", table_of(run), faults_of(run, picks_wanted)};
    } catch (const Json::exception& error) {
        return std::unexpected(std::string{"the summary of the firmware or of the plant is invalid: "} +
                               error.what());
    }
}

} // namespace tappet::demo
