// Methods (thesis 4.5): an algorithm of a component; a peer calls it, and it runs in the peer's thread, with
// typed arguments and a result. The peer holds a MethodCall; a row of the table says whose method it calls.
//
//     struct Restarter {
//         MethodCall<bool(int)> restart;
//         ... calls<&Restarter::restart>("restart", "the bus")
//     };
//     struct Bus {
//         bool restart(int tries) noexcept TAPPET_REALTIME;
//         ... method<&Bus::restart>("restart", "...", any_thread)
//     };
//     uses("restarter.restart", "bus.restart")
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/component/facet_member.hpp"
#include "kernel/component/life.hpp"
#include "kernel/component/signature.hpp"

#include <atomic>

namespace tappet {

/// The answer to a method call: a result, or none when the called component does not run. The caller decides
/// what to do then. A const method is always answered. Real-time.
template <class R>
class [[nodiscard("the called component may be stopped: handle the case without an answer")]] Answer {
public:
    Answer() = default;
    Answer(const R& result) noexcept : result_{result}, given_{true} {}
    /// Returns false when the component does not run; then nothing of it was called.
    [[nodiscard]] bool given() const noexcept TAPPET_REALTIME { return given_; }
    [[nodiscard]] R value_or(const R& otherwise) const noexcept TAPPET_REALTIME {
        return given_ ? result_ : otherwise;
    }

private:
    R result_ = default_value<R>();
    bool given_ = false;
};
template <>
class [[nodiscard("the called component may be stopped: handle the case without an answer")]] Answer<void> {
public:
    constexpr explicit Answer(bool given = false) noexcept : given_{given} {}
    [[nodiscard]] bool given() const noexcept TAPPET_REALTIME { return given_; }

private:
    bool given_;
};

/// A facet's access to the method behind it.
struct MethodOperations {
    const void* call = nullptr; ///< points at a `Answer<R> (*const)(GatedComponent&, const A&...)`
    TypeId result = nullptr;    ///< of Arguments<> when it returns nothing
    std::size_t argument_bytes = 0;
    std::size_t result_bytes = 0;
    /// Runs the method with packed arguments, for callers that know no C++ type. In the caller's thread;
    /// real-time. Returns false when the component cannot be reached that way; then nothing ran, and there is
    /// no result.
    bool (*call_packed)(GatedComponent&, Entry, const std::byte* arguments, std::byte* result) noexcept
        TAPPET_REALTIME = nullptr;
    bool is_const = false; ///< it only reads its component
};

/// The method that a call runs. `call` is that of its MethodOperations.
struct MethodGoal {
    const void* call = nullptr;
    GatedComponent* component = nullptr;
};

/// Access to the caller's side for start-up, and for hand-overs between components that answer by turns.
struct MethodCallOperations {
    TypeId result = nullptr;
    void (*bind)(void* method_call, const MethodGoal& goal) = nullptr;
    /// Redirects later calls; a call in progress ends in the old component. `goal` must stay valid.
    /// Real-time, any thread.
    void (*aim)(void* method_call, const MethodGoal* goal) noexcept TAPPET_REALTIME = nullptr;
};

template <class Signature>
class MethodCall;

/// The caller's side. Called only by its own component. Real-time, as the method is.
template <class R, class... A>
class MethodCall<R(A...)> : FacetMember<member::method_call> {
    static_assert((!detail::Parameter<A>::is_result && ...),
                  "a method returns its result; for several, a struct");

public:
    using Function = Answer<R> (*)(GatedComponent&, const std::remove_cvref_t<A>&...) noexcept
        TAPPET_REALTIME;

    /// Runs the method. A call that no row connects breaks a contract: for an optional one check connected()
    /// first. A component that does not run gives no result.
    Answer<R> operator()(const std::remove_cvref_t<A>&... arguments) const noexcept TAPPET_REALTIME {
        const MethodGoal* const goal = goal_.load(std::memory_order_acquire);
        TAPPET_CONTRACT(goal != nullptr, Contract::precondition, 0);
        if (goal == nullptr) return Answer<R>();
        return (*static_cast<const Function*>(goal->call))(*goal->component, arguments...);
    }
    /// Returns whether a row connects it. Always true if it is not optional.
    [[nodiscard]] bool connected() const noexcept TAPPET_REALTIME {
        return goal_.load(std::memory_order_relaxed) != nullptr;
    }

