// The map of a machine (thesis 4.7.2), derived from its table by the compiler: the contents of map/layout.hpp
// except the places of live values, which start-up adds.
#pragma once

#include "kernel/base/digest.hpp"
#include "kernel/machine/check/check.hpp"
#include "kernel/machine/map/layout.hpp"
#include "kernel/machine/map/types.hpp"
#include "kernel/machine/plan/subscription.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace tappet::map {

/// The number of records of each section, and of characters.
struct Counts {
    std::size_t components = 0, facets = 0, activities = 0, connections = 0, reactions = 0, behaviours = 0;
    std::size_t types = 0, fields = 0, enumerators = 0, figures = 0, characters = 0;
};

/// The size of the array for `n` records: at least one, since an array cannot be empty.
constexpr std::size_t room(std::size_t n) noexcept { return std::max<std::size_t>(n, 1); }
constexpr std::size_t room_of_texts(std::size_t n) noexcept { return (n / 8 + 1) * 8; }

/// The map's memory, in reading order. Every record's size is a multiple of 8, so that there are no gaps.
template <Counts counts>
struct Storage {
    Header header{};
    std::array<Component, room(counts.components)> components{};
    std::array<Facet, room(counts.facets)> facets{};
    std::array<Activity, room(counts.activities)> activities{};
    std::array<Connection, room(counts.connections)> connections{};
    std::array<Reaction, room(counts.reactions)> reactions{};
    std::array<Behaviour, room(counts.behaviours)> behaviours{};
    std::array<Type, room(counts.types)> types{};
    std::array<Field, room(counts.fields)> fields{};
    std::array<Enumerator, room(counts.enumerators)> enumerators{};
    std::array<Figure, room(counts.figures)> figures{};
    std::array<char, room_of_texts(counts.characters)> characters{};

    /// Returns a text of this map.
    [[nodiscard]] constexpr std::string_view text(const Text& text) const noexcept {
        return {characters.data() + (text.at - header.texts.at), text.length};
    }
};

/// A map, and the types it describes in the same order: their functions know the offsets of a record's
/// fields, which the compiler does not.
template <Counts counts>
struct Drawn {
    Storage<counts> map{};
    std::array<TypeId, room(counts.types)> types{};
};

/// The arrays that records are written to; a section with an empty array is only counted.
struct Room {
    std::span<Component> components;
    std::span<Facet> facets;
    std::span<Activity> activities;
    std::span<Connection> connections;
    std::span<Reaction> reactions;
    std::span<Behaviour> behaviours;
    std::span<Type> types;
    std::span<Field> fields;
    std::span<Enumerator> enumerators;
    std::span<Figure> figures;
    std::span<char> characters;
    std::span<TypeId> type_ids; ///< the described types
    std::size_t characters_at = 0;
};

/// Iterates over a checked table and writes its records into a room, or counts them.
class Cartographer {
public:
    constexpr Cartographer(const MachineView& table, const TableIndexView& index, const Room& room)
        : m_{table}, r_{index}, room_{room} {}

    constexpr void draw(Header& header, const Board& board, const Binding& binding) {
        header.machine = text(m_.name);
        header.board = text(board.name);
        header.world = text(board.world);
        static_cast<void>(types_.of(type_id<bool>)); // 0 is a type like any other
        draw_components();
        draw_activities(board, binding);
        draw_connections();
        draw_reactions();
        draw_behaviours();
        draw_figures();
        draw_types();
    }
    [[nodiscard]] constexpr const Counts& counts() const { return n_; }

private:
    template <class Record>
    static constexpr void put(std::span<Record> into, std::size_t& n, const Record& record) {
        if (n < into.size()) into[n] = record;
        ++n;
    }
    constexpr Text text(std::string_view characters) {
        const Text text{static_cast<std::uint32_t>(room_.characters_at + n_.characters),
                        static_cast<std::uint32_t>(characters.size())};
        if (n_.characters + characters.size() <= room_.characters.size())
            std::copy(characters.begin(), characters.end(),
                      room_.characters.begin() + static_cast<std::ptrdiff_t>(n_.characters));
        n_.characters += characters.size();
        return text;
    }
    static constexpr std::uint32_t flag(bool set, std::uint32_t bit) { return set ? bit : 0; }
    constexpr std::uint32_t type(TypeId id) { return id == nullptr ? none : types_.of(id); }
    [[nodiscard]] constexpr std::uint32_t facet_index(End end) const {
        // The components are drawn first; a counting run needs no index.
        return room_.components.empty()
                   ? 0
                   : room_.components[end.component].first_facet + static_cast<std::uint32_t>(end.facet);
    }

