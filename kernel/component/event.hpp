// Events (thesis 4.6): an emission runs every connected reaction: synchronous ones in place, asynchronous
// ones in the receiver's engine. Every possible subscriber is a row of the table, and connecting one is one
// atomic bit.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/component/facet_member.hpp"
#include "kernel/component/subscription.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tappet {

/// One reaction row as the emitter sees it. It has the same size for every signature, so that the planner can
/// place it.
template <class... A>
struct Subscriber {
    void (*react)(void* context, A... arguments) noexcept TAPPET_REALTIME;
    void* context;
};

/// Most rows, triggers and observers of one event.
inline constexpr std::size_t max_subscribers = 64;

/// An event. Emitted only by its own component, from each activity that runs functions of that component.
/// Real-time; emissions from several activities may overlap.
template <class... A>
class Event : FacetMember<member::event> {
    static_assert((std::is_trivially_copyable_v<A> && ...),
                  "arguments of an event are copied between activities");

public:
    /// Runs synchronous reactions first, then asynchronous ones, the most urgent receiver's first (4.6.2).
    /// Each row's connection is checked just before it runs, so a row that a reaction disconnects does not
    /// run in this emission either.
    void emit(A... arguments) noexcept TAPPET_REALTIME {
        std::uint64_t rows = connected_.load(std::memory_order_acquire); // emit.row
        if (rows == 0) return;
        const Subscriber<A...>* const first = subscribers_;
        if ((rows & 1) != 0) first->react(first->context, arguments...);
        rows = connected_.load(std::memory_order_acquire); // emit.row
        if (rows < 2) return;
        if ((rows & 2) != 0) first[1].react(first[1].context, arguments...);
        rows = connected_.load(std::memory_order_acquire); // emit.row
        if (rows >= 4) emit_to_the_rest(arguments...);
    }
    void operator()(A... arguments) noexcept TAPPET_REALTIME { emit(arguments...); }

private:
    friend struct PortAccess;
    /// Runs the reactions from the third row on. Aligned, because a short loop that lies across two blocks of
    /// the processor's fetch takes a fifth longer.
    [[gnu::noinline, gnu::aligned(64)]] void emit_to_the_rest(A... arguments) const noexcept TAPPET_REALTIME {
        const std::size_t count = count_; // a bound that no handler can move: a counted loop
        const Subscriber<A...>* const subscribers = subscribers_;
        for (std::size_t i = 2; i < count; ++i)
            if ((connected_.load(std::memory_order_acquire) >> i & 1) != 0) // emit.row
                subscribers[i].react(subscribers[i].context, arguments...);
    }
    std::atomic<std::uint64_t> connected_{0};
    Subscriber<A...>* subscribers_ = nullptr;
    std::size_t count_ = 0;
};

namespace detail {

template <class... A>
void emit_packed(Event<A...>& event, const std::byte* packed) noexcept TAPPET_REALTIME {
    [[maybe_unused]] const std::byte* at = packed;
    // A braced list is evaluated from left to right.
    struct Emission {
        Emission(Event<A...>& from, A... arguments) noexcept TAPPET_REALTIME { from.emit(arguments...); }
    };
    [[maybe_unused]] const Emission emission{event, unpack_one<A>(at)...};
}

} // namespace detail

} // namespace tappet
