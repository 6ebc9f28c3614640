// Commands (thesis 4.5): a component reaches a goal at a peer's request, in its own engine and time. The
// receiver provides an action, which accepts or rejects, and a completion condition. The sender holds the
// command as an object, sends it and polls its state. Each object is one slot, so nothing can overflow.
//
//     struct Axis {
//         bool move_to(double position, int& steps) noexcept TAPPET_REALTIME;         // false: rejected
//         CommandProgress moved_to(double position, int& steps) noexcept TAPPET_REALTIME;
//         ... command<&Axis::move_to, &Axis::moved_to>("move_to", "...")
//     };
//     struct Panel { CommandCall<double, int&> move; ... sends<&Panel::move>("move", "...") };
//     uses("panel.move", "axis.move_to")
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/component/current.hpp"
#include "kernel/component/facet_member.hpp"
#include "kernel/component/life.hpp"
#include "kernel/component/port.hpp"
#include "kernel/component/signature.hpp"
#include "kernel/exchange/mailbox.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/waiter.hpp"

#include <string_view>

namespace tappet {

/// The state of a command. The receiver writes it from `sent` to the end, otherwise the sender.
enum class CommandState : std::uint8_t {
    ready,     ///< not sent, or made ready again
    sent,      ///< in the receiver's mailbox
    accepted,  ///< its action ran and accepted; the completion was not polled yet
    rejected,  ///< its action refused, or its receiver does not run
    executing, ///< its completion was polled: not done yet
    failed,    ///< its completion reported failure, or its receiver stopped
    done       ///< its results are available
};

constexpr std::string_view to_text(CommandState state) noexcept {
    switch (state) {
    case CommandState::ready: return "ready";
    case CommandState::sent: return "sent";
    case CommandState::accepted: return "accepted";
    case CommandState::rejected: return "rejected";
    case CommandState::executing: return "executing";
    case CommandState::failed: return "failed";
    case CommandState::done: return "done";
    }
    return "?";
}

/// Returns whether the receiver has the command: between send() and the end.
constexpr bool in_flight(CommandState state) noexcept TAPPET_REALTIME {
    constexpr unsigned at_the_receiver = 1u << static_cast<unsigned>(CommandState::sent) |
                                         1u << static_cast<unsigned>(CommandState::accepted) |
                                         1u << static_cast<unsigned>(CommandState::executing);
    return (at_the_receiver >> static_cast<unsigned>(state) & 1u) != 0;
}

/// The result of a completion condition.
enum class CommandProgress : std::uint8_t { executing, done, failed };

/// A facet's access to the command behind it. All of it runs in the receiver's engine.
struct CommandOperations {
    TypeId arguments = nullptr; ///< of the Arguments<...> that are sent
    TypeId results = nullptr;   ///< of the Arguments<...> that come back
    std::size_t argument_bytes = 0;
    std::size_t result_bytes = 0; ///< packed after the arguments
    /// Runs the action. Returns false when it rejects, or when the component does not run.
    bool (*begin)(GatedComponent&, std::byte* values) noexcept TAPPET_REALTIME = nullptr;
    /// Polls the completion. Null: the command is done when its action has run.
    CommandProgress (*progress)(GatedComponent&, std::byte* values) noexcept TAPPET_REALTIME = nullptr;

    /// For a setter or a getter: the `at` of the property's facet.
    void* (*property)(void* component, std::size_t index) noexcept = nullptr;

