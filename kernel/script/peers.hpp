// The components in reach of a script: look-up of their facets and types, and links to them.
#pragma once

#include "kernel/script/scope.hpp"

namespace tappet::script_detail {

/// A facet of a component in reach; false: none.
struct PeerFacet {
    std::uint16_t component = 0;
    std::uint16_t number = none; ///< among the component's facets
    const Facet* facet = nullptr;

    explicit constexpr operator bool() const noexcept { return facet != nullptr; }
    constexpr const Facet* operator->() const noexcept { return facet; }
    constexpr const Facet& operator*() const noexcept { return *facet; }
};

class Peers {
    // A template must be complete before a constant expression calls it.

    /// Passes each type that the interfaces in reach name to `wanted`, until it accepts one.
    template <class Wanted>
    [[nodiscard]] constexpr TypeId find_in_reach(const Wanted& wanted) const {
        for (const Reachable& component : reach_.components)
            for (const Facet& facet : component.type->facets) {
                if (facet.type == nullptr) continue;
                const TypeId result = facet.kind == FacetKind::method    ? facet.method->result
                                      : facet.kind == FacetKind::command ? facet.command->results
                                                                         : nullptr;
                for (const TypeId type : {facet.type, result})
                    if (const TypeId found = find_inside(type, wanted, 0); found != nullptr) return found;
            }
        return nullptr;
    }
    template <class Wanted>
    [[nodiscard]] static constexpr TypeId find_inside(TypeId type, const Wanted& wanted, int depth) {
        if (type == nullptr || depth == 4) return nullptr;
        if (type->kind != ValueKind::arguments && wanted(type)) return type;
        for (const TypeId each : type->elements)
            if (const TypeId found = find_inside(each, wanted, depth + 1); found != nullptr) return found;
        for (const RecordField& field : type->fields)
            if (const TypeId found = find_inside(field.type, wanted, depth + 1); found != nullptr)
                return found;
        if (type->kind == ValueKind::matrix || type->kind == ValueKind::sequence)
            return find_inside(type->element, wanted, depth + 1);
        return nullptr;
    }

public:
    constexpr Peers(Reader& text, Emitter& out, const Reach& reach) : text_{text}, out_{out}, reach_{reach} {}

    // ---- components and facets

    [[nodiscard]] constexpr std::uint16_t find(std::string_view name) const noexcept {
        if (name == "this" || name == "task") return 0;
        for (std::size_t i = 0; i < reach_.components.size(); ++i)
            if (reach_.components[i].name == name) return static_cast<std::uint16_t>(i);
        return none;
    }
    [[nodiscard]] constexpr std::string_view name_of(PeerFacet facet) const noexcept {
        return reach_.components[facet.component].name;
    }
    /// The type of the component that the script drives.
    [[nodiscard]] constexpr TypeId driven() const noexcept { return reach_.components[0].type->tag; }
    [[nodiscard]] constexpr std::span<const Facet> facets(std::uint16_t component) const noexcept {
        return reach_.components[component].type->facets;
    }
    /// Searches without the content of bags.
    [[nodiscard]] constexpr PeerFacet find_facet(std::uint16_t component, std::string_view name) const {
        return find_facet(component, name, 0, facets(component).size());
    }
    /// Parses a facet after its component's name and dot, and enters bags; false after a fault.
    constexpr PeerFacet parse_facet(std::uint16_t component, Token name) {
        const auto all = facets(component);
        std::size_t first = 0, last = all.size();
        while (text_.ok()) {
            PeerFacet found = find_facet(component, name.text, first, last);
            while (!found && is_begun(all, name.text, first, last)) {
                if (!extend(name)) return {};
                found = find_facet(component, name.text, first, last);
            }
            if (!found) {
                Nearest nearest{name.text};
                for (std::size_t i = first; i < last; i += 1 + all[i].members) nearest.consider(all[i].name);
                text_.fail(name, {"\"", reach_.components[component].name, "\" has no \"", quoted(name.text),
                                  "\"", nearest.best().empty() ? "" : "; did you mean \"", nearest.best(),
                                  nearest.best().empty() ? "" : "\"?"});
                return {};
            }
            if (found->kind != FacetKind::bag) return found;
            first = found.number + std::size_t{1};
            last = first + found->members;
            if (!text_.need(Sign::dot, "a dot and the name of a property in the bag")) return {};
            name = text_.need_word("the name of a property in the bag");
        }
        return {};
    }
    /// Parses "facet" or "component.facet" after its first word, `name`, which becomes the facet's name.
    /// False after a fault, or without one if `name` is not known.
    constexpr PeerFacet parse_facet(Token& name, std::string_view wanted) {
        std::uint16_t component = 0;
        if (text_.is(Sign::dot) && find(name.text) != none) {
            component = find(name.text);
            text_.advance();
            name = text_.need_word(wanted);
        } else if (!find_facet(0, name.text)) {
            return {};
        }
        return text_.ok() ? parse_facet(component, name) : PeerFacet{};
    }
    /// Parses the name of an event; false after a fault. `event` becomes the name without its component.
    constexpr PeerFacet parse_event(Token& event) {
        event = text_.need_word("the name of an event, if, select or after");
        std::uint16_t component = 0;
        if (text_.is(Sign::dot)) {
            component = find(event.text);
            if (component == none) {
                text_.fail_unknown(event, "component", reach_.components, "");
                return {};
            }
            text_.advance();
            event = text_.need_word("the name of an event");
        }
        const auto all = facets(component);
        while (text_.ok() && is_begun(all, event.text, 0, all.size())) static_cast<void>(extend(event));
        if (!text_.ok()) return {};
        const PeerFacet found = find_facet(component, event.text);
        if (found && found->kind == FacetKind::event) {
            check_reach(event, found, reach_.events, "events");
            return found;
        }
        Nearest nearest{event.text};
        for (const Facet& each : all)
            if (each.kind == FacetKind::event) nearest.consider(each.name);
        text_.fail_unknown(event, "event", nearest,
                           component == 0 ? " in the component itself" : " in that component");
        return {};
    }
    /// Considers the names of the components, then those of the own facets.
    constexpr void consider_all(Nearest& nearest) const {
        consider_components(nearest);
        for (const Facet& each : facets(0)) nearest.consider(each.name);
    }
    constexpr void consider_components(Nearest& nearest) const {
        for (const Reachable& each : reach_.components) nearest.consider(each.name);
    }

