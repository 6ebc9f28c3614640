// A machine come to life in its static memory: components constructed at their planned places, wired as the
// rows say, configured. It knows no thread; a world runs its engines.
#pragma once

#include "kernel/machine/firmware.hpp"
#include "kernel/machine/instance/property_store.hpp"
#include "kernel/os/shared_memory.hpp"

#include <array>
#include <atomic>
#include <expected>
#include <span>
#include <string_view>

namespace tappet {

/// Why the machine was asked to stop: the first call wins.
struct StopRequest {
    StopReason reason = StopReason::none;
    std::uint64_t detail = 0; ///< stale input: the connection row; missed deadline: the function
    const Engine* from = nullptr;
};

/// How a world lets the engine of an activity start and stop. Called by the supervisor's thread.
struct ActivityControl {
    void* world = nullptr;
    bool (*start)(void* world, std::size_t activity) = nullptr; ///< false: its thread did not come up
    /// False: its thread hangs; the engine's stop was run in its place.
    bool (*stop)(void* world, std::size_t activity) = nullptr;
};

/// Not real-time but for ask_stop(), stop_asked() and what is const. One machine has one instance at a time.
class MachineInstance {
public:
    MachineInstance(const AcceptedMachine& machine, os::Clock& clock) noexcept
        : machine_{machine}, clock_{&clock} {}
    MachineInstance(const MachineInstance&) = delete;
    MachineInstance& operator=(const MachineInstance&) = delete;

    /// Where rows with a properties file have their values from; before configure().
    void read_properties_from(const PropertyStore& store) noexcept { store_ = store; }
    [[nodiscard]] const PropertyStore& property_store() const noexcept { return store_; }
    /// Writes every properties file anew. While the machine stands still, before or after it ran; of a
    /// machine that runs see PropertySaving in kernel/services/configuration. The first file that cannot be
    /// written is the error, the others are written all the same.
    [[nodiscard]] Sentence save_properties();

    /// Constructs, wires and configures. An error is the first component's refusal.
    std::expected<void, Sentence> configure(std::span<const ProvidedDevice> devices);

    /// In the order of the table's activities.
    [[nodiscard]] std::span<Engine> engines() noexcept TAPPET_REALTIME;
    [[nodiscard]] std::span<const Engine> engines() const noexcept TAPPET_REALTIME {
        return const_cast<MachineInstance*>(this)->engines();
    }
    [[nodiscard]] std::span<std::byte> stack_of(std::size_t activity) noexcept;
    [[nodiscard]] const AcceptedMachine& machine() const noexcept { return machine_; }
    [[nodiscard]] os::Clock& clock() noexcept { return *clock_; }

    /// A component by name, for worlds and tests; null when there is none of that name and type.
    template <class T>
    [[nodiscard]] T* find(std::string_view name) noexcept {
        const std::size_t c = find_component(machine_.table, name);
        return c != nowhere && machine_.table.components[c].type->tag == type_id<T>
                   ? static_cast<T*>(component(c))
                   : nullptr;
    }
    [[nodiscard]] void* component(std::size_t index) noexcept {
        return machine_.memory.data() + machine_.plan.component_at[index];
    }
    /// What the table's row says that drives a component; null when none does.
    [[nodiscard]] const BehaviourUnit* behaviour_of(std::string_view component) const noexcept;
    /// Of a behaviour row; null: it is a slot, or it is none.
    [[nodiscard]] BehaviourUnit* unit_of_row(std::size_t behaviour) noexcept {
        const std::size_t place = machine_.plan.behaviours[behaviour].unit_at;
        return place == nowhere ? nullptr : at<BehaviourUnit>(place);
    }
    [[nodiscard]] BehaviourSlot* slot_of_row(std::size_t behaviour) noexcept {
        const std::size_t place = machine_.plan.behaviours[behaviour].slot_at;
        return place == nowhere ? nullptr : at<BehaviourSlot>(place);
    }
    /// The slot reserved for a component; null when there is none.
    [[nodiscard]] BehaviourSlot* slot_of(std::string_view component) noexcept;
    [[nodiscard]] const BehaviourSlot* slot_of(std::string_view component) const noexcept {
        return const_cast<MachineInstance*>(this)->slot_of(component);
    }
    /// Lets the slot carry out its wish in its engine; for a component that sees the machine. False: that
    /// engine has too many requests to serve. Real-time.
    [[nodiscard]] bool post_wish(BehaviourSlot& slot) noexcept TAPPET_REALTIME;
    /// The first state machine of that; null when there is none.
    [[nodiscard]] const StateMachineExecution* state_machine_of(std::string_view component) const noexcept;

    /// Where a command slot of a behaviour is sent to that runs in `sender`; for start-up and for loading.
    [[nodiscard]] CommandSlot::Route command_route(End to, std::size_t sender) noexcept;

