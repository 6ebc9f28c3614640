// The second interpreter's state machines: a queue of acts holds the pending work, and states are found by
// walking the tree. Written from the table of the order of everything in kernel/statechart, without its code.
#pragma once

#include "tests/differential/reference_program.hpp"

#include <deque>
#include <memory>

namespace tappet::reference {

class Machine final : public World {
public:
    static constexpr std::size_t most_transitions = 8; ///< in a step
    static constexpr std::size_t most_deferred = 8;
    static constexpr std::int64_t enough_statements = 100'000;

    /// The options of a table's row for the machine and its children.
    struct Policy {
        std::int64_t statements = enough_statements;
        bool escalates = false;
    };
    Machine(const Script& script, const Instance& instance, const std::string& name, World& bench,
            Policy policy, Machine* parent = nullptr);

    // ---- requests of the engine, an operator or a parent
    bool activate(std::int64_t now);
    bool start(std::int64_t now);
    bool reactive();
    bool pause();
    bool request_final(std::int64_t now);
    bool reset(std::int64_t now);
    bool deactivate(std::int64_t now);
    bool request(const std::string& state, bool run_once, std::int64_t now);
    void step(std::int64_t now);
    void step_once(std::int64_t now);
    void event(const std::string& name, const std::vector<Value>& arguments, std::int64_t now);

    // ---- compared values
    [[nodiscard]] std::string picture() const;
    [[nodiscard]] bool is_in(const std::string& state) const;
    [[nodiscard]] bool in_error() const { return error_; }
    [[nodiscard]] const Scope& scope() const { return scope_; }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const Type& type() const { return *type_; }
    std::vector<std::unique_ptr<Machine>>& children() { return children_; }
    [[nodiscard]] std::size_t lost() const { return lost_; }

    // ---- as the world of its programs
    [[nodiscard]] Kind kind_of(const std::string& name) const override;
    std::optional<Value> read(const std::string& name) override;
    bool write(const std::string& name, const Value& value) override;
    std::optional<Value> call(const std::string& name, const std::vector<Value>& arguments) override;
    bool begin(const std::string& name, const std::vector<Value>& arguments) override {
        return bench_.begin(name, arguments);
    }
    Answer progress(const std::string& name, const std::vector<Value>& arguments) override {
        return bench_.progress(name, arguments);
    }
    bool send(const std::string& name, const std::vector<Value>& arguments) override {
        return bench_.send(slot(name), arguments);
    }
    Answer ended(const std::string& name) override { return bench_.ended(slot(name)); }

private:
    enum class Phase : std::uint8_t { fresh, under_way, waits, ran, asked, done, held };
    struct Active {
        const State* state = nullptr;
        Phase phase = Phase::fresh;
        ProgramRun run{};
        std::int64_t entered_at = 0;
    };
    /// One of the many acts of a transition.
    struct Act {
        enum class Kind : std::uint8_t {
            program,
            exit,
            left,
            plan,
            enter,
            entered,
            depart
        } kind = Kind::program;
        const Block* block = nullptr;
        const State* state = nullptr; ///< to leave or to enter
        std::string enters{};         ///< of a plan: "history" or "deep history"
        std::size_t kept = 0;         ///< of a plan: levels around the target that stay active
    };
    struct Chosen {
        const State* source = nullptr;
        const Transition* transition = nullptr;
        bool otherwise = false;
    };
    struct Event {
        std::string name{};
        std::vector<Value> arguments{};
    };
    enum class Reply : std::uint8_t { no, yes, otherwise, failed };

    /// One slot for the act in hand, and one for the run program of each state that may be active beside
    /// others.
    [[nodiscard]] std::string slot(const std::string& name) const;

    // ---- the tree
    [[nodiscard]] const State* find(const std::string& name) const;
    [[nodiscard]] std::vector<const State*> chain(const State* state) const;
    [[nodiscard]] std::vector<std::string> regions_of(const std::string& parent) const;
    [[nodiscard]] const State* initial_of(const std::string& parent, const std::string& region) const;
    [[nodiscard]] bool is_inside(const State* state, const State* around) const;
    [[nodiscard]] bool is_leaf(const State* state) const { return regions_of(state->name).empty(); }
    [[nodiscard]] std::size_t kept_of(const State* source, const State* target) const;
    [[nodiscard]] std::vector<const State*> entries(const State* target, std::size_t kept,
                                                    const std::string& enters) const;
    [[nodiscard]] const State* remembered(const std::string& parent, const std::string& region) const;
    Active* active_of(const State* state);
    [[nodiscard]] std::vector<const State*> leaves() const;
    /// The states that are considered at a leaf: itself and those around it, of which it is the last leaf.
    [[nodiscard]] std::vector<const State*> asked_at(const State* leaf) const;

    /// Begins a call from outside, with the statements of one.
    void open() { busy_ = true, left_ = policy_.statements; }

    // ---- the act in hand
    bool work(std::int64_t now);
    bool do_acts(std::int64_t now);
    void plan(const State* source, const State* target, const Block& program, const std::string& enters);
    void take(const Chosen& chosen);
    void replace(const State* target, bool departs);
    void fail();
    [[nodiscard]] bool in_hand() const { return !acts_.empty() || !chosen_.empty(); }
    [[nodiscard]] bool is_final() const { return active_.size() == 1 && active_[0].state->final; }

    // ---- a round of run, conditions and handle
    void round(std::int64_t now);
    bool run_states(std::int64_t now);
    Reply find_condition(std::int64_t now, Chosen& found);
    bool handle_states(std::int64_t now);

    // ---- questions, events, requests
    Reply test(const Expression& expression);
    Reply may_enter(const State* source, const std::string& to, const std::string& enters);
    Reply ask(const State* source, const Transition& transition, const std::vector<Value>* given,
              std::int64_t now);
    void react(const Event& event, std::int64_t now);
    void finish(std::int64_t now);
    void serve_final(std::int64_t now);
    bool serve_request(std::int64_t now);

    const Type* type_ = nullptr;
    std::string name_;
    World& bench_;
    Scope scope_;
    std::vector<std::unique_ptr<Machine>> children_;
    std::vector<Active> active_;                  ///< each before those inside it
    std::map<std::string, const State*> history_; ///< by composite and region: the state that was left last
    std::deque<Act> acts_;
    std::deque<Chosen> chosen_;      ///< by one event, still to be taken
    ProgramRun current_;             ///< of the act in hand
    const State* running_ = nullptr; ///< its run program is being executed
    std::deque<Event> deferred_;
    std::string wanted_;
    bool wanted_run_ = false;
    bool run_once_ = false;
    bool to_final_ = false; ///< the act in hand leads to the final state by request
    bool leaving_ = false;
    bool final_wanted_ = false;
    bool is_active_ = false;
    bool automatic_ = false;
    bool paused_ = false;
    bool error_ = false;
    bool busy_ = false;
    bool mid_round_ = false;
    bool conditions_left_ = false;
    Policy policy_{};
    Machine* parent_ = nullptr;
    std::int64_t left_ = 0; ///< statements of this call from outside
    bool single_ = false;   ///< a single step
    std::size_t asked_ = 0; ///< conditions that single steps have asked in this round
    std::set<const State*> ran_;
    std::size_t lost_ = 0;
    std::int64_t now_ = 0;
};

} // namespace tappet::reference