    [[nodiscard]] CommandProgress ask(GatedComponent& at, std::byte* values) const noexcept TAPPET_REALTIME {
        return progress == nullptr ? CommandProgress::done : progress(at, values);
    }
    [[nodiscard]] constexpr std::size_t value_bytes() const noexcept { return argument_bytes + result_bytes; }
};

/// A component's functions behind its gate. If it does not run, a command is rejected or fails.
template <bool (*Begin)(void* component, std::byte* values) noexcept TAPPET_REALTIME,
          CommandProgress (*Progress)(void* component, std::byte* values) noexcept TAPPET_REALTIME>
struct GatedCommand {
    static bool begin(GatedComponent& at, std::byte* values) noexcept TAPPET_REALTIME {
        bool accepted = false;
        const bool entered = at.enter(Entry::queued, [&](void* component) noexcept
                                      TAPPET_REALTIME { accepted = Begin(component, values); });
        return entered && accepted;
    }
    static CommandProgress progress(GatedComponent& at, std::byte* values) noexcept TAPPET_REALTIME {
        auto progress = CommandProgress::failed;
        const bool entered = at.enter(Entry::queued, [&](void* component) noexcept
                                      TAPPET_REALTIME { progress = Progress(component, values); });
        return entered ? progress : CommandProgress::failed;
    }
};

/// One command in flight, of any signature. Its state and its packed values have one writer at a time: the
/// sender until `sent` is posted, then the receiver until it stores an end state, which hands them back.
/// Wait-free.
class CommandSlot {
public:
    /// The receiver of a slot and the waiting sender; set by start-up.
    struct Route {
        const CommandOperations* command = nullptr;
        GatedComponent* receiver = nullptr;
        std::uint32_t part = 0; ///< number of the component in its engine
        CommandInbox* inbox = nullptr;
        std::size_t sender = 0; ///< the sending activity's mailbox there
        std::uint32_t sending_activity = no_activity;
        Waker wake_receiver{};
        Waker wake_sender{}; ///< when the command has ended
        const os::Clock* clock = nullptr;
        bool planned = true; ///< connected by a row of the table, not bound while the machine runs
    };

    CommandSlot() = default;
    CommandSlot(const CommandSlot&) = delete;
    CommandSlot& operator=(const CommandSlot&) = delete;

    /// Sets route and values, before anybody sends. `values` has room for the command's value_bytes() and
    /// outlives the slot.
    void place(const Route& route, std::byte* values) noexcept { route_ = route, values_ = values; }
    /// Sets the waiter that wait() sleeps on, before anybody sends. The waiter is not in the slot, because
    /// the slot's memory may be reused when the command ends.
    void wait_on(os::Waiter& ended) noexcept { ended_ = &ended; }
    [[nodiscard]] bool connected() const noexcept TAPPET_REALTIME { return route_.command != nullptr; }

    // ---- the sender's side: one thread, real-time but for wait()

    [[nodiscard]] CommandState state() const noexcept TAPPET_REALTIME {
        return state_.load(std::memory_order_acquire); // command.state
    }
    /// Returns whether values() belong to the sender now.
    [[nodiscard]] bool is_mine() const noexcept TAPPET_REALTIME { return !in_flight(state()); }
    /// Sends the command with the arguments in values(). Returns false when it is in flight, or has no row.
    [[nodiscard]] bool send() noexcept TAPPET_REALTIME {
        if (!connected() || !is_mine()) return false;
        post();
        return true;
    }
    /// As send(), of a command that is connected and belongs to the sender.
    void post() noexcept TAPPET_REALTIME {
        // A stopped engine serves nobody: the answer is given here.
        const ComponentState receiver =
            route_.receiver->state.load(std::memory_order_acquire); // command.look
        if (receiver >= ComponentState::stopped) {
            state_.store(CommandState::rejected, std::memory_order_relaxed); // command.refuse
            return;
        }
        // Stored before the message is posted: from then on the receiver writes it.
        state_.store(CommandState::sent, std::memory_order_relaxed); // command.send
        if (route_.inbox->post(route_.sender, {this, route_.part}))
            route_.wake_receiver();
        else // the mailbox has a place for each of its slots
            state_.store(CommandState::rejected, std::memory_order_relaxed); // command.refuse
    }
    /// Makes the command ready again. Returns false while the receiver has it.
    bool reset() noexcept TAPPET_REALTIME {
        if (!is_mine()) return false;
        state_.store(CommandState::ready, std::memory_order_relaxed); // command.reset
        return true;
    }
    /// Sleeps until the command has ended, for `at_most` at most; after wait_on(), for activities that are
    /// not_real_time. Returns true when it has ended or was never sent. Under virtual time nothing may sleep:
    /// it returns at once.
    [[nodiscard]] bool wait(Duration at_most) noexcept {
        if (is_mine()) return true;
        if (route_.clock->is_virtual()) return false;
        const Time end = route_.clock->now() + at_most;
        // A wake of an earlier send may be left over.
        while (!is_mine() && route_.clock->now() < end) static_cast<void>(ended_->wait(end));
        return is_mine();
    }
    [[nodiscard]] std::byte* values() noexcept TAPPET_REALTIME { return values_; }
    [[nodiscard]] const std::byte* values() const noexcept TAPPET_REALTIME { return values_; }
    [[nodiscard]] const Route& route() const noexcept TAPPET_REALTIME { return route_; }

