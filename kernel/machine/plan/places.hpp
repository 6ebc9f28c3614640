// The places of all parts of a machine: one block of static memory, laid out by the compiler from the table.
// Start-up constructs objects at these offsets, an observer finds them there; nothing is allocated. plan.hpp
// makes the plan, and only the compiler's verdict needs it.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/base/layout.hpp"
#include "kernel/machine/slots/behaviour_slot.hpp"
#include "kernel/machine/table/binding.hpp"
#include "kernel/machine/table/board.hpp"

#include <span>

namespace tappet {

enum class SubscriberKind : std::uint8_t {
    operation, ///< of a reaction row
    wait,      ///< of a reaction row: an EventWait
    trigger,   ///< of a behaviour
    counter,   ///< of a section of the table that another folder adds (limits, control, reporting, ..)
    observer   ///< the component that sees the machine
};

/// A subscription, connected or not.
struct Subscription {
    End event;
    SubscriberKind kind = SubscriberKind::operation;
    bool synchronous = false;
    bool keeps_latest = false;
    bool is_connected = true;        ///< from the start
    End target;                      ///< the operation or the wait
    End handle;                      ///< of a reaction row that has one
    std::size_t behaviour = nowhere; ///< of a trigger
    std::size_t trigger = 0;         ///< number among the events of its unit or slot
    std::size_t section = nowhere;   ///< of a counter
    std::size_t counted = 0;         ///< number among the events that the section counts
    std::uint32_t quota = 0;
    std::uint64_t emitters = 0; ///< one bit for each activity that may emit the event
    std::size_t receiver = 0;   ///< activity
    std::size_t order = 0;      ///< in the table
    std::size_t turn = 0;       ///< among the subscriptions of its event: its bit
};

/// The places that belong to one activity.
struct ActivityPlan {
    PlacesOf<EnginePart> parts;
    std::size_t functions_at = 0; ///< FunctionTiming, functions_per_part of each part
    PlacesOf<EngineTimer> timers;
    PlacesOf<Behaviour> behaviours;
    PlacesOf<GuardedInput> guarded;
    PlacesOf<NeededInput> inputs; ///< inputs that its components need before they start
    PlacesOf<Mailbox> mailboxes;  ///< one for each sender
    PlacesOf<CommandMailbox> command_mailboxes;
    PlacesOf<CommandSlot*> followed; ///< commands that may run at the same time
    std::size_t tape_at = nowhere;   ///< CycleTape, if a component records the machine's cycles
    std::size_t tape_words = 0;
    std::size_t stack_at = 0;
    std::size_t stack_bytes = 0;
    int priority = 0; ///< SCHED_FIFO; 0: not real-time
    int processor = 0;
};

/// A connection row's memory: a shared data object, a ring, or nothing; and the memory for waking the reader.
struct ConnectionPlan {
    std::size_t memory_at = nowhere;
    bool shared = false;         ///< across activities, or scaled
    bool first_of_output = true; ///< the row that places the shared data object
    std::size_t waker_at = nowhere;
    std::size_t between_at = nowhere;
};

struct SubscriptionPlan {
    std::size_t subscribers_at = nowhere; ///< of the event's first subscription: the place of the whole array
    std::size_t async_at = nowhere;
    std::size_t binding_at = nowhere;   ///< of a trigger or an observer
    PlacesOf<EventLane> lanes;          ///< one for each emitting activity, in their order
    std::size_t lane_of_at = nowhere;   ///< of each activity; shared by the events of a component
    std::size_t latest_at = nowhere;    ///< of each lane, if it keeps the latest only
    std::size_t parcels_at = nowhere;   ///< of each lane, for arguments that do not fit a message
    std::size_t mailboxes_at = nowhere; ///< of a wait: one for each lane
    std::size_t mail_at = nowhere;      ///< of a wait: storage of the mailboxes
};

struct BehaviourPlan {
    PlacesOf<std::string_view> events; ///< names of the events that it hears, or may hear
    std::size_t unit_at = nowhere;     ///< BehaviourUnit
    PlacesOf<std::byte> memory;        ///< of the unit; of a slot its two banks, one after the other
    std::size_t slot_at = nowhere;     ///< BehaviourSlot
    std::size_t handles_at = nowhere;  ///< of a slot's events
    PlacesOf<char> text;               ///< of a script that is being loaded into a slot
};

/// A mailbox from one activity to another: its ring's storage, and its index at the receiver.
struct MailPlan {
    std::size_t storage_at = nowhere;
    std::uint32_t capacity = 0;
    std::size_t sender_index = 0;
};

/// Places that exist once.
struct PlanOfAll {
    std::size_t extras_at = 0; ///< of the sections of other folders, one after the other
    std::size_t engines_at = 0;
    std::size_t observed_at = 0; ///< Observed
    std::size_t scope_at = 0;    ///< scope::Directory; 0: nothing records the machine's cycles
    std::size_t recordings_at = 0;
    std::size_t recordings = 0;
    std::size_t shared_bytes = 0; ///< whole pages from the beginning on, without the stacks
    std::size_t bytes = 0;        ///< of the whole block: the machine's memory
    std::size_t stack_bytes = 0;  ///< of these, stacks
};

struct PlanView : PlanOfAll {
    std::span<std::size_t> component_at{};
    std::span<std::uint32_t> part_of{}; ///< the component's index in its engine
    std::span<ActivityPlan> activities{};
    std::span<ConnectionPlan> connections{};
    std::span<Subscription> subscriptions{};
    std::span<SubscriptionPlan> subscription_at{};
    std::span<BehaviourPlan> behaviours{};
    std::span<MailPlan> mail{};             ///< [sender * activities + receiver]
    std::span<MailPlan> requests{};         ///< into each activity, of the components that see the machine
    std::span<MailPlan> command_mail{};     ///< as mail, of commands alone
    std::span<MailPlan> command_requests{}; ///< as requests, of commands alone
};

/// Data that exist once in a machine for its observers.
struct Observed {
    std::atomic<std::uint32_t> forced{0}; ///< ports that are forced now
};

/// Runs the triggers of a behaviour when a message arrives.
struct TriggerBinding {
    BehaviourUnit* unit; ///< of the row; null: of a slot
    BehaviourSlot* slot;
    Engine* engine;
    std::size_t event; ///< its number in the unit or slot
};

/// The observer receives the arguments of an event up to this number of bytes.
inline constexpr std::size_t most_observed_bytes = 512;

/// The function that is called at each emission to which an observer is connected.
struct EventObserver {
    void (*observe)(void* observer, std::size_t event_index, const std::byte* packed_arguments,
                    Time now) noexcept TAPPET_REALTIME = nullptr;
    void* observer = nullptr;
};

/// Passes one event from a message to the observer.
struct ObserverBinding {
    const EventObserver* to;
    const Engine* engine;
    std::size_t event_index;
};

/// One waker in the chain of an output that wakes several activities.
struct WakerNode {
    Waker waker;
    WakerNode* next;
    Engine* reader;
    WakingRow row{};
};

/// An accepted machine.
struct AcceptedMachine {
    MachineView table;
    const Board* board;
    const Binding* binding;
    TableIndexView index;
    PlanView plan;
    std::span<std::byte> memory;
    std::span<const std::byte> map{}; ///< as the compiler drew it; empty when no component sees the machine
    std::span<const TypeId> map_types{}; ///< the types that the map describes, in its order
};

/// Returns the component that can observe every event, or nowhere.
constexpr std::size_t find_observer(const MachineView& m) noexcept {
    for (std::size_t c = 0; c < m.components.size(); ++c)
        if (m.components[c].type->sees_machine) return c;
    return nowhere;
}

/// Returns the component that executes lines of the script language, or nowhere.
constexpr std::size_t find_interpreter(const MachineView& m) noexcept {
    for (std::size_t c = 0; c < m.components.size(); ++c)
        if (m.components[c].type->lines != nullptr) return c;
    return nowhere;
}

/// Whether the row feeds an input that a component needs before it starts.
constexpr bool is_needed_input(const MachineView& m, const ConnectionRow& row, const Link& link) noexcept {
    return !row.buffered && facet_at(m, link.to).required;
}

} // namespace tappet
