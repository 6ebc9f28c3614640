// How an interface spells methods and commands, and the calls with which a component uses those of its peers
// (thesis 4.5.3).
#pragma once

#include "kernel/component/interface.hpp"

namespace tappet {

/// A member function `R f(A...) noexcept TAPPET_REALTIME` that peers run in their own thread: peers of its
/// own activity, or any peer if it is declared any_thread. A method that may_block is declared only noexcept.
template <auto Method, class... Options>
constexpr Facet method(std::string_view name, std::string_view doc, Options... options) {
    constexpr bool blocks = detail::says_may_block<Options...>;
    using M = std::conditional_t<blocks, BlockingMethod<Method>, MethodFunction<Method>>;
    static_assert(
        M::is_method || blocks,
        "a method is a member function declared noexcept TAPPET_REALTIME that takes values or const "
        "references and returns a trivially copyable result or void; one that blocks says may_block");
    static_assert(
        M::is_method || !blocks,
        "a method that may_block is a member function declared noexcept, without TAPPET_REALTIME, that takes "
        "values or const references and returns a trivially copyable result or void");
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::method,
                         .type = type_id<typename M::Signature>,
                         .method = &M::operations},
                        options...);
}

/// A member MethodCall<R(A...)>; a row uses(...) must connect it unless `optional`.
template <auto Member, class... Options>
constexpr Facet calls(std::string_view name, std::string_view doc, Options... options) {
    using M = detail::MemberOf<Member>;
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::method_call,
                         .type = type_id<typename M::Type::Signature>,
                         .required = true,
                         .at = &M::at,
                         .method_call = &M::Type::operations},
                        options...);
}

/// A goal that the component reaches for others. `Action`: `bool f(P...) noexcept TAPPET_REALTIME`; false
/// rejects. `Completion`: the same parameters or none, returns CommandProgress or bool; polled in each cycle
/// of the component's activity after its action. Without a completion the command is done when its action has
/// run. The action of a command that may_block is declared only noexcept.
template <auto Action, auto Completion = nullptr, class... Options>
constexpr Facet command(std::string_view name, std::string_view doc, Options... options) {
    constexpr bool blocks = detail::says_may_block<Options...>;
    using C = detail::CommandOf<Action, Completion, blocks>;
    static_assert(C::begin_is_good || blocks,
                  "the action of a command is a member function `bool f(P...) noexcept TAPPET_REALTIME`; one "
                  "that blocks says may_block");
    static_assert(C::begin_is_good || !blocks,
                  "the action of a command that may_block is a member function `bool f(P...) noexcept`");
    static_assert(!C::begin_is_good || C::follow_is_good,
                  "the completion of a command takes the parameters of its action or none, is noexcept "
                  "TAPPET_REALTIME and returns CommandProgress or bool");
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::command,
                         .type = type_id<typename C::Begin::Name>,
                         .command = &C::operations},
                        options...);
}

namespace detail {

template <class Call>
inline constexpr CommandCallOperations command_call_of{
    [](void* command_call) { return &static_cast<Call*>(command_call)->slot(); },
    [](void* command_call) { return static_cast<Call*>(command_call)->values(); }};

} // namespace detail

namespace detail {

/// A command that its component forwards as another one: the arguments go there, the results come back.
template <auto Member, class Call = typename MemberOf<Member>::Type>
struct ForwardedCommand;
template <auto Member, class... P>
struct ForwardedCommand<Member, CommandCall<P...>> {
    using Pack = Packing<P...>;
    static CommandCall<P...>& call(void* component) noexcept TAPPET_REALTIME {
        return static_cast<typename MemberOf<Member>::Component*>(component)->*Member;
    }
    static bool begin(void* component, std::byte* values) noexcept TAPPET_REALTIME {
        return call(component).send_packed(values);
    }
    static CommandProgress progress(void* component, std::byte* values) noexcept TAPPET_REALTIME {
        return call(component).progress_packed(values + Pack::input_bytes);
    }
    static constexpr CommandOperations operations{type_id<typename Pack::Inputs>,
                                                  type_id<typename Pack::Results>,
                                                  Pack::input_bytes,
                                                  Pack::result_bytes,
                                                  &GatedCommand<&begin, &progress>::begin,
                                                  &GatedCommand<&begin, &progress>::progress};
};

} // namespace detail

/// A command that wraps the one behind a member CommandCall<P...> unchanged: rejected while that one is in
/// flight, done with its results when it is done, failed when it was rejected or failed. To change arguments,
/// write an action that sends it and a completion that returns its progress(...). The call itself also needs
/// its sends<...>(...) and its row.
template <auto Member, class... Options>
constexpr Facet forwards(std::string_view name, std::string_view doc, Options... options) {
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::command,
                         .type = type_id<typename detail::MemberOf<Member>::Type::Signature>,
                         .command = &detail::ForwardedCommand<Member>::operations},
                        options...);
}

/// A member CommandCall<P...>; a row uses(...) must connect it unless `optional`.
template <auto Member, class... Options>
constexpr Facet sends(std::string_view name, std::string_view doc, Options... options) {
    using M = detail::MemberOf<Member>;
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::command_call,
                         .type = type_id<typename M::Type::Signature>,
                         .required = true,
                         .at = &M::at,
                         .command_call = &detail::command_call_of<typename M::Type>},
                        options...);
}

} // namespace tappet
