// The second interpreter's programs: it walks the tree with a stack of open blocks, values carry their types,
// and whole numbers are computed in 128 bits and then checked.
#pragma once

#include "tests/differential/reference_syntax.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tappet::reference {

enum class Answer : std::uint8_t { no, yes, failed };

/// The facets that a program acts on. A name is dotted, "arm.move"; names of the own component have no dot.
class World {
public:
    enum class Kind : std::uint8_t { unknown, value, method, command, sent_command, event };

    World() = default;
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    virtual ~World() = default;

    [[nodiscard]] virtual Kind kind_of(const std::string& name) const = 0;
    /// Reads a property or a port; nothing: it failed.
    virtual std::optional<Value> read(const std::string& name) = 0;
    virtual bool write(const std::string& name, const Value& value) = 0;
    /// Calls a method or an operation, or emits an event.
    virtual std::optional<Value> call(const std::string& name, const std::vector<Value>& arguments) = 0;
    /// Begins a command of the own component.
    virtual bool begin(const std::string& name, const std::vector<Value>& arguments) = 0;
    virtual Answer progress(const std::string& name, const std::vector<Value>& arguments) = 0;
    /// Sends a command to another component; returns false while an earlier one is pending. Each program that
    /// may run at the same time has its own slot.
    virtual bool send(const std::string& name, const std::vector<Value>& arguments) = 0;
    virtual Answer ended(const std::string& name) = 0;
};

/// Names with their values and types.
struct Variables {
    std::map<std::string, Value> values{};
    std::map<std::string, std::string> types{};

    void declare(const std::string& name, const std::string& type, const Value& value) {
        types[name] = type;
        values[name] = value;
    }
};

class ProgramRun;

/// The meaning of names inside one behaviour: its variables, and those around it.
struct Scope : Variables {
    World* world = nullptr;
    const std::vector<Function>* functions = nullptr;
    const std::vector<Function>* outer_functions = nullptr;
    ProgramRun* run = nullptr; ///< running; its own variables are nearer

    std::vector<Variables*> given{}; ///< of the functions that are being evaluated, nearest last

    [[nodiscard]] const Function* function(const std::string& name) const;
    /// Returns the variables that contain the nearest one of that name; null: there is none.
    [[nodiscard]] Variables* holder(const std::string& name);
};

std::optional<Value> evaluate(Scope& scope, const Expression& expression);
/// Converts a value for a variable or an argument of that type.
std::optional<Value> convert(const Value& value, const std::string& type);
/// Converts a whole number to the field of the record that holds one; nothing: it does not fit.
std::optional<std::int64_t> turns_of(const Value& value);
Value zero_of(const std::string& type);
std::string print(const Value& value);

/// One running program. It may be dropped at any time. It owns the arguments and variables of its blocks and
/// of the functions that it is in: other programs that call the same function meanwhile have theirs.
class ProgramRun {
public:
    enum class Result : std::uint8_t { ended, waits, left_over, failed };

    /// Starts a program. When it stands alone, its outermost variables are the behaviour's, which are its
    /// properties.
    void start(const Block* block, bool stands_alone = false, const std::string& result = {}) {
        open_.clear();
        open_.push_back({.block = block});
        entered_ = acted_ = again_ = catches_ = false;
        stands_alone_ = stands_alone;
        result_type_ = result;
    }
    [[nodiscard]] bool is_on() const { return !open_.empty(); }
    void drop() { open_.clear(); }
    Result run(Scope& scope, std::int64_t now, std::int64_t& statements);
    /// Returns the variables of that name in the blocks around the statement in hand, up to the call or the
    /// program; null: there are none.
    [[nodiscard]] Variables* holder(const std::string& name);
    /// Line of the statement that failed or waits.
    [[nodiscard]] int line() const { return line_; }
    [[nodiscard]] const Value& result() const { return result_; }
    static std::map<std::string, std::size_t>& covered();

private:
    struct Open {
        const Block* block = nullptr;
        std::size_t next = 0;
        const Statement* owner = nullptr; ///< a loop, a try block, or a call
        bool is_increment = false;
        bool is_call = false;
        const Function* function = nullptr; ///< the called function
        Variables own{};
    };
    enum class Done : std::uint8_t { next, elsewhere, wait, failed };

    Done execute(Scope& scope, const Statement& statement, std::int64_t now);
    static Done set_part(Value& variable, const std::string& name, const Value& value);
    Done perform(Scope& scope, const Statement& statement, std::int64_t now);
    Done assign(Scope& scope, const Statement& statement);
    Done wait(Scope& scope, const Statement& statement, std::int64_t now);
    bool take_arguments(Scope& scope, const Expression& call);
    Done perform_command(Scope& scope, const Statement& statement, std::int64_t now);
    bool recover();
    static bool counts(const Scope& scope, const Statement& statement);

    std::vector<Open> open_{};
    std::int64_t time_limit_ = 0; ///< of a wait
    bool entered_ = false;        ///< the statement in hand
    bool acted_ = false;
    bool again_ = false;   ///< it could not act yet: retrying is a statement
    bool catches_ = false; ///< a failure leads there
    std::vector<Value> given_{};
    Value result_{};
    std::string result_type_{}; ///< of the program
    std::int64_t entered_at_ = 0;
    int line_ = 0;
    bool stands_alone_ = false;
};

/// Counts a covered kind.
inline void count(const std::string& what) { ++ProgramRun::covered()[what]; }

} // namespace tappet::reference