    // ---- the receiver's side: its engine's thread, real-time

    /// Runs the action. Returns whether the command was accepted and must be followed.
    [[nodiscard]] bool begin() noexcept TAPPET_REALTIME {
        const bool accepted = route_.command->begin(*route_.receiver, values_);
        if (accepted)
            state_.store(CommandState::accepted, std::memory_order_release); // command.accept
        else
            reject();
        return accepted;
    }
    /// Returns whether the component has a completion function.
    [[nodiscard]] bool has_completion() const noexcept TAPPET_REALTIME {
        return route_.command->progress != nullptr;
    }
    /// Polls the completion condition. Returns the new state.
    [[nodiscard]] CommandState follow() noexcept TAPPET_REALTIME {
        switch (route_.command->ask(*route_.receiver, values_)) {
        case CommandProgress::executing:
            state_.store(CommandState::executing, std::memory_order_release); // command.execute
            return CommandState::executing;
        case CommandProgress::done: return end(CommandState::done);
        case CommandProgress::failed: break;
        }
        return end(CommandState::failed);
    }
    void fail() noexcept TAPPET_REALTIME { static_cast<void>(end(CommandState::failed)); }
    void reject() noexcept TAPPET_REALTIME { static_cast<void>(end(CommandState::rejected)); }

private:
    // The sender reads the results after the state. From the store on the slot belongs to the sender, which
    // may reuse its memory, so nothing of it is touched any more.
    CommandState end(CommandState how) noexcept TAPPET_REALTIME {
        const Waker wake_sender = route_.wake_sender;
        os::Waiter* const ended = ended_;
        state_.store(how, std::memory_order_release); // command.end
        if (ended != nullptr) ended->wake();
        wake_sender();
        return how;
    }

    Route route_{};
    std::byte* values_ = nullptr;
    alignas(64) std::atomic<CommandState> state_{CommandState::ready};
    os::Waiter* ended_ = nullptr;
};

template <class... P>
class CommandCall;

/// A command that can be passed on: an argument of an event, an operation or another command. A component
/// that gets it may send it only if the row says sent_by(...) with that component. Trivially copyable; the
/// machine outlives it.
template <class... P>
class CommandRef {
public:
    CommandRef() = default;
    explicit CommandRef(CommandCall<P...>& command) noexcept TAPPET_REALTIME : command_{&command} {}
    [[nodiscard]] CommandCall<P...>* operator->() const noexcept TAPPET_REALTIME { return command_; }
    explicit operator bool() const noexcept TAPPET_REALTIME { return command_ != nullptr; }

private:
    CommandCall<P...>* command_ = nullptr;
};

/// The sender's side: the command as an object. P: the parameters as the receiver's action spells them, a
/// result as T&. Only one activity sends, polls and resets it: its component's, or that of the row's
/// sent_by(...).
template <class... P>
class CommandCall : FacetMember<member::command_call> {
    using Pack = detail::Packing<P...>;
    template <std::size_t N, class List>
    struct Nth;
    template <std::size_t N, class First, class... Rest>
    struct Nth<N, Arguments<First, Rest...>> : Nth<N - 1, Arguments<Rest...>> {
        static constexpr std::size_t offset = sizeof(First) + Nth<N - 1, Arguments<Rest...>>::offset;
    };
    template <class First, class... Rest>
    struct Nth<0, Arguments<First, Rest...>> {
        using Type = First;
        static constexpr std::size_t offset = 0;
    };

public:
    using Signature = Arguments<typename detail::Parameter<P>::InName...>;

    CommandCall() noexcept { slot_.wait_on(ended_); }
    CommandCall(const CommandCall&) = delete;
    CommandCall& operator=(const CommandCall&) = delete;

