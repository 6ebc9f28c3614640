// Random scripts for the components of bench.hpp: programs that wait, fail and are caught, commands that are
// rejected, state machines with every kind of transition. The same seed gives the same text everywhere.
#pragma once

#include "kernel/base/random.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tappet {

struct GeneratorOptions {
    int states = 6;
    bool nested = true;   ///< composite states, regions and history
    bool children = true; ///< child state machines
    bool machine = true;  ///< false: only a program
};

class Generator {
public:
    Generator(std::uint64_t seed, GeneratorOptions options) : random_{seed}, options_{options} {}

    /// One script: a root state machine "m", or a program "m".
    std::string script();

private:
    enum class Kind : std::uint8_t { integer, real, boolean, time, vector, record, text };
    struct Named {
        std::string name;
        Kind kind;
        bool writable = true;
    };
    struct Planned {
        std::string name;
        int parent = -1;
        std::string region;
        bool initial = false;
        bool final = false;
        bool composite = false;
        bool has_regions = false;
    };

    // ---- text
    void line(const std::string& text) { text_.append(depth_ * 4, ' ').append(text).append("\n"); }
    void open(const std::string& text) { line(text + " {"), ++depth_; }
    void close() { --depth_, line("}"); }

    // ---- draws
    bool one_in(std::uint64_t n) { return random_.one_in(n); }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_.below(n)); }
    template <class List>
    const auto& any(const List& list) {
        return list[below(std::size(list))];
    }
    static std::string_view type_of(Kind kind);

    // ---- expressions
    std::string literal(Kind kind);
    std::string expression(Kind kind, int depth);
    std::string whole(int depth);
    std::string real(int depth);
    std::string truth(int depth);
    std::string time(int depth);
    std::string vector(int depth);
    const Named* variable(Kind kind, bool to_write);
    std::string goal();
    std::string argument();

    // ---- programs
    void block(int statements, int depth, bool may_wait);
    void statement(int depth, bool may_wait);
    void waiting(int depth);
    void call();
    void command();
    void assignment();
    void loop(int depth, bool may_wait);
    void child_call();
    void whole_value();
    void functions();
    void program_of(std::string_view what, std::uint64_t seldom, bool may_wait);

    // ---- state machines
    void declare(std::string_view word, Kind kind, const std::string& name);
    void variables();
    void child_type();
    void aid();
    void machine();
    void plan();
    void state(std::size_t index);
    void transitions(std::size_t index);
    void event_transition(std::size_t index, std::string_view event, const std::string& always);
    [[nodiscard]] std::size_t depth_of(std::size_t index) const;
    void condition_transition(std::size_t index, bool always);
    std::string target(std::size_t from);
    std::string select(std::size_t from);
    [[nodiscard]] std::vector<std::size_t> inside(int parent, const std::string& region) const;

    Random random_;
    GeneratorOptions options_;
    std::string text_;
    std::size_t depth_ = 0;
    std::vector<Named> names_;
    std::vector<Planned> states_;
    std::vector<std::string> functions_;
    bool has_value_functions_ = false; ///< half(int) in expressions, pick(double, int) after "="
    bool has_child_ = false;
    bool in_child_ = false;
    bool in_function_ = false;
    bool returns_value_ = false;
    Kind returned_ = Kind::real;
    bool has_aid_ = false; ///< program int aid(int, bool), which the machine commands
    int counters_ = 0;
    int loops_ = 0; ///< around the statement
};

} // namespace tappet
