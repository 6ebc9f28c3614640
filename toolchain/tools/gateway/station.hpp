// A machine as the gateway's clients see it: its values, looked at once a tick for all of them.
#pragma once

#include "toolchain/tools/browser/observer.hpp"
#include "toolchain/tools/gateway/scout.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tappet::network {

class Station {
public:
    explicit Station(const Sighting& sighting) : name_{sighting.name}, socket_{sighting.socket} {
        see(sighting);
    }
    /// Takes over what the scout saw. A new life of the machine ends the watches of the old one.
    void see(const Sighting& sighting);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const std::string& socket() const { return socket_; }
    /// Null: it does not answer.
    [[nodiscard]] const std::shared_ptr<const Place>& place() const { return place_; }
    [[nodiscard]] const std::string& reason() const { return reason_; }
    /// Counts the machine's lives.
    [[nodiscard]] std::uint32_t life() const { return life_; }
    /// Returns the kinds of facets whose values a client may watch, as indices of the map.
    [[nodiscard]] std::vector<std::uint32_t> with_values() const;

    /// Counts watchers of facets.
    void want(std::span<const std::uint32_t> facets);
    void drop(std::span<const std::uint32_t> facets, std::uint32_t life);
    /// Reads all wanted facets together, so that values of one activity are of one moment for every client.
    void look(std::int64_t now_ns);
    [[nodiscard]] const browser::Reading& reading(std::uint32_t facet) const { return readings_[facet]; }
    /// Returns the time of the newest cycle seen; -1: none.
    [[nodiscard]] std::int64_t machine_ns() const { return machine_ns_; }
    /// Returns since when no newer cycle was seen: how old the newest look is.
    [[nodiscard]] std::int64_t age_ns(std::int64_t now_ns) const { return now_ns - advanced_ns_; }
    /// Returns why the values are not live: the machine's newest cycle is older than 1 s; empty: they are.
    [[nodiscard]] std::string standstill(std::int64_t now_ns) const;
    /// Reads single facets at once.
    [[nodiscard]] std::vector<browser::Reading> read(std::span<const std::uint32_t> facets) const;
    [[nodiscard]] browser::Observer observer() const;

private:
    std::string name_;
    std::string socket_;
    std::shared_ptr<const Place> place_{};
    std::string reason_{};
    std::uint32_t life_ = 0;
    std::vector<std::uint32_t> wanted_{};
    std::vector<std::uint32_t> all_wanted_{}; ///< the facets that are wanted
    std::vector<browser::Reading> readings_{};
    std::int64_t machine_ns_ = -1;
    std::int64_t advanced_ns_ = 0;
};

/// Returns the time of CLOCK_MONOTONIC, which is a machine's own in real time.
[[nodiscard]] std::int64_t monotonic_ns();

} // namespace tappet::network