    // ---- permissions

    /// Checks a call in this thread: own methods and operations, those of the activity, or any_thread ones.
    constexpr void check_call(const Token& at, PeerFacet facet) {
        check_operation(at, facet);
        if (text_.ok() && !facet->any_thread && !is_near(facet))
            text_.fail(at, {"\"", quoted(facet->name), "\" of \"", name_of(facet),
                            "\" is called in its own activity only; make it any_thread, or send a command"});
        if (text_.ok() && facet->may_block)
            text_.fail(at, {"\"", quoted(facet->name), "\" of \"", name_of(facet),
                            "\" may block, and a script's statements do not; make it a command"});
    }
    /// Checks whether the script may use an operation or command of a peer at all.
    constexpr void check_operation(const Token& at, PeerFacet facet) {
        check_reach(at, facet, reach_.operations, "operations");
    }
    constexpr void check_near(const Token& at, PeerFacet facet, std::string_view what) {
        if (!is_near(facet))
            text_.fail(at, {what, " of \"", name_of(facet),
                            "\", which runs in another activity; send it a command, or connect an input"});
    }
    constexpr void fail_foreign(const Token& at, PeerFacet facet, std::string_view does) {
        text_.fail(at, {"\"", quoted(facet->name), "\" is ", to_text(facet->kind), " of \"", name_of(facet),
                        "\", which alone ", does});
    }

    // ---- links

    /// Separates the commands of programs that may run at the same time.
    constexpr void set_command_scope(std::uint16_t scope) noexcept { command_scope_ = scope; }
    constexpr std::uint16_t link(PeerFacet facet, bool needs_slot = false) {
        const std::uint16_t scope = needs_slot ? command_scope_ : std::uint16_t{0};
        for (std::size_t i = 0; i < out_.links.count(); ++i) {
            const LinkRow& row = out_.links[i];
            if (row.facet == facet.number && row.peer == facet.component && row.needs_slot == needs_slot &&
                (i >= link_scopes_.size() || link_scopes_[i] == scope))
                return static_cast<std::uint16_t>(i);
        }
        const std::uint16_t number =
            out_.add(out_.links, {facet.component, facet.number, needs_slot}, "links to facets");
        if (number < link_scopes_.size())
            link_scopes_[number] = scope;
        else if (needs_slot)
            text_.fail_limit("links to facets before a command of a peer");
        return number;
    }
    /// Emits the action of a facet.
    constexpr void act(const FacetAction& action, PeerFacet facet, DataOffset to, DataOffset a) {
        if (!text_.ok()) return;
        Instruction in = action.instruction;
        in.to = to;
        in.a = a;
        in.link = link(facet);
        out_.emit(in);
    }

    // ---- types

