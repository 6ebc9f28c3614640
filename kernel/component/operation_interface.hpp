// How an interface spells methods and commands, and the calls by which a component reaches its peers' (thesis
// 4.5.3).
#pragma once

#include "kernel/component/interface.hpp"

namespace tappet {

/// A member function `R f(A...) noexcept TAPPET_REALTIME` that peers run in their own thread: those of its
/// own activity, or any if it is declared any_thread.
template <auto Method, class... Options>
constexpr Facet method(std::string_view name, std::string_view doc, Options... options) {
    static_assert(
        MethodFunction<Method>::is_method,
        "a method is a member function declared noexcept TAPPET_REALTIME that takes values or const "
        "references and returns a trivially copyable result or void");
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::method,
                         .type = type_id<typename MethodFunction<Method>::Signature>,
                         .method = &MethodFunction<Method>::operations},
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

/// A goal that the component reaches for others. `Action`: `bool f(P...) noexcept TAPPET_REALTIME`, false
/// rejects. `Completion`: the same parameters or none, returns CommandProgress or bool; asked in each cycle
/// of the component's activity behind its action. Without it the command is done when its action has run.
template <auto Action, auto Completion = nullptr, class... Options>
constexpr Facet command(std::string_view name, std::string_view doc, Options... options) {
    using C = detail::CommandOf<Action, Completion>;
    static_assert(C::begin_is_good,
                  "the action of a command is a member function `bool f(P...) noexcept TAPPET_REALTIME`");
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
