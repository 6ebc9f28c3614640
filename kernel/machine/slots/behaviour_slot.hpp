// A slot for a behaviour that is loaded while the machine runs (thesis 5.1.4, 5.2.4): two banks of memory. A
// background activity compiles a script into the spare one. Between two steps the engine hands over from the
// old behaviour to the new one, and back when the new one fails its trial.
#pragma once

#include "kernel/component/event_handle.hpp"
#include "kernel/machine/slots/slot_task.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace tappet {

/// The moment at which a new behaviour takes over.
struct SlotMoment {
    enum class Kind : std::uint8_t { now, event, angle };
    Kind kind = Kind::now;
    std::size_t event = 0; ///< its number in the slot's reach
    double angle_deg = 0;  ///< passed upwards by the slot's angle, 0 to 360
};

enum class SlotPhase : std::uint8_t {
    empty,        ///< nothing is loaded
    steady,       ///< the loaded behaviour is active
    waiting,      ///< a new one waits for its moment; the old one is active
    handing_over, ///< the old one is going to its final state
    trial         ///< the new one is active, the old one ready to return
};

constexpr std::string_view to_text(SlotPhase phase) noexcept {
    switch (phase) {
    case SlotPhase::empty: return "empty";
    case SlotPhase::steady: return "steady";
    case SlotPhase::waiting: return "waiting";
    case SlotPhase::handing_over: return "handing_over";
    case SlotPhase::trial: return "trial";
    }
    return "?";
}

/// The reason of the last roll-back.
enum class RollBack : std::uint8_t {
    none,
    error,     ///< one of its programs failed
    left_over, ///< the statements of one step exceeded their number or the deadline
    late,      ///< it made its activity miss a deadline
    too_much,  ///< its activity used more processor time than its row claims
    asked      ///< requested from outside
};

class BehaviourSlot {
public:
    struct Place {
        const BehaviourRow* row = nullptr;
        MachineInstance* machine = nullptr;
        std::size_t component = 0;
        std::span<std::byte> banks[2]{};
        std::span<char> text{};
        std::span<const std::string_view> events{}; ///< names, in the order of its routes
        std::span<EventHandle> handles{};           ///< of each event
        const Output<double>* angle = nullptr;
        StateMachineExecution::Trace trace = nullptr;
        Engine* engine = nullptr; ///< runs the slot, and is told its transitions
        std::uint32_t part = 0;   ///< of the driven component, in the engine
    };
    /// Places the slot, at start-up.
    void place(const Place& place);
    /// Adds a task of the loaded behaviours, at start-up. From now on every loaded behaviour must fit it.
    void add(SlotTask& task) noexcept {
        task.next = tasks_;
        tasks_ = &task;
    }
    /// Loads the row's initial behaviour, at start-up, after all tasks; it is active from the start.
    [[nodiscard]] Sentence begin();

    // ---- in a background activity, one call at a time; not real-time

    /// The memory in which the characters of a script are collected.
    [[nodiscard]] std::span<char> text() noexcept { return place_.text; }
    /// Says why no script may be compiled now; empty: it may.
    [[nodiscard]] Sentence may_load() const noexcept;
    /// Compiles the first `characters` of text() into the spare bank. The error is the script's, with its
    /// line, or says which memory of the slot is too small. The active behaviour is not affected.
    [[nodiscard]] Sentence compile(std::size_t characters, std::string_view name);
    /// Parses a moment: "now", "component.event" of the reach, or an angle in degrees.
    [[nodiscard]] Sentence parse_moment(std::string_view text, SlotMoment& moment) const;

    /// A roll_back of a load that still waits discards that load, and the active behaviour stays.
    enum class Change : std::uint8_t { take_over, unload, roll_back };
    /// Requests a change from obey(); false: the previous request is not yet carried out.
    [[nodiscard]] bool ask(Change change, const SlotMoment& moment = {}) noexcept;
    /// Withdraws a request that could not be posted.
    void withdraw() noexcept { asked_.store(false, std::memory_order_relaxed); }
    /// Says why a change makes no sense now; empty: it makes sense.
    [[nodiscard]] Sentence may(Change change) const noexcept;

    // ---- state; any thread, real-time. The units: only between two steps of the engine.

    [[nodiscard]] SlotPhase phase() const noexcept TAPPET_REALTIME {
        return phase_.load(std::memory_order_acquire);
    }
    /// Returns the active unit; null: none.
    [[nodiscard]] const BehaviourUnit* active() const noexcept TAPPET_REALTIME {
        const int bank = active_.load(std::memory_order_relaxed);
        return bank == none ? nullptr : &banks_[static_cast<std::size_t>(bank)].unit;
    }
    [[nodiscard]] BehaviourUnit* active() noexcept TAPPET_REALTIME {
        return const_cast<BehaviourUnit*>(std::as_const(*this).active());
    }
    [[nodiscard]] RollBack last_roll_back() const noexcept TAPPET_REALTIME { return why_; }
    [[nodiscard]] std::uint32_t roll_backs() const noexcept TAPPET_REALTIME { return roll_backs_; }
    /// How many times a behaviour took over.
    [[nodiscard]] std::uint32_t loads() const noexcept TAPPET_REALTIME { return loads_; }
    /// Says why the last behaviour was rolled back, with the line of the script; empty when none was. Not
    /// real-time.
    [[nodiscard]] Sentence describe_roll_back() const;
    [[nodiscard]] const BehaviourRow& row() const noexcept { return *place_.row; }
    [[nodiscard]] std::size_t component() const noexcept TAPPET_REALTIME { return place_.component; }
    /// Name of the active script; empty: none.
    [[nodiscard]] std::string_view script() const noexcept TAPPET_REALTIME {
        const int bank = active_.load(std::memory_order_relaxed);
        return bank == none ? std::string_view{} : banks_[static_cast<std::size_t>(bank)].name.view();
    }