    /// Returns null when there is no such type; reports no fault.
    [[nodiscard]] constexpr TypeId find_type(std::string_view name) const {
        if (name == "int") return script_int;
        if (name == "double") return script_double;
        if (name == "bool") return script_bool;
        if (name == "duration" || name == "Duration") return script_duration;
        if (name == "text" || name == "string") return script_text;
        std::size_t rows = 0, columns = 0;
        if (read_shape(name, rows, columns)) {
            if (const TypeId known = matrix_type(rows, columns); known != nullptr) return known;
            return find_in_reach([&](TypeId type) {
                return type->kind == ValueKind::matrix && type->element == script_double &&
                       type->rows == rows && type->columns == columns;
            });
        }
        return find_in_reach([&](TypeId type) {
            return (type->kind == ValueKind::record || type->kind == ValueKind::enumeration ||
                    type->kind == ValueKind::opaque || type->kind == ValueKind::sequence) &&
                   is_named(type, name);
        });
    }
    constexpr TypeId parse_type() {
        const Token name =
            text_.need_word("a type: bool, int, double, duration, text, vector3, matrix3x3 or one "
                            "that a component in reach uses");
        if (!text_.ok()) return nullptr;
        const TypeId type = find_type(name.text);
        if (type == nullptr) {
            Nearest nearest{name.text};
            for (const std::string_view each : {"int", "double", "bool", "duration", "text"})
                nearest.consider(each);
            static_cast<void>(find_in_reach([&](TypeId each) {
                if (each->kind == ValueKind::record || each->kind == ValueKind::enumeration)
                    nearest.consider(short_name(each->name));
                return false;
            }));
            text_.fail_unknown(name, "type", nearest, " to the components in reach");
        }
        return type;
    }

private:
    [[nodiscard]] constexpr bool is_near(PeerFacet facet) const noexcept {
        return facet.component == 0 || reach_.components[facet.component].same_activity;
    }
    /// Searches from `first` up to but not including `last`, without the content of bags.
    [[nodiscard]] constexpr PeerFacet find_facet(std::uint16_t component, std::string_view name,
                                                 std::size_t first, std::size_t last) const noexcept {
        const auto all = facets(component);
        for (std::size_t i = first; i < last; i += 1 + all[i].members)
            if (all[i].name == name) return {component, static_cast<std::uint16_t>(i), &all[i]};
        return {};
    }
    /// Returns whether a dot follows and a facet's name begins with these words, as in "line.rises".
    [[nodiscard]] constexpr bool is_begun(std::span<const Facet> all, std::string_view words,
                                          std::size_t first, std::size_t last) const noexcept {
        if (!text_.is(Sign::dot)) return false;
        for (std::size_t i = first; i < last; i += 1 + all[i].members)
            if (all[i].name.size() > words.size() && all[i].name.starts_with(words) &&
                all[i].name[words.size()] == '.')
                return true;
        return false;
    }
    /// Reads the next word of such a name.
    constexpr bool extend(Token& name) {
        text_.advance();
        const Token next = text_.need_word("the rest of the name");
        if (text_.ok()) name.text = {name.text.data(), next.text.data() + next.text.size()};
        return text_.ok();
    }
    constexpr void check_reach(const Token& at, PeerFacet facet, std::span<const std::string_view> allowed,
                               std::string_view what) {
        if (!reach_.limited || facet.component == 0) return;
        const std::string_view peer = name_of(facet), name = facet->name;
        for (const std::string_view each : allowed)
            if (each.size() == peer.size() + 1 + name.size() && each.starts_with(peer) &&
                each[peer.size()] == '.' && each.ends_with(name))
                return;
        text_.fail(at, {"\"", peer, ".", name, "\" is not in the reach of this slot; add it to ", what,
                        "(...) of the slot's row"});
    }
    static constexpr bool is_named(TypeId type, std::string_view name) noexcept {
        const std::string_view own = short_name(type->name);
        return own.size() == name.size() && lower_case(own[0]) == lower_case(name[0]) &&
               own.substr(1) == name.substr(1);
    }
    /// Parses "vector3", "matrix2x3".
    static constexpr bool read_shape(std::string_view name, std::size_t& rows,
                                     std::size_t& columns) noexcept {
        const auto digit = [&](std::size_t i) {
            return i < name.size() && is_digit(name[i]) ? static_cast<std::size_t>(name[i] - '0') : 0;
        };
        if (name.size() == 7 && name.starts_with("vector"))
            rows = digit(6), columns = 1;
        else if (name.size() == 9 && name.starts_with("matrix") && name[7] == 'x')
            rows = digit(6), columns = digit(8);
        return rows != 0 && columns != 0;
    }

    Reader& text_;
    Emitter& out_;
    const Reach& reach_;
    std::array<std::uint16_t, 256> link_scopes_{};
    std::uint16_t command_scope_ = 0;
};

} // namespace tappet::script_detail
