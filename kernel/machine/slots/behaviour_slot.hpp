// Room for a behaviour that is loaded while the machine runs (thesis 5.1.4, 5.2.4): two banks of memory. A
// script is compiled into the spare one in a background activity; between two steps the engine hands over
// from the old behaviour to the new one, and back when the new one fails its trial.
#pragma once

#include "kernel/component/event_handle.hpp"
#include "kernel/machine/slots/slot_task.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace tappet {

/// When a new behaviour takes over.
struct SlotMoment {
    enum class Kind : std::uint8_t { now, event, angle };
    Kind kind = Kind::now;
    std::size_t event = 0; ///< its number in the slot's reach
    double angle_deg = 0;  ///< passed upwards by the slot's angle, 0 to 360
};

enum class SlotPhase : std::uint8_t {
    empty,        ///< nothing is loaded
    steady,       ///< the loaded behaviour is at work
    waiting,      ///< a new one waits for its moment; the old one is at work
    handing_over, ///< the old one goes to its final state
    trial         ///< the new one is at work and the old one ready to come back
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

/// Why the last behaviour was taken back.
enum class RollBack : std::uint8_t {
    none,
    error,     ///< a program of it failed
    left_over, ///< its statements of one step did not come to an end within their number or the deadline
    late,      ///< its activity missed a deadline by it
    too_much,  ///< its activity used more of its processor than its row claims
    asked      ///< from outside
};

class BehaviourSlot {
public:
    struct Place {
        const BehaviourRow* row = nullptr;
        MachineInstance* machine = nullptr;
        std::size_t component = 0;
        std::span<std::byte> banks[2]{};
        std::span<char> text{};
        std::span<const std::string_view> events{}; ///< names, as its routes count them
        std::span<EventHandle> handles{};           ///< of each event
        const Output<double>* angle = nullptr;
        StateMachineExecution::Trace trace = nullptr;
        Engine* engine = nullptr; ///< that runs it, and is told its transitions
        std::uint32_t part = 0;   ///< there, of the component that is driven
    };
    /// By start-up.
    void place(const Place& place);
    /// By start-up: a task of what is loaded. From now on nothing is that does not fit it.
    void add(SlotTask& task) noexcept {
        task.next = tasks_;
        tasks_ = &task;
    }
    /// By start-up, after all tasks: what its row begins with is at work from the start.
    [[nodiscard]] Sentence begin();

    // ---- in a background activity, one at a time; not real-time

    /// Where the characters of a script are gathered.
    [[nodiscard]] std::span<char> text() noexcept { return place_.text; }
    /// Whether a script may be compiled now; a sentence says why not.
    [[nodiscard]] Sentence may_load() const noexcept;
    /// Compiles the first `characters` of text() into the spare bank. An error is the script's, with its
    /// line, or says what the slot has no room for; the behaviour that is at work does not notice.
    [[nodiscard]] Sentence compile(std::size_t characters, std::string_view name);
    /// A moment as it is written: "now", "component.event" of the reach, or an angle in degrees.
    [[nodiscard]] Sentence parse_moment(std::string_view text, SlotMoment& moment) const;

    /// A roll-back of a load that still waits lets that one go, and what is at work stays.
    enum class Change : std::uint8_t { take_over, unload, roll_back };
    /// What obey() is to do; false: it has not obeyed the last one yet.
    [[nodiscard]] bool ask(Change change, const SlotMoment& moment = {}) noexcept;
    /// It could not be posted.
    void withdraw() noexcept { asked_.store(false, std::memory_order_relaxed); }
    /// Whether a change makes sense now; a sentence says why not.
    [[nodiscard]] Sentence may(Change change) const noexcept;

    // ---- what it tells; any thread, real-time. Of the units only between two steps of the engine.

    [[nodiscard]] SlotPhase phase() const noexcept TAPPET_REALTIME {
        return phase_.load(std::memory_order_acquire);
    }
    /// Null: none.
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
    /// Why, with the line of the script; empty when nothing was taken back. Not real-time.
    [[nodiscard]] Sentence describe_roll_back() const;
    [[nodiscard]] const BehaviourRow& row() const noexcept { return *place_.row; }
    [[nodiscard]] std::size_t component() const noexcept TAPPET_REALTIME { return place_.component; }
    /// Of the script that is at work; empty: none.
    [[nodiscard]] std::string_view script() const noexcept TAPPET_REALTIME {
        const int bank = active_.load(std::memory_order_relaxed);
        return bank == none ? std::string_view{} : banks_[static_cast<std::size_t>(bank)].name.view();
    }

    // ---- in its engine, real-time

    /// As a message: carries out the change.
    static void obey(void* slot, const std::byte*) noexcept TAPPET_REALTIME;
    void start(Time now) noexcept TAPPET_REALTIME;
    bool step_programs(Time now) noexcept TAPPET_REALTIME;
    bool step(Time now) noexcept TAPPET_REALTIME;
    void stop(Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] Time next() const noexcept TAPPET_REALTIME;
    void dispatch(std::size_t event, const std::byte* packed, Time now) noexcept TAPPET_REALTIME;
    /// Of a task, in what is at work: something is.
    [[nodiscard]] UnitPart& part_of(const SlotTask& task) noexcept TAPPET_REALTIME {
        return task.part(*active(), bank());
    }
    /// The properties of all tasks and the variables behind them become the same again.
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
    /// A unit into a bank, ready to take over.
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
    // Written by the background while no change is on its way, read by obey().
    Change asked_change_ = Change::take_over;
    SlotMoment asked_moment_{};
    std::atomic<bool> asked_{false};
    /// The bank that was at work before and is still whole. The engine sets it when one takes over, the
    /// background takes it away when it compiles into it, which it does while no change is on its way.
    std::atomic<int> previous_{none};
    // Written by the engine.
    SlotMoment moment_{}; ///< that a change waits for
    std::atomic<SlotPhase> phase_{SlotPhase::empty};
    std::atomic<int> active_{none};
    int target_ = none;
    bool runs_ = false; ///< its component does
    bool is_roll_back_ = false;
    std::uint32_t steps_left_ = 0;        ///< of the hand-over, then of the trial
    std::uint32_t bases_left_ = 0;        ///< the next two lines are of now for so many steps
    std::uint64_t misses_before_ = 0;     ///< the trial
    std::uint64_t over_claim_before_ = 0; ///< of the activity
    bool kept_its_claim_ = false;         ///< the activity, as far as that was measured
    Duration taken_before_{},
        taken_last_{}; ///< by this slot's functions: in all, and from one look to the next
    double last_angle_ = -1;
    RollBack why_ = RollBack::none;
    std::uint32_t roll_backs_ = 0;
    std::uint32_t loads_ = 0;
};

} // namespace tappet
