// Operations (thesis 4.5) as function pointers: a reaction row calls a member function of a component at once
// or from a message.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/component/life.hpp"
#include "kernel/component/subscription.hpp"

#include <cstddef>

namespace tappet {

/// `Method` is a `void (Component::*)(A...) noexcept TAPPET_REALTIME`.
template <auto Method, class = decltype(Method)>
struct OperationCall {
    static constexpr bool is_operation = false;
    // So that the static_assert stays the only error.
    using Signature = Arguments<>;
    using Call = void (*)(void*) noexcept TAPPET_REALTIME;
    static void enter(void*) noexcept TAPPET_REALTIME {}
    static bool run(GatedComponent&, Entry, const std::byte*) noexcept TAPPET_REALTIME { return false; }
};

template <auto Method, class Component, class... A>
struct OperationCall<Method, void (Component::*)(A...) noexcept TAPPET_REALTIME> {
    static constexpr bool is_operation = true;
    using Signature = Arguments<A...>;
    static constexpr std::size_t packed_bytes = detail::packed_bytes<A...>;
    /// Names the signature as plain data: the element type is that of a Subscriber<A...>.
    using Call = void (*)(void*, A...) noexcept TAPPET_REALTIME;

    /// Runs it as a synchronous reaction; a refused one is counted. Aligned so that the whole of a short
    /// reaction is fetched at once: an emission to many takes a fifth less.
    [[gnu::aligned(32)]] static void enter(void* gated, A... arguments) noexcept TAPPET_REALTIME {
        auto& at = *static_cast<GatedComponent*>(gated);
        if (!at.enter(Entry::at_once, [&](void* component) noexcept
                      TAPPET_REALTIME { (static_cast<Component*>(component)->*Method)(arguments...); }))
            at.dropped.fetch_add(1, std::memory_order_relaxed);
    }
    /// Runs it with packed arguments. Returns false when the gate refused it.
    static bool run(GatedComponent& at, Entry entry, const std::byte* packed) noexcept TAPPET_REALTIME {
        return at.enter(entry, [packed](void* component) noexcept TAPPET_REALTIME {
            [[maybe_unused]] const std::byte* from = packed;
            // A braced list is evaluated from left to right.
            struct Caller {
                Caller(void* c, A... arguments) noexcept TAPPET_REALTIME {
                    (static_cast<Component*>(c)->*Method)(arguments...);
                }
            };
            [[maybe_unused]] const Caller caller{component, detail::unpack_one<A>(from)...};
        });
    }
};

namespace detail {

/// The call as an object. Its address is plain data, and names the whole signature to code that knows it.
template <auto Method>
inline constexpr typename OperationCall<Method>::Call operation_entry = &OperationCall<Method>::enter;

} // namespace detail

} // namespace tappet