    constexpr void draw_components();
    constexpr void draw_facet(End end);
    constexpr void draw_activities(const Board& board, const Binding& binding);
    constexpr void draw_connections();
    constexpr void draw_reactions();
    constexpr void draw_behaviours();
    constexpr void draw_figures();
    constexpr void draw_types();
    constexpr void figure(Owner owner, std::size_t index, std::string_view name, std::string_view unit,
                          std::string_view doc, TypeId of, std::size_t activity);

    const MachineView& m_;
    const TableIndexView& r_;
    Room room_;
    Counts n_{};
    TypeList types_{};
};

constexpr void Cartographer::draw_components() {
    for (std::size_t c = 0; c < m_.components.size(); ++c) {
        const ComponentRow& row = m_.components[c];
        Component record;
        record.name = text(row.name);
        record.type = text(row.type->tag->name);
        record.device = text(row.device);
        record.activity = static_cast<std::uint32_t>(r_.activity[c]);
        record.position = static_cast<std::uint32_t>(r_.position[c]);
        record.first_facet = static_cast<std::uint32_t>(n_.facets);
        record.facet_count = static_cast<std::uint32_t>(row.type->facets.size());
        record.bytes = row.type->size;
        for (std::size_t f = 0; f < row.type->facets.size(); ++f) draw_facet({c, f});
        put(room_.components, n_.components, record);
    }
}

constexpr void Cartographer::draw_facet(End end) {
    const tappet::Facet& facet = facet_at(m_, end);
    Facet record;
    record.name = text(facet.name);
    record.unit = text(facet.unit);
    record.doc = text(facet.doc);
    const std::string_view kind = to_text(facet.kind); // "an input"
    record.kind = text(kind.substr(kind.find(' ') + 1));
    record.component = static_cast<std::uint32_t>(end.component);
    record.type = type(facet.command != nullptr ? facet.command->arguments : facet.type);
    if (facet.method != nullptr && facet.method->result_bytes != 0)
        record.result = type(facet.method->result);
    if (facet.command != nullptr && facet.command->result_bytes != 0)
        record.result = type(facet.command->results);
    record.low = facet.range.low;
    record.high = facet.range.high;
    const bool ranged = record.low > -std::numeric_limits<double>::infinity() ||
                        record.high < std::numeric_limits<double>::infinity();
    const bool is_input = facet.kind == FacetKind::input || facet.kind == FacetKind::buffer_input;
    const bool is_data = facet.kind == FacetKind::input || facet.kind == FacetKind::output;
    const bool can_request = facet.property != nullptr || facet.operation != nullptr ||
                             facet.method != nullptr || facet.command != nullptr;
    record.role = text(can_request ? to_text(facet.least_role) : std::string_view{});
    record.flags = flag(facet.required, facet_required) | flag(facet.any_thread, facet_any_thread) |
                   flag(ranged, facet_has_range) | flag(is_data, facet_can_force) |
                   flag(can_request, facet_can_request) | flag(facet.for_people, facet_for_people) |
                   flag(facet.motion == Motion::moves, facet_moves) |
                   flag(facet.motion == Motion::moves_while_held, facet_moves_while_held);
    if (is_input)
        for (std::size_t x = r_.connections_into.first[end.component]; x != nowhere;
             x = r_.connections_into.next[x])
            if (r_.connections[x].to == end) record.flags |= facet_connected;
    put(room_.facets, n_.facets, record);
}

constexpr void Cartographer::draw_activities(const Board& board, const Binding& binding) {
    for (const ActivityRow& row : m_.activities) {
        Activity record;
        record.name = text(row.name);
        record.trigger = text(row.trigger == Trigger::every       ? "every"
                              : row.trigger == Trigger::on_work   ? "on_work"
                              : row.trigger == Trigger::on_device ? "on_device"
                                                                  : "background");
        record.period_ns = row.period.count();
        record.deadline_ns = row.real_time ? row.deadline().count() : 0;
        record.budget_ns = row.budget_each.count();
        record.at_most_n = static_cast<std::uint32_t>(row.at_most_n);
        record.at_most_per_ns = row.at_most_per.count();
        record.real_time = row.real_time ? 1 : 0;
        record.priority =
            row.real_time ? board.highest_priority - static_cast<int>(r_.rank[n_.activities]) : 0;
        record.processor = checks::processor_of(board, binding, row.name);
        put(room_.activities, n_.activities, record);
    }
}

