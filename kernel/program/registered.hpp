// Operators and functions of a user's own types, for scripts: named beside the type, found through its tag.
//
//     constexpr Pose add(const Pose& a, const Pose& b) noexcept TAPPET_REALTIME;
//     template <> inline constexpr tappet::Registered<tappet::Op<"+", &add>, tappet::Op<"inverse", &inverse>>
//         tappet::operators_of<Pose>{};
//
// Put it before the first use of the type in an interface.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/program/value_access.hpp"

#include <memory>

namespace tappet {

/// A registered operator: at most two operands, each of any value type.
struct RegisteredOperator {
    std::string_view name{}; ///< "+", or a function's name
    TypeId result = nullptr;
    std::array<TypeId, 2> operands{}; ///< second one null: one operand
    Primitive run = nullptr;
};

namespace detail {

template <class T>
T load_operand(const std::byte* from) noexcept TAPPET_REALTIME {
    T value = default_value<T>();
    std::memcpy(static_cast<void*>(std::addressof(value)), from, sizeof value);
    return value;
}

template <auto Function, class = decltype(Function)>
struct RegisteredCall;
template <auto Function, class R, class A>
struct RegisteredCall<Function, R (*)(A) noexcept TAPPET_REALTIME> {
    static constexpr TypeId result = &TagOf<R>::tag; // not type_id<R>, which may still be under construction
    static constexpr std::array<TypeId, 2> operands{&TagOf<std::remove_cvref_t<A>>::tag, nullptr};
    static ActionResult run(ProgramContext&, const Instruction&, std::byte* to, const std::byte* a,
                            const std::byte*) noexcept TAPPET_REALTIME {
        const R value = Function(load_operand<std::remove_cvref_t<A>>(a));
        std::memcpy(to, std::addressof(value), sizeof value);
        return ActionResult::done;
    }
};
template <auto Function, class R, class A, class B>
struct RegisteredCall<Function, R (*)(A, B) noexcept TAPPET_REALTIME> {
    static constexpr TypeId result = &TagOf<R>::tag; // not type_id<R>, which may still be under construction
    static constexpr std::array<TypeId, 2> operands{&TagOf<std::remove_cvref_t<A>>::tag,
                                                    &TagOf<std::remove_cvref_t<B>>::tag};
    static ActionResult run(ProgramContext&, const Instruction&, std::byte* to, const std::byte* a,
                            const std::byte* b) noexcept TAPPET_REALTIME {
        const R value =
            Function(load_operand<std::remove_cvref_t<A>>(a), load_operand<std::remove_cvref_t<B>>(b));
        std::memcpy(to, std::addressof(value), sizeof value);
        return ActionResult::done;
    }
};

} // namespace detail

/// `Function`: a free function `R f(A)` or `R f(A, B)` noexcept TAPPET_REALTIME, values or const references.
template <text Name, auto Function>
struct Op {
    static constexpr auto name = Name;
    using Call = detail::RegisteredCall<Function>;
};

template <class... Ops>
struct Registered {
    static constexpr RegisteredOperator rows[] = {
        {Ops::name.view(), Ops::Call::result, Ops::Call::operands, &Ops::Call::run}...};
    static constexpr const RegisteredOperator* list = rows;
    static constexpr std::size_t count = sizeof...(Ops);
};

} // namespace tappet
