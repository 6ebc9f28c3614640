// Name look-up in a script: its own variables, constants, functions and machines, then the components in
// reach and their facets.
#pragma once

#include "kernel/script/compiler_output.hpp"

namespace tappet::script_detail {

/// The value of a variable, or a value known at compile time.
struct Operand {
    TypeId type = nullptr;
    DataOffset at = no_data;
    bool literal =
        false; ///< it is stored below, not in the data: bools, numbers, times, texts, names of values
    bool constant = false; ///< its bytes are among the constants
    bool simple = false;   ///< made by the last instruction, whole and in the scratch: the instruction may
                           ///< write it elsewhere
    std::int64_t integer = 0;
    double real = 0;
    std::string_view text{};

    [[nodiscard]] constexpr bool valid() const noexcept { return type != nullptr; }
};

enum class SymbolKind : std::uint8_t { variable, value, function, machine };

struct Symbol {
    std::string_view name{};
    std::uint32_t hash = 0;
    SymbolKind kind = SymbolKind::variable;
    bool fixed = false;       ///< not assignable: a constant, the counter of a bounded loop
    std::uint16_t number = 0; ///< of a function or a child machine
    Operand operand{};
};

/// Functions are expanded at each call; this stores where to read them.
struct Function {
    std::string_view name{};
    Lexer lexer{}; ///< after its opening bracket
    Token token{}; ///< the first token there
    TypeId result = nullptr;
    bool is_value = false; ///< its body is one return: usable in an expression
    bool expanding = false;
    std::uint16_t symbols = 0; ///< it sees the first so many symbols
};

/// A value given to a parameter: scalars and texts.
struct Argument {
    TypeIndex type = 0; ///< the parameter's owner
    std::uint16_t variable = 0;
    Operand value{};
};
/// "SubStateMachine Type name(arguments)" in a machine.
struct Child {
    std::string_view name{};
    TypeIndex parent = 0;
    TypeIndex type = 0;
    std::uint16_t number = 0; ///< among its parent's children
    std::uint16_t first_argument = 0;
    std::uint16_t arguments = 0;
};

class Names : protected Output {
protected:
    using Output::Output;
    static constexpr std::uint16_t none = 0xffff;

    // ---- the script's own names

    constexpr void declare(const Token& name, const Symbol& as) {
        if (!ok()) return;
        for (std::size_t i = scope_; i < symbols_used_; ++i)
            if (symbols_[i].hash == name.hash && symbols_[i].name == name.text)
                return fail(name, {"\"", quoted(name.text), "\" is there twice; rename one"});
        if (symbols_used_ == symbols_.size()) return fail_limit("names in sight at one place");
        Symbol& symbol = symbols_[symbols_used_++];
        symbol = as;
        symbol.name = name.text;
        symbol.hash = name.hash;
    }
    /// Returns the innermost symbol; a function sees its own names and the enclosing ones, not its caller's.
    [[nodiscard]] constexpr Symbol* find_symbol(const Token& name) {
        for (std::size_t i = symbols_used_; i-- > 0;) {
            if (i < hidden_end_ && i >= hidden_begin_) {
                i = hidden_begin_;
                if (i-- == 0) break;
            }
            if (symbols_[i].hash == name.hash && symbols_[i].name == name.text) return &symbols_[i];
        }
        return nullptr;
    }

    /// Returns a program that is defined before; no_instance: none has that name.
    [[nodiscard]] constexpr InstanceIndex find_program(std::string_view name) const noexcept {
        for (std::size_t i = 0; i < instances_.used; ++i)
            if (instances_.room[i].name == name && types_.room[instances_.room[i].type].is_program())
                return static_cast<InstanceIndex>(i);
        return no_instance;
    }

    // ---- components and facets