    /// Sends the command with the arguments: those of P that are not results. Returns false, without effect,
    /// while it is still in flight or when no row connects it. Real-time.
    template <class... Given>
    [[nodiscard]] bool send(const Given&... arguments) noexcept TAPPET_REALTIME {
        if (!slot_.connected() || !prepare(arguments...)) return false;
        check_sender();
        slot_.post();
        return true;
    }
    /// Sets the arguments for a send_prepared() by the component that it is passed on to. Returns false while
    /// it is in flight.
    template <class... Given>
    bool prepare(const Given&... arguments) noexcept TAPPET_REALTIME {
        if (!slot_.is_mine()) return false;
        put(typename Pack::Inputs{}, arguments...);
        std::memset(values_.data() + Pack::input_bytes, 0, Pack::result_bytes);
        return true;
    }
    [[nodiscard]] bool send_prepared() noexcept TAPPET_REALTIME {
        check_sender();
        return slot_.send();
    }

    [[nodiscard]] CommandState state() const noexcept TAPPET_REALTIME { return slot_.state(); }
    [[nodiscard]] bool connected() const noexcept TAPPET_REALTIME { return slot_.connected(); }
    bool reset() noexcept TAPPET_REALTIME { return slot_.reset(); }
    /// See CommandSlot::wait. Not real-time.
    [[nodiscard]] bool wait(Duration at_most) noexcept { return slot_.wait(at_most); }

    /// Returns the Nth result: the receiver's value once state() is done.
    template <std::size_t N = 0>
    [[nodiscard]] auto result() const noexcept TAPPET_REALTIME {
        using R = Nth<N, typename Pack::Results>;
        return detail::load_packed<typename R::Type>(values_.data() + Pack::input_bytes + R::offset);
    }
    /// Returns the progress as a completion condition does, for a command whose action sent this one. Copies
    /// the results when it is done.
    template <class... R>
    [[nodiscard]] CommandProgress progress(R&... results) const noexcept TAPPET_REALTIME {
        static_assert(std::is_same_v<Arguments<R...>, typename Pack::Results>,
                      "one variable for each result");
        std::array<std::byte, Pack::result_bytes + 1> packed;
        const CommandProgress now = progress_packed(packed.data());
        if (now != CommandProgress::done) return now;
        [[maybe_unused]] const std::byte* from = packed.data();
        ((std::memcpy(&results, from, sizeof(R)), from += sizeof(R)), ...);
        return now;
    }

    /// As send() and progress(), with packed values.
    [[nodiscard]] bool send_packed(const std::byte* arguments) noexcept TAPPET_REALTIME {
        if (!slot_.connected() || !slot_.is_mine()) return false;
        std::memcpy(values_.data(), arguments, Pack::input_bytes);
        std::memset(values_.data() + Pack::input_bytes, 0, Pack::result_bytes);
        return send_prepared();
    }
    [[nodiscard]] CommandProgress progress_packed(std::byte* results) const noexcept TAPPET_REALTIME {
        const CommandState now = state();
        if (in_flight(now)) return CommandProgress::executing;
        if (now != CommandState::done) return CommandProgress::failed;
        std::memcpy(results, values_.data() + Pack::input_bytes, Pack::result_bytes);
        return CommandProgress::done;
    }

    /// For start-up: the slot, and the place of its values.
    [[nodiscard]] CommandSlot& slot() noexcept { return slot_; }
    [[nodiscard]] std::byte* values() noexcept { return values_.data(); }

private:
    // Each mailbox has one writer. A thread outside the activities, such as a test's, is trusted.
    void check_sender() const noexcept TAPPET_REALTIME {
        const std::uint32_t sender = slot_.route().sending_activity;
        const std::uint32_t here = running_activity();
        if (here == sender) return;
        TAPPET_CONTRACT(sender == no_activity || here == no_activity, Contract::command_sender, sender, here);
    }
    template <class... In, class... Given>
    void put(Arguments<In...>, const Given&... arguments) noexcept TAPPET_REALTIME {
        static_assert(sizeof...(In) == sizeof...(Given), "one value for each argument of the command");
        static_assert((std::is_convertible_v<const Given&, In> && ...), "values of the command's types");
        [[maybe_unused]] std::byte* into = values_.data();
        ((detail::store_packed(into, static_cast<In>(arguments)), into += sizeof(In)), ...);
    }

