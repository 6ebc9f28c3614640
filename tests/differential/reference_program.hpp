// The second interpreter's programs: the tree is walked with a stack of open blocks, values carry their types
// along, whole numbers are computed in 128 bits and then looked at.
#pragma once

#include "tests/differential/reference_syntax.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tappet::reference {

enum class Answer : std::uint8_t { no, yes, failed };

/// What a program acts on. A name is dotted: "arm.move", and of the own component without one.
class World {
public:
    enum class Kind : std::uint8_t { unknown, value, method, command, sent_command, event };

    World() = default;
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    virtual ~World() = default;

    [[nodiscard]] virtual Kind kind_of(const std::string& name) const = 0;
    /// A property or a port; nothing: it failed.
    virtual std::optional<Value> read(const std::string& name) = 0;
    virtual bool write(const std::string& name, const Value& value) = 0;
    /// A method, an operation, or an event to be emitted.
    virtual std::optional<Value> call(const std::string& name, const std::vector<Value>& arguments) = 0;
    /// The own component's command.
    virtual bool begin(const std::string& name, const std::vector<Value>& arguments) = 0;
    virtual Answer progress(const std::string& name, const std::vector<Value>& arguments) = 0;
    /// Another one's: false while an earlier one is on its way. Of each there is one for every program that
    /// may be at work at the same time.
    virtual bool send(const std::string& name, const std::vector<Value>& arguments) = 0;
    virtual Answer ended(const std::string& name) = 0;
};

/// What a name means inside of one behaviour: its variables, and what stands around it.
struct Scope {
    World* world = nullptr;
    std::map<std::string, Value> values{};
    std::map<std::string, std::string> types{};
    const std::vector<Function>* functions = nullptr;
    const std::vector<Function>* outer_functions = nullptr;

    [[nodiscard]] const Function* function(const std::string& name) const;
};

std::optional<Value> evaluate(Scope& scope, const Expression& expression);
/// A value on its way into a variable or an argument of that type.
std::optional<Value> convert(const Value& value, const std::string& type);
Value zero_of(const std::string& type);
std::string print(const Value& value);

/// One program on its way. It may be dropped at any time.
class ProgramRun {
public:
    enum class Result : std::uint8_t { ended, waits, left_over, failed };

    void start(const Block* block) {
        open_.clear();
        open_.push_back({.block = block});
        entered_ = acted_ = false;
    }
    [[nodiscard]] bool is_on() const { return !open_.empty(); }
    void drop() { open_.clear(); }
    Result run(Scope& scope, std::int64_t now, std::int64_t& statements);
    /// Of the statement that failed, or that waits.
    [[nodiscard]] int line() const { return line_; }
    static std::map<std::string, std::size_t>& covered();

private:
    struct Open {
        const Block* block = nullptr;
        std::size_t next = 0;
        const Statement* owner = nullptr; ///< a loop, what is tried, or a call
        bool is_increment = false;
        bool is_call = false;
        std::string result_into{};
    };
    enum class Done : std::uint8_t { next, elsewhere, wait, failed };

    Done execute(Scope& scope, const Statement& statement, std::int64_t now);
    Done perform(Scope& scope, const Statement& statement, std::int64_t now);
    bool recover();

    std::vector<Open> open_{};
    std::int64_t time_limit_ = 0; ///< of a wait
    bool entered_ = false;        ///< the statement in hand
    bool acted_ = false;
    std::vector<Value> given_{};
    std::int64_t entered_at_ = 0;
    int line_ = 0;
};

/// Notes that something was covered.
inline void count(const std::string& what) { ++ProgramRun::covered()[what]; }

} // namespace tappet::reference