    [[nodiscard]] constexpr std::uint16_t find_component(std::string_view name) const noexcept {
        if (name == "this" || name == "task") return 0;
        for (std::size_t i = 0; i < reach_.components.size(); ++i)
            if (reach_.components[i].name == name) return static_cast<std::uint16_t>(i);
        return none;
    }
    [[nodiscard]] constexpr std::span<const Facet> facets(std::uint16_t component) const noexcept {
        return reach_.components[component].type->facets;
    }
    [[nodiscard]] constexpr bool is_near(std::uint16_t component) const noexcept {
        return component == 0 || reach_.components[component].same_activity;
    }
    /// Searches from `first` up to but not including `last`, without the content of bags.
    [[nodiscard]] static constexpr std::uint16_t find_facet(std::span<const Facet> all, std::string_view name,
                                                            std::size_t first, std::size_t last) noexcept {
        for (std::size_t i = first; i < last; i += 1 + all[i].members)
            if (all[i].name == name) return static_cast<std::uint16_t>(i);
        return none;
    }
    [[nodiscard]] constexpr std::uint16_t find_facet(std::uint16_t component,
                                                     std::string_view name) const noexcept {
        const auto all = facets(component);
        return find_facet(all, name, 0, all.size());
    }
    /// Returns whether a facet's name begins with these words, as in "line.rises", "frame.received".
    [[nodiscard]] static constexpr bool is_begun(std::span<const Facet> all, std::string_view words,
                                                 std::size_t first, std::size_t last) noexcept {
        for (std::size_t i = first; i < last; i += 1 + all[i].members)
            if (all[i].name.size() > words.size() && all[i].name.starts_with(words) &&
                all[i].name[words.size()] == '.')
                return true;
        return false;
    }
    /// Reads the next word of such a name.
    constexpr bool extend(Token& name) {
        advance();
        const Token next = need_word("the rest of the name");
        if (ok()) name.text = {name.text.data(), next.text.data() + next.text.size()};
        return ok();
    }
    /// Parses a facet after its component's name and dot, and enters bags; `none` after a fault.
    constexpr std::uint16_t parse_facet(std::uint16_t component, Token name) {
        const auto all = facets(component);
        std::size_t first = 0, last = all.size();
        while (ok()) {
            std::uint16_t found = find_facet(all, name.text, first, last);
            while (found == none && is(Sign::dot) && is_begun(all, name.text, first, last)) {
                if (!extend(name)) return none;
                found = find_facet(all, name.text, first, last);
            }
            if (found == none) {
                Nearest nearest{name.text};
                for (std::size_t i = first; i < last; i += 1 + all[i].members) nearest.consider(all[i].name);
                fail(name, {"\"", reach_.components[component].name, "\" has no \"", quoted(name.text), "\"",
                            nearest.best().empty() ? "" : "; did you mean \"", nearest.best(),
                            nearest.best().empty() ? "" : "\"?"});
                return none;
            }
            if (all[found].kind != FacetKind::bag) return found;
            first = found + std::size_t{1};
            last = first + all[found].members;
            if (!need(Sign::dot, "a dot and the name of a property in the bag")) return none;
            name = need_word("the name of a property in the bag");
        }
        return none;
    }
    /// Checks whether the script may use an operation or event of a peer at all.
    constexpr void check_reach(const Token& at, std::uint16_t component, std::string_view name,
                               std::span<const std::string_view> allowed, std::string_view what) {
        if (!reach_.limited || component == 0) return;
        const std::string_view peer = reach_.components[component].name;
        for (const std::string_view each : allowed)
            if (each.size() == peer.size() + 1 + name.size() && each.starts_with(peer) &&
                each[peer.size()] == '.' && each.ends_with(name))
                return;
        fail(at, {"\"", peer, ".", name, "\" is not in the reach of this slot; add it to ", what,
                  "(...) of the slot's row"});
    }
    constexpr void check_near(const Token& at, std::uint16_t component, std::string_view what) {
        if (!is_near(component))
            fail(at, {what, " of \"", reach_.components[component].name,
                      "\", which runs in another activity; send it a command, or connect an input"});
    }
    constexpr void fail_foreign(const Token& at, std::uint16_t component, const Facet& facet,
                                std::string_view does) {
        fail(at, {"\"", quoted(facet.name), "\" is ", to_text(facet.kind), " of \"",
                  reach_.components[component].name, "\", which alone ", does});
    }
    /// The scope separates the commands of programs that may run at the same time.
    constexpr std::uint16_t link(std::uint16_t component, std::uint16_t facet, bool needs_slot) {
        const std::uint16_t scope = needs_slot ? command_scope_ : std::uint16_t{0};
        for (std::size_t i = 0; i < links_.count(); ++i) {
            const LinkRow& row = links_[i];
            if (row.facet == facet && row.peer == component && row.needs_slot == needs_slot &&
                (i >= link_scopes_.size() || link_scopes_[i] == scope))
                return static_cast<std::uint16_t>(i);
        }
        const std::uint16_t number = add(links_, {component, facet, needs_slot}, "links to facets");
        if (number < link_scopes_.size())
            link_scopes_[number] = scope;
        else if (needs_slot)
            fail_limit("links to facets before a command of a peer");
        return number;
    }