    /// Runs a call in the engine of an activity, between two of its steps; `message.id` is the part it is
    /// timed as. For the components that see the machine, from their own activity only. False: there are
    /// `requests_waiting` of them there already, and the receiver did not get this one. Real-time.
    [[nodiscard]] bool post_request(std::size_t activity, const Message& message) noexcept TAPPET_REALTIME;

    /// Aims a command slot of a component that sees the machine at a command of the table: set its packed
    /// arguments in `values`, which has room for the command's value_bytes() and outlives the slot, then
    /// send() it from that component's activity and read the packed results behind the arguments when it is
    /// done. False: the facet is no command, the slot is on its way, or `values` are too small. At most
    /// `requests_waiting` are at work in one engine: one more is rejected. Wait-free.
    [[nodiscard]] bool bind_command(End to, CommandSlot& slot, std::span<std::byte> values) noexcept;
    /// Runs a method of the table in the engine of its component, for a component that sees the machine:
    /// packed arguments in `values`, the packed result behind them when the request is done(). False: the
    /// facet is no method, the request is not done yet, `values` are too small, or too many requests wait.
    /// Wait-free.
    [[nodiscard]] bool request_method(End to, MethodRequest& request, std::span<std::byte> values) noexcept;

    /// Starts, stops or restarts one component while the rest goes on (thesis 3.1.3): its engine does it
    /// between two steps, and answers. Real-time, any thread.
    LifeTicket ask_component(std::size_t index, LifeChange change) noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer answer_of_component(std::size_t index, LifeTicket ticket) noexcept
        TAPPET_REALTIME;
    [[nodiscard]] ComponentState state_of(std::size_t component) noexcept TAPPET_REALTIME;
    /// The same for a whole activity, with initialise and finalise of its components: the supervisor does it.
    /// Real-time, any thread.
    LifeTicket ask_activity(std::size_t index, LifeChange change) noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer answer_of_activity(std::size_t index, LifeTicket ticket) const noexcept
        TAPPET_REALTIME;
    /// What a refusal says, with its cure; empty when nothing was refused.
    [[nodiscard]] Sentence describe(std::size_t activity, LifeAnswer answer) const;

    /// For worlds. In the table's order; the first refusal ends it.
    [[nodiscard]] Sentence start_activities(const ActivityControl& control);
    /// Empty: done. To start, what its components read from other activities must be valid.
    [[nodiscard]] Sentence change_activity(std::size_t index, LifeChange change,
                                           const ActivityControl& control) {
        LifeAnswer answer;
        return change_activity(index, change, control, answer);
    }
    void serve_activity_requests(const ActivityControl& control);

    /// The directory of the socket for browsers, instead of the board's; before configure(). It outlives the
    /// instance.
    void browse_in(std::string_view directory) noexcept { browsing_directory_ = directory; }
    /// Empty: there is to be none.
    [[nodiscard]] std::string_view browsing_directory() const noexcept {
        return browsing_directory_.empty() ? machine_.board->browsing.directory : browsing_directory_;
    }

    /// What others may map, read-only, of a machine that a component sees: its map and its values, see
    /// map_layout.hpp; empty otherwise. The stacks lie outside.
    [[nodiscard]] std::span<const std::byte> shared_memory() const noexcept {
        return machine_.map.empty() ? std::span<const std::byte>{}
                                    : machine_.memory.first(machine_.plan.shared_bytes);
    }
    /// The same as a descriptor to give away; -1 when there is none.
    [[nodiscard]] int shared_descriptor() const noexcept { return shared_.descriptor(); }
    /// Of a machine that a component sees.
    [[nodiscard]] Observed& observed() noexcept TAPPET_REALTIME {
        return *at<Observed>(machine_.plan.observed_at);
    }
    /// How many ports of it are forced now.
    [[nodiscard]] std::uint32_t forced_ports() const noexcept {
        return const_cast<MachineInstance*>(this)->observed().forced.load(std::memory_order_relaxed);
    }
    /// A member of a component, by the place of its facet; null for what is none (an operation).
    [[nodiscard]] void* place_of(End end) noexcept {
        return facet_at(machine_.table, end).at == nullptr ? nullptr : facet(end);
    }

    /// Who is called, in the activity of what sees the machine, with each emission that observe_event()
    /// connected. Before the machine runs.
    void show_events_to(const EventObserver& observer) noexcept { event_observer_ = observer; }
    /// Connects and disconnects the observer and one event; the event's number there is observed_index(). Not
    /// valid when nothing sees the machine, or the event's arguments exceed a message. The handle is
    /// real-time, finding it is not.
    [[nodiscard]] EventHandle observe_event(std::size_t component, std::size_t facet) noexcept;
    /// In plan().subscriptions; nowhere: it cannot be observed.
    [[nodiscard]] std::size_t observed_index(End event) const noexcept;
    /// Of one of the plan's subscriptions; nothing for a synchronous one. Real-time, any thread.
    [[nodiscard]] SubscriptionCounts counts_of(std::size_t subscription) const noexcept TAPPET_REALTIME;

