// Operations (thesis 4.5) as function pointers: how a reaction row calls a member function of a component, at
// once or from a message.
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
    // So that saying so stays the only error.
    using Signature = Arguments<>;
    using Call = void (*)(void*) noexcept TAPPET_REALTIME;
    static void call(void*) noexcept TAPPET_REALTIME {}
    static void enter(void*) noexcept TAPPET_REALTIME {}
    static void run(void*, const std::byte*) noexcept TAPPET_REALTIME {}
};

template <auto Method, class Component, class... A>
struct OperationCall<Method, void (Component::*)(A...) noexcept TAPPET_REALTIME> {
    static constexpr bool is_operation = true;
    using Signature = Arguments<A...>;
    static constexpr std::size_t packed_bytes = detail::packed_bytes<A...>;
    /// Names the signature as plain data: the element type is what a Subscriber<A...> takes.
    using Call = void (*)(void*, A...) noexcept TAPPET_REALTIME;

    // Aligned so that the whole of a short reaction is fetched at once: an emission to many takes a fifth
    // less.
    [[gnu::aligned(32)]] static void call(void* component, A... arguments) noexcept TAPPET_REALTIME {
        (static_cast<Component*>(component)->*Method)(arguments...);
    }
    /// Only into a component that is not stopped.
    [[gnu::aligned(32)]] static void enter(void* gated, A... arguments) noexcept TAPPET_REALTIME {
        auto& at = *static_cast<GatedComponent*>(gated);
        if (at.is_open()) call(at.component, arguments...);
    }
    static void run(void* component, const std::byte* packed) noexcept TAPPET_REALTIME {
        [[maybe_unused]] const std::byte* at = packed;
        // A braced list is evaluated from left to right.
        struct Caller {
            void* component;
            Caller(void* c, A... arguments) noexcept TAPPET_REALTIME : component{c} {
                call(component, arguments...);
            }
        };
        [[maybe_unused]] const Caller caller{component, detail::unpack_one<A>(at)...};
    }
};

namespace detail {

/// The call as an object, whose address is plain data and names the whole signature to whoever knows it.
template <auto Method>
inline constexpr typename OperationCall<Method>::Call operation_call = &OperationCall<Method>::call;
template <auto Method>
inline constexpr typename OperationCall<Method>::Call operation_entry = &OperationCall<Method>::enter;

} // namespace detail

} // namespace tappet
