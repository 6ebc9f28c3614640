// The map of a machine in its memory: validated once, then searched by name (thesis 4.7.2, 4.8).
#pragma once

#include "kernel/machine/map/view.hpp"

#include <cstddef>
#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::browser {

/// A facet that was found: its index in the map and its record.
struct FoundFacet {
    std::uint32_t index = 0;
    map::Facet record{};
};

/// Reads a block that begins with a map. Validates everything before use: a half-written or foreign block
/// yields an error sentence, never an access outside the block.
class MapReader {
public:
    /// The block must outlive the reader. The error states what is invalid, and the cure. `place`: the prefix
    /// of all names, such as "saw." when there are several machines.
    static std::expected<MapReader, std::string> open(std::span<const std::byte> block,
                                                      std::string place = {});

    [[nodiscard]] const map::View& view() const { return view_; }
    [[nodiscard]] const map::Header& header() const { return view_.header(); }
    [[nodiscard]] std::string_view text(map::Text text) const { return view_.text(text); }

    [[nodiscard]] const std::vector<map::Component>& components() const { return components_; }
    [[nodiscard]] const std::vector<map::Facet>& facets() const { return facets_; }
    [[nodiscard]] const std::vector<map::Activity>& activities() const { return activities_; }
    [[nodiscard]] const std::vector<map::Connection>& connections() const { return connections_; }
    [[nodiscard]] const std::vector<map::Reaction>& reactions() const { return reactions_; }
    [[nodiscard]] const std::vector<map::Behaviour>& behaviours() const { return behaviours_; }
    [[nodiscard]] const std::vector<map::Type>& types() const { return types_; }
    [[nodiscard]] const std::vector<map::Field>& fields() const { return fields_; }
    [[nodiscard]] const std::vector<map::Enumerator>& enumerators() const { return enumerators_; }
    [[nodiscard]] const std::vector<map::Figure>& figures() const { return figures_; }

    /// Returns the name of a component or an activity, with the machine's prefix.
    [[nodiscard]] std::string named(map::Text name) const { return place_ + std::string{text(name)}; }
    /// Returns the machine's own name: without its prefix.
    [[nodiscard]] std::string_view own_name(std::string_view name) const {
        return name.starts_with(place_) ? name.substr(place_.size()) : name;
    }
    [[nodiscard]] const std::string& place() const { return place_; }

    /// Returns the record at `offset` behind `base`; null: it is not inside the block, or not aligned.
    template <class Record>
    [[nodiscard]] const Record* at(std::uint64_t base, std::uint64_t offset) const {
        const std::span<const std::byte> block = view_.block();
        const std::uint64_t place = base + offset;
        const bool inside =
            offset < block.size() && place <= block.size() && sizeof(Record) <= block.size() - place;
        return inside && place % alignof(Record) == 0 ? reinterpret_cast<const Record*>(block.data() + place)
                                                      : nullptr;
    }

    /// Returns "shaft.angle_deg", or "loom.shaft.angle_deg" when there are several machines.
    [[nodiscard]] std::string full_name(std::uint32_t facet) const;
    [[nodiscard]] std::optional<FoundFacet> find(std::string_view full_name) const;
    [[nodiscard]] std::optional<std::uint32_t> find_component(std::string_view name) const;
    /// Returns ", did you mean \"shaft.angle\"?" or nothing.
    static std::string nearest_of(std::string_view written, std::span<const std::string> names);
    /// Returns the row by which a device's driver gives an input its last value; null: no device does.
    [[nodiscard]] const map::Connection* device_row_of(std::uint32_t facet) const;
    /// The activity whose generation guards a facet's value; none for a component without an activity.
    [[nodiscard]] std::uint32_t activity_of(const map::Facet& facet) const;

private:
    explicit MapReader(const map::View& view);
    [[nodiscard]] std::string check() const;
    [[nodiscard]] std::string check_types() const;
    [[nodiscard]] std::string check_places() const;
    [[nodiscard]] bool holds(map::Text text) const;
    [[nodiscard]] bool inside(std::uint64_t at, std::uint64_t bytes) const;

    map::View view_{};
    std::string place_{};
    std::vector<map::Component> components_{};
    std::vector<map::Facet> facets_{};
    std::vector<map::Activity> activities_{};
    std::vector<map::Connection> connections_{};
    std::vector<map::Reaction> reactions_{};
    std::vector<map::Behaviour> behaviours_{};
    std::vector<map::Type> types_{};
    std::vector<map::Field> fields_{};
    std::vector<map::Enumerator> enumerators_{};
    std::vector<map::Figure> figures_{};
    std::map<std::string, std::uint32_t, std::less<>> by_name_{};
};

} // namespace tappet::browser
