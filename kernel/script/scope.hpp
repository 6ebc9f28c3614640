// The script's own names and where they are visible: variables, constants, functions, child machines.
#pragma once

#include "kernel/script/values.hpp"

namespace tappet::script_detail {

inline constexpr std::uint16_t none = 0xffff;

enum class SymbolKind : std::uint8_t { variable, value, function, machine };

struct Symbol {
    std::string_view name{};
    std::uint32_t hash = 0;
    SymbolKind kind = SymbolKind::variable;
    bool fixed = false;       ///< not assignable: a constant, the counter of a bounded loop
    std::uint16_t number = 0; ///< of a function or a child machine
    Operand operand{};

    [[nodiscard]] constexpr bool assignable() const noexcept {
        return kind == SymbolKind::variable && !fixed;
    }
};
constexpr Symbol fixed_symbol(SymbolKind kind, std::size_t number) noexcept {
    return {.kind = kind, .fixed = true, .number = static_cast<std::uint16_t>(number)};
}
/// A constant or an argument.
constexpr Symbol fixed_symbol(const Operand& value) noexcept {
    return {.kind = SymbolKind::value, .fixed = true, .operand = value};
}

/// Functions are expanded at each call; this stores where to read them.
struct Function {
    std::string_view name{};
    Reader::Place parameters{}; ///< after its opening bracket
    TypeId result = nullptr;
    bool is_value = false; ///< its body is one return: usable in an expression
    bool expanding = false;
    std::uint16_t symbols = 0; ///< it sees the first so many symbols; none: those before the program
};

class Scope {
public:
    explicit constexpr Scope(Reader& text) : text_{text} {}

    /// The names visible at one place.
    struct Mark {
        std::size_t used = 0;
        std::size_t block = 0;        ///< first name of the innermost block
        std::size_t hidden_begin = 0; ///< names that a function does not see
        std::size_t hidden_end = 0;
    };
    [[nodiscard]] constexpr const Mark& mark() const noexcept { return now_; }
    /// Opens a block; pass the returned mark to close().
    constexpr Mark open() noexcept {
        const Mark outer = now_;
        now_.block = now_.used;
        return outer;
    }
    constexpr void close(const Mark& outer) noexcept { now_ = outer; }

    [[nodiscard]] constexpr std::span<Symbol> symbols() noexcept {
        return std::span{symbols_}.first(now_.used);
    }
    constexpr void declare(const Token& name, const Symbol& as) {
        if (!text_.ok()) return;
        for (const Symbol& each : symbols().subspan(now_.block))
            if (each.hash == name.hash && each.name == name.text)
                return text_.fail(name, {"\"", quoted(name.text), "\" is there twice; rename one"});
        add(as, name.text, name.hash);
    }
    /// Returns the innermost symbol, or null; a function sees its own names and the enclosing ones, not its
    /// caller's.
    [[nodiscard]] constexpr Symbol* find(const Token& name) {
        for (std::size_t i = now_.used; i-- > 0;) {
            if (i < now_.hidden_end && i >= now_.hidden_begin) {
                i = now_.hidden_begin;
                if (i-- == 0) break;
            }
            if (symbols_[i].hash == name.hash && symbols_[i].name == name.text) return &symbols_[i];
        }
        return nullptr;
    }
    constexpr void consider_all(Nearest& nearest) {
        for (const Symbol& each : symbols()) nearest.consider(each.name);
    }

    // ---- functions

    [[nodiscard]] constexpr std::span<Function> functions() noexcept {
        return std::span{functions_}.first(functions_used_);
    }
    constexpr void declare(const Token& name, const Function& function) {
        if (functions_used_ == functions_.size()) text_.fail_limit("functions");
        if (!text_.ok()) return;
        functions_[functions_used_++] = function;
        declare(name, fixed_symbol(SymbolKind::function, functions_used_ - 1));
    }
    constexpr void forget_functions(std::size_t but_first) noexcept { functions_used_ = but_first; }
    /// Functions of a type see the names that are visible now.
    constexpr void begin_program() noexcept { before_program_ = now_.used; }

    /// Declares an argument of a function; it is visible from enter() on.
    constexpr void add_argument(std::string_view name, const Operand& value) {
        add(fixed_symbol(value), name, 0);
    }
    /// Hides the names of the function's caller, whose first argument is the symbol `first`.
    constexpr void enter(const Function& function, std::size_t first) noexcept {
        for (Symbol& each : symbols().subspan(first)) {
            const std::uint32_t hash = hash_of(each.name);
            each.hash = hash != 0 ? hash : 1;
        }
        now_.hidden_begin = function.symbols == none ? before_program_ : function.symbols;
        now_.hidden_end = now_.block = first;
    }

private:
    constexpr void add(const Symbol& as, std::string_view name, std::uint32_t hash) {
        if (now_.used == symbols_.size()) return text_.fail_limit("names in sight at one place");
        Symbol& symbol = symbols_[now_.used++];
        symbol = as;
        symbol.name = name;
        symbol.hash = hash;
    }

    Reader& text_;
    std::array<Symbol, 160> symbols_{};
    Mark now_{};
    std::size_t before_program_ = 0;
    std::array<Function, 48> functions_{};
    std::size_t functions_used_ = 0;
};

} // namespace tappet::script_detail