    static constexpr MethodCallOperations operations{
        type_id<std::conditional_t<std::is_void_v<R>, Arguments<>, R>>,
        [](void* method_call, const MethodGoal& goal) {
            auto& self = *static_cast<MethodCall*>(method_call);
            self.bound_ = goal;
            self.goal_.store(&self.bound_, std::memory_order_release);
        },
        [](void* method_call, const MethodGoal* goal) noexcept TAPPET_REALTIME {
            auto& self = *static_cast<MethodCall*>(method_call);
            self.goal_.store(goal, std::memory_order_release);
        }};
    using Signature = Arguments<std::remove_cvref_t<A>...>;

private:
    MethodGoal bound_{};
    std::atomic<const MethodGoal*> goal_{nullptr};
};

/// `Method` is a `R (Component::*)(A...) noexcept TAPPET_REALTIME`.
template <auto Method, class = decltype(Method)>
struct MethodFunction {
    static constexpr bool is_method = false;
    // So that the static_assert stays the only error.
    using Signature = Arguments<>;
    static constexpr MethodOperations operations{};
};

/// A request to run a method once in its component's engine, for callers that know no types; so the method
/// need not be any_thread. Packed arguments first, the result after them. One request at a time.
class MethodRequest {
public:
    /// Returns whether the engine is done with it; the engine has it between place() and done(). Any thread,
    /// real-time.
    [[nodiscard]] bool done() const noexcept TAPPET_REALTIME {
        return !asked_.load(std::memory_order_acquire);
    }
    /// Returns, once done, whether the method ran. False: its component did not run then.
    [[nodiscard]] bool given() const noexcept TAPPET_REALTIME { return given_; }
    /// Fills the request, before it is posted. `values` has room for arguments and result and outlives the
    /// request.
    void place(const MethodOperations& method, GatedComponent& component, std::byte* values) noexcept
        TAPPET_REALTIME {
        method_ = &method, component_ = &component, values_ = values;
        asked_.store(true, std::memory_order_relaxed);
    }
    /// Withdraws a request that could not be posted.
    void withdraw() noexcept TAPPET_REALTIME { asked_.store(false, std::memory_order_relaxed); }
    /// Runs the request: a message's call, in the engine.
    static void run(void* self, const std::byte*) noexcept TAPPET_REALTIME {
        auto& request = *static_cast<MethodRequest*>(self);
        const MethodOperations& method = *request.method_;
        request.given_ = method.call_packed(*request.component_, Entry::queued, request.values_,
                                            request.values_ + method.argument_bytes);
        request.asked_.store(false, std::memory_order_release);
    }

private:
    const MethodOperations* method_ = nullptr;
    GatedComponent* component_ = nullptr;
    std::byte* values_ = nullptr;
    bool given_ = false;
    std::atomic<bool> asked_{false};
};

namespace detail {

template <auto Method, bool blocks, bool is_const, class Component, class R, class... A>
struct MethodOf {
    static constexpr bool is_method =
        (!Parameter<A>::is_result && ...) && (std::is_void_v<R> || std::is_trivially_copyable_v<R>);
    using Signature = Arguments<std::remove_cvref_t<A>...>;
    using Pack = Packing<A...>;
    using Returned = std::conditional_t<std::is_void_v<R>, Arguments<>, R>;

    static R run(void* component, const std::remove_cvref_t<A>&... arguments) noexcept TAPPET_REALTIME {
        if constexpr (blocks)
            TAPPET_ESCAPE("the table's check allows only activities that are not real-time to call it",
                          return (static_cast<Component*>(component)->*Method)(arguments...));
        else
            return (static_cast<Component*>(component)->*Method)(arguments...);
    }
    /// A method that only reads is answered by a stopped component too: whether it is ready, for instance.
    static constexpr Entry by(Entry entry) noexcept { return is_const ? Entry::always : entry; }
    static Answer<R> call(GatedComponent& at, const std::remove_cvref_t<A>&... arguments) noexcept
        TAPPET_REALTIME {
        if constexpr (std::is_void_v<R>) {
            return Answer<void>{at.enter(by(Entry::at_once), [&](void* component) noexcept
                                         TAPPET_REALTIME { run(component, arguments...); })};
        } else {
            Answer<R> answer;
            static_cast<void>( // the answer says it
                at.enter(by(Entry::at_once), [&](void* component) noexcept
                         TAPPET_REALTIME { answer = run(component, arguments...); }));
            return answer;
        }
    }
    template <std::size_t... I>
    static void unpack_and_run(void* component, const std::byte* packed, std::byte* result,
                               std::index_sequence<I...>) noexcept TAPPET_REALTIME {
        if constexpr (std::is_void_v<R>)
            run(component, load_packed<std::remove_cvref_t<A>>(packed + Pack::offsets[I])...);
        else
            store_packed(result,
                         run(component, load_packed<std::remove_cvref_t<A>>(packed + Pack::offsets[I])...));
    }
    static bool call_packed(GatedComponent& at, Entry entry, const std::byte* packed,
                            std::byte* result) noexcept TAPPET_REALTIME {
        return at.enter(by(entry), [&](void* component) noexcept TAPPET_REALTIME {
            unpack_and_run(component, packed, result, std::index_sequence_for<A...>{});
        });
    }
    static constexpr typename MethodCall<R(A...)>::Function function = &call;
    static constexpr std::size_t bytes_of_result() {
        if constexpr (std::is_void_v<R>)
            return 0;
        else
            return sizeof(R);
    }
    static constexpr MethodOperations operations{&function,         type_id<Returned>, Pack::bytes,
                                                 bytes_of_result(), &call_packed,      is_const};
};

} // namespace detail

template <auto Method, class Component, class R, class... A>
struct MethodFunction<Method, R (Component::*)(A...) noexcept TAPPET_REALTIME>
    : detail::MethodOf<Method, false, false, Component, R, A...> {};
template <auto Method, class Component, class R, class... A>
struct MethodFunction<Method, R (Component::*)(A...) const noexcept TAPPET_REALTIME>
    : detail::MethodOf<Method, false, true, Component, R, A...> {};

/// The function of a method that may_block: `Method` is a `R (Component::*)(A...) noexcept`.
template <auto Method, class = decltype(Method)>
struct BlockingMethod : MethodFunction<nullptr> {};
template <auto Method, class Component, class R, class... A>
struct BlockingMethod<Method, R (Component::*)(A...) noexcept>
    : detail::MethodOf<Method, true, false, Component, R, A...> {};
template <auto Method, class Component, class R, class... A>
struct BlockingMethod<Method, R (Component::*)(A...) const noexcept>
    : detail::MethodOf<Method, true, true, Component, R, A...> {};

} // namespace tappet