    /// How long a reaction row that tells, or a connection row that wakes, took each time an edge or a frame
    /// set it off; null for other rows. Whole while the receiving activity rests. Rows by their number in the
    /// table.
    [[nodiscard]] const ReactionTimes* times_of_reaction(std::size_t row) const noexcept;
    [[nodiscard]] const ReactionTimes* times_of_connection(std::size_t row) const noexcept;

    /// What a row of a section of another folder has counted so far; row by row, section by section. Any
    /// thread.
    [[nodiscard]] SectionCount counted(std::size_t section, std::size_t row) const noexcept;

    /// Asks the supervisor to stop the machine. Real-time, any thread.
    void ask_stop(StopReason reason, std::uint64_t detail, const Engine* from) noexcept TAPPET_REALTIME;
    /// The same for a row of a section of another folder, which describes it.
    void ask_section_stop(std::size_t section, std::size_t row, const Engine* from) noexcept TAPPET_REALTIME {
        ask_stop(StopReason::section, std::uint64_t{section} << 32 | row, from);
    }
    [[nodiscard]] bool stop_asked() const noexcept TAPPET_REALTIME {
        return stop_asked_.load(std::memory_order_acquire) == 2;
    }
    [[nodiscard]] const StopRequest& stop_request() const noexcept { return stop_; }
    /// What a stop request says, as a sentence.
    [[nodiscard]] Sentence describe_stop() const;
    /// That an activity used more of its processor than its row claims, and the cure; empty: it did not. The
    /// analysis of the table believed the claim.
    [[nodiscard]] Sentence describe_budget(std::size_t activity) const;
    /// Woken when a stop is asked for.
    [[nodiscard]] os::Waiter& supervisor() noexcept TAPPET_REALTIME { return supervisor_; }

    /// Of every engine, in order: equal for two runs that did the same.
    [[nodiscard]] std::uint64_t event_log_digest() const noexcept;
    /// Emissions that found their queue full, over the rows that keep each one: keep_latest lets older ones
    /// go, and who only observes is told itself what it missed.
    [[nodiscard]] std::uint64_t lost_emissions() const noexcept;
    /// Messages and synchronous reactions that met a component that did not run, over all rows.
    [[nodiscard]] std::uint64_t dropped_messages() const noexcept;

private:
    template <class T>
    [[nodiscard]] T* at(std::size_t offset) noexcept TAPPET_REALTIME {
        return reinterpret_cast<T*>(machine_.memory.data() + offset);
    }
    [[nodiscard]] void* facet(End end) noexcept;
    [[nodiscard]] Waker waker_of(std::size_t activity) noexcept TAPPET_REALTIME;
    /// The same for whoever posted to an inbox of that activity just before.
    [[nodiscard]] Waker post_waker_of(std::size_t activity) noexcept TAPPET_REALTIME;

    [[nodiscard]] Sentence change_activity(std::size_t index, LifeChange change,
                                           const ActivityControl& control, LifeAnswer& answer);
    [[nodiscard]] Sentence initialise_and_start(std::size_t index, const ActivityControl& control,
                                                LifeAnswer& answer);

    [[nodiscard]] std::expected<void, Sentence> share_memory();
    void place_map();
    void place_facet(End end, map::Facet& record);
    void place_figure(map::Figure& figure);
    void place_fields(const map::Header& header);
    [[nodiscard]] std::uint64_t offset_of(const void* place) const noexcept;

    void construct();
    [[nodiscard]] Sentence configure_properties(std::size_t component);
    void place_engines();
    void place_scope();
    void connect_clocks();
    void connect_data();
    void connect_extras();
    [[nodiscard]] std::span<std::byte> extra_memory(std::size_t section) const noexcept;
    void place_needed_inputs();
    [[nodiscard]] GatedComponent* gate_of(std::size_t component) noexcept;
    [[nodiscard]] LifeSign life_sign_of(std::string_view watched) noexcept;
    void connect_row(std::size_t row);
    void add_waker(std::size_t row);
    void connect_events();
    void place_lanes(std::size_t subscription, AsyncReaction& reaction);
    void bind_receiver(std::size_t subscription, AsyncReaction& reaction);
    void place_mailboxes();
    void connect_operations();
    void place_command_processors();
    [[nodiscard]] CommandSlot::Route route_to(End to) noexcept;
    [[nodiscard]] Sentence place_behaviours();
    [[nodiscard]] Sentence place_unit(std::size_t row, Behaviour& behaviour);
    void place_slot(std::size_t row, Behaviour& behaviour);

    AcceptedMachine machine_;
    os::Clock* clock_;
    PropertyStore store_{};
    os::SharedMemory shared_{};
    EventObserver event_observer_{};
    std::string_view browsing_directory_{};
    os::Waiter supervisor_{};
    std::atomic<int> stop_asked_{0}; // 1: somebody is writing the request, 2: it is written
    StopRequest stop_{};
    std::array<LifeRequests, checks::max_activities> activity_requests_{};
    std::array<bool, checks::max_activities> thread_lost_{};
};

} // namespace tappet