    // ---- types

    static constexpr bool is_named(TypeId type, std::string_view name) noexcept {
        const std::string_view own = short_name(type->name);
        return own.size() == name.size() && lower_case(own[0]) == lower_case(name[0]) &&
               own.substr(1) == name.substr(1);
    }
    static constexpr bool is_shape(TypeId type, std::size_t rows, std::size_t columns) noexcept {
        return type->kind == ValueKind::matrix && type->element == script_double && type->rows == rows &&
               type->columns == columns;
    }

    /// Passes each type that the interfaces in reach name to `wanted`, until it accepts one.
    template <class Wanted>
    [[nodiscard]] constexpr TypeId find_in_reach(const Wanted& wanted) const {
        for (const Reachable& component : reach_.components)
            for (const Facet& facet : component.type->facets) {
                if (facet.type == nullptr) continue;
                if (const TypeId found = find_inside(facet.type, wanted, 0); found != nullptr) return found;
                if (facet.kind == FacetKind::method)
                    if (const TypeId found = find_inside(facet.method->result, wanted, 0); found != nullptr)
                        return found;
                if (facet.kind == FacetKind::command)
                    if (const TypeId found = find_inside(facet.command->results, wanted, 0); found != nullptr)
                        return found;
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
            return find_in_reach([&](TypeId type) { return is_shape(type, rows, columns); });
        }
        return find_in_reach([&](TypeId type) {
            return (type->kind == ValueKind::record || type->kind == ValueKind::enumeration ||
                    type->kind == ValueKind::opaque || type->kind == ValueKind::sequence) &&
                   is_named(type, name);
        });
    }
    constexpr TypeId parse_type() {
        const Token name = need_word("a type: bool, int, double, duration, text, vector3, matrix3x3 or one "
                                     "that a component in reach uses");
        if (!ok()) return nullptr;
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
            fail_unknown(name, "type", nearest, " to the components in reach");
        }
        return type;
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

    bool is_line_ = false;    ///< typed by a user at a browser: values it reads stay fresh for components
    bool looks_only_ = false; ///< an expression of such a line: it changes nothing

    std::array<Symbol, 160> symbols_{};
    std::size_t symbols_used_ = 0;
    std::size_t scope_ = 0;        // first name of the innermost block
    std::size_t hidden_begin_ = 0; // names that a function does not see
    std::size_t hidden_end_ = 0;
    std::array<Function, 48> functions_{};
    std::size_t functions_used_ = 0;
    std::array<Child, 32> children_{};
    std::size_t children_used_ = 0;
    std::array<Argument, 48> arguments_{};
    std::size_t arguments_used_ = 0;
    std::array<std::uint16_t, 256> link_scopes_{};
    std::uint16_t command_scope_ = 0;
};

} // namespace tappet::script_detail
