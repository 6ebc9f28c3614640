// A second reader of the script language, for comparison with the first: it turns the text into a tree on the
// heap. It shares nothing with the script compiler, and accepts good scripts only: at a fault it names the
// place and aborts.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tappet::reference {

/// Nanoseconds, distinct from whole numbers.
struct Span {
    std::int64_t ns = 0;
    auto operator<=>(const Span&) const = default;
};
using Vector = std::vector<double>;
struct Record {
    double x = 0;
    std::int64_t turns = 0;
};
using Value = std::variant<std::monostate, bool, std::int64_t, double, Span, Vector, std::string, Record>;
/// Name for the result of the last function that has statements.
inline constexpr std::string_view result_of_call = "result of the call";
/// Name for the result of the program beside.
inline constexpr std::string_view result_of_program = "result of the program";

struct Expression {
    enum class Kind : std::uint8_t { literal, name, call, unary, binary, element };
    Kind kind = Kind::literal;
    Value value{};
    std::string text{}; ///< the dotted name, or the operator
    std::vector<Expression> parts{};
};

struct Statement;
using Block = std::vector<Statement>;

struct Statement {
    enum class Kind : std::uint8_t {
        declare,
        assign,
        perform, ///< do
        branch,
        loop, ///< while and for
        leave,
        yield,
        wait,
        guarded, ///< try .. catch
        pause    ///< break
    };
    Kind kind = Kind::perform;
    std::string text{};                ///< the name that is assigned or declared
    std::string type{};                ///< of a declaration
    std::vector<Expression> indices{}; ///< of the assigned element
    std::vector<Expression> expressions{};
    Block first{};  ///< then, the body, the try block, the initialisation of a for
    Block second{}; ///< else, the catch block, the increment of a for
    Expression timeout{};
    bool has_timeout = false;
    bool counts = true; ///< a constant is known before, and "try" only names the target of a failure
    int line = 0;
};

struct Transition {
    std::string event{}; ///< empty: a condition
    bool timed = false;
    Expression after{};
    std::vector<std::string> captures{};
    bool has_guard = false;
    Expression guard{};
    Block then{};
    std::string to{};     ///< empty: internal
    std::string enters{}; ///< "", "history", "deep history"
    bool has_otherwise = false;
    Block otherwise{};
    std::string otherwise_to{};
};

struct State {
    std::string name{};
    std::string parent{};
    std::string region{};
    bool initial = false;
    bool final = false;
    std::vector<Expression> preconditions{};
    Block entry{}, run{}, exit{}, handle{};
    std::vector<Transition> transitions{};
};

struct Variable {
    std::string name{};
    std::string type{};
    std::string kind{}; ///< "param", "var" or "const"
    bool has_initial = false;
    Expression initial{};
};

struct Instance {
    std::string type{};
    std::string name{};
    std::vector<Expression> arguments{};
};

struct Function {
    std::string name{};
    std::string result{}; ///< empty: none
    std::vector<Variable> parameters{};
    Block body{};
};

/// A StateMachine, or a program: a program has a body and no states.
struct Type {
    std::string name{};
    std::vector<Variable> variables{};
    std::vector<State> states{};
    std::vector<Instance> children{};
    std::vector<Function> functions{};
    bool is_program = false;
    bool on_command = false; ///< a program with parameters
    std::string result{};    ///< of a program with parameters; empty: none
    Block body{};
};

struct Script {
    std::vector<Type> types{};
    std::vector<Instance> roots{};
    std::vector<Function> functions{};
};

Script read(std::string_view text);

} // namespace tappet::reference