    std::array<std::byte, Pack::bytes + 1> values_{}; // never of size zero
    CommandSlot slot_{};
    os::Waiter ended_{};
};

/// Start-up's access to the sender's side.
struct CommandCallOperations {
    CommandSlot* (*slot)(void* command_call) = nullptr;
    std::byte* (*values)(void* command_call) = nullptr;
};

namespace detail {

template <auto Function, class = decltype(Function)>
struct CommandFunction {
    static constexpr bool is_good = false;
    using Name = Arguments<>;
    using Returned = void;
    using Pack = Packing<>;
};

template <auto Function, bool blocks, class Component, class R, class... P>
struct CommandFunctionOf {
    static constexpr bool is_good = true;
    using Name = Arguments<typename Parameter<P>::InName...>;
    using Returned = R;
    using Pack = Packing<P...>;

    static R call(Component& component, Unpacked<P>... each) noexcept TAPPET_REALTIME {
        R answer{};
        if constexpr (blocks)
            TAPPET_ESCAPE("the table's check lets activities only run it that are not real-time",
                          answer = (component.*Function)(each.value...));
        else
            answer = (component.*Function)(each.value...);
        (each.put_back(), ...);
        return answer;
    }
    template <std::size_t... I>
    static R call_packed(void* component, [[maybe_unused]] std::byte* values,
                         std::index_sequence<I...>) noexcept TAPPET_REALTIME {
        return call(*static_cast<Component*>(component), Unpacked<P>{values + Pack::offsets[I]}...);
    }
    static R run(void* component, std::byte* values) noexcept TAPPET_REALTIME {
        return call_packed(component, values, std::index_sequence_for<P...>{});
    }
};
template <auto Function, class Component, class R, class... P>
struct CommandFunction<Function, R (Component::*)(P...) noexcept TAPPET_REALTIME>
    : CommandFunctionOf<Function, false, Component, R, P...> {};
template <auto Function, class Component, class R, class... P>
struct CommandFunction<Function, R (Component::*)(P...) const noexcept TAPPET_REALTIME>
    : CommandFunctionOf<Function, false, Component, R, P...> {};

/// The function of a command that may_block: `Function` is a `R (Component::*)(P...) noexcept`.
template <auto Function, class = decltype(Function)>
struct BlockingCommand : CommandFunction<nullptr> {};
template <auto Function, class Component, class R, class... P>
struct BlockingCommand<Function, R (Component::*)(P...) noexcept>
    : CommandFunctionOf<Function, true, Component, R, P...> {};
template <auto Function, class Component, class R, class... P>
struct BlockingCommand<Function, R (Component::*)(P...) const noexcept>
    : CommandFunctionOf<Function, true, Component, R, P...> {};

template <auto Action, auto Completion, bool blocks = false>
struct CommandOf {
    using Begin = std::conditional_t<blocks, BlockingCommand<Action>, CommandFunction<Action>>;
    using Follow = CommandFunction<Completion>;
    static constexpr bool begin_is_good = Begin::is_good && std::is_same_v<typename Begin::Returned, bool>;
    static constexpr bool is_instant = std::is_same_v<decltype(Completion), std::nullptr_t>;
    static constexpr bool follow_is_good =
        is_instant ||
        (Follow::is_good &&
         (std::is_same_v<typename Follow::Returned, CommandProgress> ||
          std::is_same_v<typename Follow::Returned, bool>) &&
         (Follow::Pack::count == 0 || std::is_same_v<typename Follow::Name, typename Begin::Name>));

    static bool begin(void* component, std::byte* values) noexcept TAPPET_REALTIME {
        if constexpr (begin_is_good) return Begin::run(component, values);
        return false;
    }
    static CommandProgress progress(void* component, std::byte* values) noexcept TAPPET_REALTIME {
        if constexpr (!follow_is_good || is_instant)
            return CommandProgress::failed;
        else if constexpr (std::is_same_v<typename Follow::Returned, bool>)
            return Follow::run(component, values) ? CommandProgress::done : CommandProgress::executing;
        else
            return Follow::run(component, values);
    }
    static constexpr CommandOperations operations{type_id<typename Begin::Pack::Inputs>,
                                                  type_id<typename Begin::Pack::Results>,
                                                  Begin::Pack::input_bytes,
                                                  Begin::Pack::result_bytes,
                                                  &GatedCommand<&begin, &progress>::begin,
                                                  is_instant ? nullptr
                                                             : &GatedCommand<&begin, &progress>::progress};
};

} // namespace detail

} // namespace tappet