    // ---- in its engine, real-time

    /// Carries out the requested change, as a message.
    static void obey(void* slot, const std::byte*) noexcept TAPPET_REALTIME;
    void start(Time now) noexcept TAPPET_REALTIME;
    bool step_programs(Time now) noexcept TAPPET_REALTIME;
    bool step(Time now) noexcept TAPPET_REALTIME;
    void stop(Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] Time next() const noexcept TAPPET_REALTIME;
    void dispatch(std::size_t event, const std::byte* packed, Time now) noexcept TAPPET_REALTIME;
    /// Returns a task's part of the active unit, which must exist.
    [[nodiscard]] UnitPart& part_of(const SlotTask& task) noexcept TAPPET_REALTIME {
        return task.part(*active(), bank());
    }
    /// Makes the properties of all tasks and the variables behind them equal.
    void exchange() noexcept TAPPET_REALTIME {
        if (BehaviourUnit* const unit = active(); unit != nullptr)
            for (SlotTask* task = tasks_; task != nullptr; task = task->next) task->exchange(*unit, bank());
    }

private:
    static constexpr int none = -1;
    struct Bank {
        BehaviourUnit unit{};
        bool filled = false;
        Text<48> name{}; ///< of the script's file
    };
    [[nodiscard]] std::size_t bank() const noexcept TAPPET_REALTIME {
        return static_cast<std::size_t>(active_.load(std::memory_order_relaxed));
    }
    [[nodiscard]] int spare() const noexcept TAPPET_REALTIME {
        return active_.load(std::memory_order_relaxed) == 0 ? 1 : 0;
    }
    /// Places a unit in a bank, ready to take over.
    [[nodiscard]] Sentence fill(std::size_t bank, const ScriptUnit& unit, std::span<const BehaviourCode> code,
                                std::span<std::byte> memory);
    [[nodiscard]] bool is_due() noexcept TAPPET_REALTIME;
    void hand_over(Time now) noexcept TAPPET_REALTIME;
    void switch_to_target(Time now) noexcept TAPPET_REALTIME;
    void judge(Time now) noexcept TAPPET_REALTIME;
    /// Deadlines missed by the component's reactions and its behaviour.
    [[nodiscard]] std::uint64_t misses() const noexcept TAPPET_REALTIME;
    [[nodiscard]] Duration time_taken() const noexcept TAPPET_REALTIME;
    void take_back(RollBack why, Time now) noexcept TAPPET_REALTIME;
    void connect(bool on) noexcept TAPPET_REALTIME;
    void set(SlotPhase phase) noexcept TAPPET_REALTIME { phase_.store(phase, std::memory_order_release); }

    Place place_{};
    Bank banks_[2]{};
    std::array<Reachable, Slot::max_names + 1> reachable_{};
    std::size_t reachable_count_ = 0;
    SlotTask* tasks_ = nullptr;
    // Written by the background while no change is requested, read by obey().
    Change asked_change_ = Change::take_over;
    SlotMoment asked_moment_{};
    std::atomic<bool> asked_{false};
    /// The bank that was active before and is still whole. The engine sets it when a behaviour takes over;
    /// the background clears it when it compiles into that bank, which it does only while no change is
    /// requested.
    std::atomic<int> previous_{none};
    // Written by the engine.
    SlotMoment moment_{}; ///< that a change waits for
    std::atomic<SlotPhase> phase_{SlotPhase::empty};
    std::atomic<int> active_{none};
    int target_ = none;
    bool runs_ = false; ///< whether its component runs
    bool is_roll_back_ = false;
    std::uint32_t steps_left_ = 0;        ///< of the hand-over, then of the trial
    std::uint32_t bases_left_ = 0;        ///< steps for which the next two values are taken anew
    std::uint64_t misses_before_ = 0;     ///< deadlines missed before the trial
    std::uint64_t over_claim_before_ = 0; ///< of the activity
    bool kept_its_claim_ = false;         ///< whether the activity kept its claim, as far as measured
    Duration taken_before_{},
        taken_last_{}; ///< by this slot's functions: in total, and between two judgements
    double last_angle_ = -1;
    RollBack why_ = RollBack::none;
    std::uint32_t roll_backs_ = 0;
    std::uint32_t loads_ = 0;
};

} // namespace tappet
