// Validates a map before any of its content is used.
#include "toolchain/tools/browser/map_reader.hpp"

#include "kernel/base/nearest.hpp"

#include <algorithm>

namespace tappet::browser {

namespace {

/// A type may contain types; a deeper nesting means that it contains itself.
constexpr int deepest_type = 16;

bool fits(std::uint32_t index, std::size_t count) { return index == map::none || index < count; }

} // namespace

MapReader::MapReader(const map::View& view) : view_{view} {
    const auto take = [](const auto& records, auto& into) { into.assign(records.begin(), records.end()); };
    take(view.components(), components_);
    take(view.facets(), facets_);
    take(view.activities(), activities_);
    take(view.connections(), connections_);
    take(view.reactions(), reactions_);
    take(view.behaviours(), behaviours_);
    take(view.types(), types_);
    take(view.fields(), fields_);
    take(view.enumerators(), enumerators_);
    take(view.figures(), figures_);
}

std::expected<MapReader, std::string> MapReader::open(std::span<const std::byte> block, std::string place) {
    const auto view = map::View::open(block);
    if (!view) return std::unexpected(std::string{view.error().view()});
    MapReader reader{*view};
    reader.place_ = std::move(place);
    if (const std::string wrong = reader.check(); !wrong.empty())
        return std::unexpected("the map contradicts itself: " + wrong);
    for (std::uint32_t i = 0; i < reader.facets_.size(); ++i) reader.by_name_.emplace(reader.full_name(i), i);
    return reader;
}

bool MapReader::holds(map::Text text) const {
    return text.length == 0 || (text.at <= header().map_bytes && text.length <= header().map_bytes - text.at);
}

bool MapReader::inside(std::uint64_t at, std::uint64_t bytes) const {
    return at == 0 || (at <= header().block_bytes && bytes <= header().block_bytes - at);
}

std::string MapReader::check() const {
    for (const map::Component& each : components_)
        if (!holds(each.name) || !holds(each.type) || !holds(each.device) ||
            !fits(each.activity, activities_.size()) || each.first_facet > facets_.size() ||
            each.facet_count > facets_.size() - each.first_facet)
            return "a component's row points outside";
    for (const map::Facet& each : facets_)
        if (!holds(each.name) || !holds(each.unit) || !holds(each.doc) || !holds(each.kind) ||
            each.component >= components_.size() || !fits(each.type, types_.size()) ||
            !fits(each.result, types_.size()))
            return "a facet's row points outside";
    for (const map::Connection& each : connections_)
        if (!fits(each.from, facets_.size()) || !fits(each.to, facets_.size()) || !holds(each.when_stale) ||
            !holds(each.overflow))
            return "a connection's row points outside";
    for (const map::Reaction& each : reactions_)
        if (!fits(each.from, facets_.size()) || !fits(each.to, facets_.size()) || !holds(each.how) ||
            !fits(each.behaviour, behaviours_.size()) || !fits(each.from_activity, activities_.size()) ||
            !fits(each.to_activity, activities_.size()))
            return "a reaction's row points outside";
    for (const map::Behaviour& each : behaviours_)
        if (!fits(each.component, components_.size())) return "a behaviour's row points outside";
    if (!holds(header().machine) || !holds(header().board) || !holds(header().world))
        return "the header points outside";
    const std::string types = check_types();
    return types.empty() ? check_places() : types;
}

std::string MapReader::check_types() const {
    for (const map::Type& each : types_) {
        const bool own = holds(each.name) && fits(each.element, types_.size()) &&
                         each.first_field <= fields_.size() &&
                         each.field_count <= fields_.size() - each.first_field &&
                         each.first_enumerator <= enumerators_.size() &&
                         each.enumerator_count <= enumerators_.size() - each.first_enumerator &&
                         each.size <= header().block_bytes;
        if (!own) return "a type's row points outside";
        const auto within = [&each](std::uint64_t at, std::uint64_t bytes) {
            return at <= each.size && bytes <= each.size - at;
        };
        if (each.shape == map::Shape::matrix || each.shape == map::Shape::sequence) {
            if (each.element == map::none) return "a type of many has no type of one";
            const std::uint64_t rows = each.shape == map::Shape::matrix ? each.rows : 1;
            const std::uint64_t items = rows * each.columns;
            const std::uint64_t one = types_[each.element].size;
            if (items > each.size || !within(each.items_at, items * one))
                return "a type's items lie outside of it";
        }
        if (each.shape == map::Shape::text && !within(each.items_at, each.columns))
            return "a text's characters lie outside of it";
        if ((each.shape == map::Shape::text || each.shape == map::Shape::sequence) &&
            (each.length_bytes > 8 || !within(each.length_at, each.length_bytes)))
            return "a type's length lies outside of it";
        for (std::uint32_t i = 0; i < each.field_count; ++i) {
            const map::Field& field = fields_[each.first_field + i];
            if (!holds(field.name) || !holds(field.unit) || field.type >= types_.size() ||
                !within(field.at, types_[field.type].size))
                return "a field lies outside of its record";
        }
    }
    for (const map::Enumerator& each : enumerators_)
        if (!holds(each.name)) return "an enumerator's name lies outside";
    // Depth first: only a type that contains itself reaches the limit.
    const auto too_deep = [this](auto& self, std::uint32_t type, int depth) -> bool {
        if (depth > deepest_type) return true;
        const map::Type& each = types_[type];
        if (each.element != map::none && self(self, each.element, depth + 1)) return true;
        for (std::uint32_t i = 0; i < each.field_count; ++i)
            if (self(self, fields_[each.first_field + i].type, depth + 1)) return true;
        return false;
    };
    for (std::uint32_t i = 0; i < types_.size(); ++i)
        if (too_deep(too_deep, i, 0)) return "a type holds itself";
    return {};
}

std::string MapReader::check_places() const {
    if (!inside(header().forced_at, sizeof(std::uint32_t))) return "the number of forced ports lies outside";
    for (const map::Activity& each : activities_)
        if (!holds(each.name) || !holds(each.trigger) || !inside(each.generation_at, sizeof(std::uint64_t)) ||
            !inside(each.now_at, sizeof(std::int64_t)))
            return "an activity's row points outside";
    for (const map::Facet& each : facets_) {
        const std::uint64_t bytes = each.type == map::none ? 0 : types_[each.type].size;
        if ((each.value_at != 0 && each.type == map::none) || !inside(each.value_at, bytes) ||
            !inside(each.stamp_at, sizeof(std::int64_t)) || !inside(each.writes_at, sizeof(std::uint64_t)) ||
            !inside(each.forced_at, 1) || !inside(each.forced_value_at, bytes))
            return "a facet's value lies outside";
    }
    for (const map::Figure& each : figures_)
        if (!holds(each.name) || !holds(each.unit) || !holds(each.doc) || each.type >= types_.size() ||
            !fits(each.activity, activities_.size()) || !inside(each.value_at, types_[each.type].size))
            return "a figure's row points outside";
    return {};
}

std::string MapReader::full_name(std::uint32_t facet) const {
    const map::Facet& record = facets_[facet];
    std::string name = named(components_[record.component].name);
    name += '.';
    name += text(record.name);
    return name;
}

std::optional<FoundFacet> MapReader::find(std::string_view full_name) const {
    const auto found = by_name_.find(full_name);
    if (found == by_name_.end()) return std::nullopt;
    return FoundFacet{found->second, facets_[found->second]};
}

std::optional<std::uint32_t> MapReader::find_component(std::string_view name) const {
    for (std::uint32_t i = 0; i < components_.size(); ++i)
        if (named(components_[i].name) == name) return i;
    return std::nullopt;
}

std::string MapReader::nearest_of(std::string_view written, std::span<const std::string> names) {
    Nearest nearest{written};
    for (const std::string& name : names) nearest.consider(name);
    if (nearest.best().empty()) return {};
    return "; did you mean \"" + std::string{nearest.best()} + "\"?";
}

const map::Connection* MapReader::device_row_of(std::uint32_t facet) const {
    for (const map::Connection& each : connections_)
        if (each.to == facet && each.from != map::none && (each.flags & map::connection_buffered) == 0)
            return components_[facets_[each.from].component].device.length > 0 ? &each : nullptr;
    return nullptr;
}

std::uint32_t MapReader::activity_of(const map::Facet& facet) const {
    return components_[facet.component].activity;
}

} // namespace tappet::browser