constexpr void Cartographer::draw_connections() {
    for (std::size_t x = 0; x < m_.connections.size(); ++x) {
        const ConnectionRow& row = m_.connections[x];
        const Link& link = r_.connections[x];
        Connection record;
        record.from = facet_index(link.from);
        record.to = facet_index(link.to);
        const bool across = r_.activity[link.from.component] != r_.activity[link.to.component];
        record.flags = flag(row.buffered, connection_buffered) | flag(across, connection_across) |
                       flag(row.wakes_reader, connection_wakes) | flag(row.delayed_step, connection_delayed) |
                       flag(is_scaled(row), connection_scaled);
        record.capacity = static_cast<std::uint32_t>(row.capacity);
        record.max_age_ns = row.max_age.count();
        record.when_stale = text(row.when_stale == WhenStale::hold         ? "hold"
                                 : row.when_stale == WhenStale::substitute ? "substitute"
                                                                           : "stop");
        record.overflow = text(!row.buffered                      ? ""
                               : row.overflow == Overflow::reject ? "reject"
                                                                  : "drop_oldest");
        put(room_.connections, n_.connections, record);
    }
}

constexpr void Cartographer::draw_reactions() {
    for (std::size_t i = 0; i < m_.reactions.size(); ++i) {
        const ReactionRow& row = m_.reactions[i];
        const Link& link = r_.reactions[i];
        Reaction record;
        record.how = text(row.kind == ReactionKind::uses ? "uses" : row.target.synchronous ? "call" : "tell");
        record.from = facet_index(link.from);
        record.to = facet_index(link.to);
        record.quota = row.target.quota;
        record.from_activity = static_cast<std::uint32_t>(r_.activity[link.from.component]);
        record.to_activity = static_cast<std::uint32_t>(r_.activity[link.to.component]);
        put(room_.reactions, n_.reactions, record);
    }
    for (std::size_t b = 0; b < m_.behaviours.size(); ++b) {
        const BehaviourRow& row = m_.behaviours[b];
        const auto draw = [&](End event) {
            Reaction record;
            record.how = text("trigger");
            record.from = facet_index(event);
            record.behaviour = static_cast<std::uint32_t>(b);
            record.quota = trigger_quota;
            record.from_activity = static_cast<std::uint32_t>(r_.activity[event.component]);
            record.to_activity =
                static_cast<std::uint32_t>(r_.activity[find_component(m_, r_.by_name, row.component)]);
            put(room_.reactions, n_.reactions, record);
        };
        if (row.is_slot()) {
            for_each_slot_event(m_, row, draw);
            continue;
        }
        for (const std::string_view name : events_of(row.unit()).all()) {
            End event;
            static_cast<void>(checks::resolve_trigger(m_, row, name, event));
            draw(event);
        }
    }
}

constexpr void Cartographer::draw_behaviours() {
    for (const BehaviourRow& row : m_.behaviours) {
        Behaviour record;
        record.component = static_cast<std::uint32_t>(find_component(m_, r_.by_name, row.component));
        record.is_slot = row.is_slot() ? 1 : 0;
        const ScriptUnit unit = row.unit();
        for (const BehaviourInstance& each : unit.instances)
            record.states += static_cast<std::uint32_t>(unit.types[each.type].machine.states.size());
        put(room_.behaviours, n_.behaviours, record);
    }
}

constexpr void Cartographer::figure(Owner owner, std::size_t index, std::string_view name,
                                    std::string_view unit, std::string_view doc, TypeId of,
                                    std::size_t activity) {
    Figure record;
    record.owner = owner;
    record.index = static_cast<std::uint32_t>(index);
    record.name = text(name);
    record.unit = text(unit);
    record.doc = text(doc);
    record.type = type(of);
    record.activity = activity == nowhere ? none : static_cast<std::uint32_t>(activity);
    put(room_.figures, n_.figures, record);
}

constexpr void Cartographer::draw_figures() {
    figure(Owner::machine, 0, "forced", "", "ports that are forced now", type_id<std::uint32_t>, nowhere);
    for (std::size_t c = 0; c < m_.components.size(); ++c) {
        figure(Owner::component, c, "state", "", "of the component's life", type_id<ComponentState>, nowhere);
        figure(Owner::component, c, "dropped", "", "reactions that came while it did not run",
               type_id<std::uint32_t>, nowhere);
        figure(Owner::component, c, "dropped_writes", "", "to its outputs while it did not run",
               type_id<std::uint32_t>, nowhere);
    }
    for (std::size_t a = 0; a < m_.activities.size(); ++a)
        for (const EngineFigure& each : engine_figures)
            figure(Owner::activity, a, each.name, each.unit, each.doc, each.type, a);
}

