// Reads the wanted values of a machine together.
#include "toolchain/tools/gateway/station.hpp"

#include <algorithm>
#include <ctime>

namespace tappet::network {

std::int64_t monotonic_ns() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void Station::see(const Sighting& sighting) {
    place_ = sighting.place;
    reason_ = sighting.reason;
    ++life_;
    const std::size_t facets = place_ == nullptr ? 0 : place_->map.facets().size();
    wanted_.assign(facets, 0);
    all_wanted_.clear();
    readings_.assign(facets, {});
    machine_ns_ = -1;
    advanced_ns_ = 0; // nothing was seen: very old
}

std::vector<std::uint32_t> Station::with_values() const {
    std::vector<std::uint32_t> found;
    if (place_ == nullptr) return found;
    const auto& facets = place_->map.facets();
    for (std::uint32_t i = 0; i < facets.size(); ++i)
        if (facets[i].value_at != 0) found.push_back(i);
    return found;
}

void Station::want(std::span<const std::uint32_t> facets) {
    for (const std::uint32_t each : facets)
        if (wanted_[each]++ == 0) all_wanted_.push_back(each);
}

void Station::drop(std::span<const std::uint32_t> facets, std::uint32_t life) {
    if (life != life_) return;
    for (const std::uint32_t each : facets)
        if (--wanted_[each] == 0) std::erase(all_wanted_, each);
}

browser::Observer Station::observer() const {
    // Few attempts and no sleep: the network's thread waits for no machine.
    constexpr int attempts = 8;
    return browser::Observer{place_->map, false, attempts};
}

std::vector<browser::Reading> Station::read(std::span<const std::uint32_t> facets) const {
    return place_ == nullptr ? std::vector<browser::Reading>{} : observer().read(facets);
}

std::string Station::standstill(std::int64_t now_ns) const {
    constexpr std::int64_t second = 1'000'000'000;
    const std::int64_t age = age_ns(now_ns);
    return age <= second ? "" : "its newest cycle is " + std::to_string(age / second) + " s old";
}

void Station::look(std::int64_t now_ns) {
    if (place_ == nullptr) return;
    std::vector<browser::Reading> readings;
    if (!all_wanted_.empty()) readings = read(all_wanted_);
    for (browser::Reading& each : readings) {
        const std::uint32_t facet = each.facet;
        readings_[facet] = std::move(each);
    }
    // The newest cycle of any activity: one that waits for events may rest for long.
    std::int64_t newest = -1;
    for (const map::Activity& each : place_->map.activities())
        if (each.now_at != 0) newest = std::max(newest, place_->map.view().word<std::int64_t>(each.now_at));
    // A first look sees no advance. A machine in real time has our clock; another one is old until it
    // advances.
    if (newest != machine_ns_)
        advanced_ns_ = machine_ns_ < 0 ? std::clamp(newest, std::int64_t{0}, now_ns) : now_ns;
    machine_ns_ = newest;
}

} // namespace tappet::network