constexpr void Cartographer::draw_types() {
    // A type of a field or an element is appended during this loop.
    for (std::size_t t = 0; t < types_.size(); ++t) {
        const TypeTag& tag = *types_[t];
        Type record = describe(tag);
        record.name = text(tag.name);
        record.element = type(tag.element);
        record.first_field = static_cast<std::uint32_t>(n_.fields);
        for_each_field(tag, [&](std::string_view name, std::string_view unit, TypeId of, std::size_t at) {
            put(room_.fields, n_.fields,
                Field{text(name), text(unit), type(of), static_cast<std::uint32_t>(at)});
        });
        record.field_count = static_cast<std::uint32_t>(n_.fields) - record.first_field;
        record.first_enumerator = static_cast<std::uint32_t>(n_.enumerators);
        for (std::size_t value = 0; value < tag.names.size(); ++value)
            put(room_.enumerators, n_.enumerators,
                Enumerator{text(tag.names[value]), static_cast<std::int64_t>(value)});
        record.enumerator_count = static_cast<std::uint32_t>(n_.enumerators) - record.first_enumerator;
        if (t < room_.type_ids.size()) room_.type_ids[t] = &tag;
        put(room_.types, n_.types, record);
    }
}

constexpr Counts count(const MachineView& table, const Board& board, const Binding& binding,
                       const TableIndexView& index) {
    Header header;
    Cartographer counted{table, index, {}};
    counted.draw(header, board, binding);
    return counted.counts();
}

/// Returns a header with the places of the sections for these numbers of records.
constexpr Header outline(const Counts& counts) {
    Header header;
    header.magic = magic;
    header.layout_version = layout_version;
    header.header_bytes = sizeof header;
    std::size_t at = sizeof header;
    const auto place = [&at](Section& section, std::size_t stride, std::size_t used, std::size_t room) {
        section = {static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(used),
                   static_cast<std::uint32_t>(stride), 0};
        at += stride * room;
    };
    place(header.components, sizeof(Component), counts.components, room(counts.components));
    place(header.facets, sizeof(Facet), counts.facets, room(counts.facets));
    place(header.activities, sizeof(Activity), counts.activities, room(counts.activities));
    place(header.connections, sizeof(Connection), counts.connections, room(counts.connections));
    place(header.reactions, sizeof(Reaction), counts.reactions, room(counts.reactions));
    place(header.behaviours, sizeof(Behaviour), counts.behaviours, room(counts.behaviours));
    place(header.types, sizeof(Type), counts.types, room(counts.types));
    place(header.fields, sizeof(Field), counts.fields, room(counts.fields));
    place(header.enumerators, sizeof(Enumerator), counts.enumerators, room(counts.enumerators));
    place(header.figures, sizeof(Figure), counts.figures, room(counts.figures));
    place(header.texts, sizeof(char), counts.characters, room_of_texts(counts.characters));
    header.map_bytes = at;
    return header;
}

/// Fills the room behind a header that outline() made.
constexpr void draw(Header& header, const Room& into, const MachineView& table, const Board& board,
                    const Binding& binding, const TableIndexView& index) {
    Cartographer{table, index, into}.draw(header, board, binding);
    Digest structure;
    for (const char character : into.characters) structure.add(static_cast<std::uint64_t>(character));
    for (const Connection& row : into.connections) structure.add(std::uint64_t{row.from} << 32 | row.to);
    for (const Reaction& row : into.reactions) structure.add(std::uint64_t{row.from} << 32 | row.to);
    for (const Type& row : into.types) structure.add(row.size);
    header.structure = structure.value();
}

template <Counts counts>
constexpr Drawn<counts> draw(const MachineView& table, const Board& board, const Binding& binding,
                             const TableIndexView& index) {
    Drawn<counts> drawn;
    Storage<counts>& map = drawn.map;
    map.header = outline(counts);
    draw(map.header,
         {map.components, map.facets, map.activities, map.connections, map.reactions, map.behaviours,
          map.types, map.fields, map.enumerators, map.figures, map.characters, drawn.types,
          map.header.texts.at},
         table, board, binding, index);
    return drawn;
}

} // namespace tappet::map
