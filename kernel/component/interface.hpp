// How a component spells its interface: one constexpr list, next to its members.
//
//     struct MainShaft {
//         Input<double> measured;
//         Event<> pick_window;
//         void step(const Cycle&) noexcept TAPPET_REALTIME;
//         static constexpr auto interface() {
//             return facets(input<&MainShaft::measured>("measured", "deg", "angle of the last sample"),
//                           event<&MainShaft::pick_window>("pick_window", "the weft may be released"));
//         }
//     };
#pragma once

#include "kernel/component/facet.hpp"
#include "kernel/component/property_interface.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

namespace tappet {

/// Marks an input that may stay unconnected. any_thread marks an operation that any activity may call.
struct Optional {};
inline constexpr Optional optional{};
struct AnyThread {};
inline constexpr AnyThread any_thread{};
/// Marks a method or a command whose function blocks, and is declared noexcept without TAPPET_REALTIME
/// (thesis 4.5.2). Only activities that are not_real_time call such a method or run such a command. A
/// completion never blocks. Meanwhile that activity serves nothing else.
struct MayBlock {};
inline constexpr MayBlock may_block{};
/// Marks an operation that at least one reaction of the table must name.
struct Required {};
inline constexpr Required required{};
/// Marks an input without whose valid value its component does not start, not even with the machine: it waits
/// for the value. (A component that is started while the machine runs needs all its required inputs, except
/// those in a circle of connections.)
struct ValidToStart {};
inline constexpr ValidToStart valid_to_start{};
/// Marks an input whose component needs staleness to detect silence: its row must say stale_after(...).
struct GrowsStale {};
inline constexpr GrowsStale grows_stale{};
/// Marks an input that its component, which a device wakes, looks at only when it is woken: rows from other
/// activities say `wakes`.
struct NeedsWake {};
inline constexpr NeedsWake needs_wake{};
/// States that an output's values come from outside in this period: its rows say stale_after(...), and a
/// longer time. An input's values go outside in this period. A periodic activity is at least as fast. 0: at
/// any time.
struct ComesEvery {
    Duration period;
};
constexpr ComesEvery comes_every(Duration period) noexcept { return {period}; }
/// States that an input or an operation drives this output of a device, by the number that `hold` of its
/// component knows, and its safe value. held_in of the table may name it.
struct DrivesOutput {
    std::size_t number;
    double safe;
};
constexpr DrivesOutput drives_output(std::size_t number, double safe) noexcept { return {number, safe}; }
/// States the value of an output of bool while its component is stopped, for example `connected` is false.
/// The engine writes it after stop(). A driver states it for each of its outputs of bool, or marks the output
/// as_it_was.
struct WhileStopped {
    AtRest says;
};
constexpr WhileStopped while_stopped(bool value) noexcept {
    return {value ? AtRest::says_true : AtRest::says_false};
}
inline constexpr WhileStopped as_it_was{AtRest::as_it_was};
/// States that the values of a driver's output have the time stamp of the edge or the frame that caused them.
struct StampsCause {};
inline constexpr StampsCause stamps_cause{};
/// Marks an event that matters to the machine's safety: at least so many reaction rows must name it.
struct HeardBy {
    std::uint8_t reactions = 1;
};
constexpr HeardBy heard_by(std::uint8_t reactions) noexcept { return {reactions}; }
/// Marks an operation, a method or a command that people at the machine may ask for, if they have at least
/// this role. Unmarked, it is for engineers at the machine only: it is a part of something that the machine
/// does by itself. `moves` marks what makes something move: nobody may ask for it over the network.
/// `moves_while_held` marks what moves as long as somebody holds a button at the machine's panel.
struct ForPeople {
    Role least;
    Motion motion;
};
constexpr ForPeople for_people(Role least, Motion motion = Motion::none) noexcept {
    return {std::max(least, Role::machine_operator), motion};
}
inline constexpr Motion moves = Motion::moves;
inline constexpr Motion moves_while_held = Motion::moves_while_held;

namespace detail {

template <class>
struct EventArguments;
template <class... A>
struct EventArguments<Event<A...>> {
    using Signature = Arguments<A...>;
    static constexpr const EventOperations* operations = &PortAccess::event<A...>;
};

template <class>
struct WaitArguments;
template <class... A>
struct WaitArguments<EventWait<A...>> {
    using Signature = Arguments<A...>;
    /// Returns the EventWaitState.
    template <auto Member>
    static void* at(void* component, std::size_t index) noexcept {
        return static_cast<EventWaitState*>(
            static_cast<EventWait<A...>*>(MemberOf<Member>::at(component, index)));
    }
};

template <auto Method>
inline constexpr OperationOperations operation_of = {&operation_entry<Method>, &OperationCall<Method>::run};

template <auto Method>
struct TimerCall {
    static constexpr bool is_run = false;
    static constexpr TimerOperations operations{}; // so that the static_assert stays the only error
};
template <class Component, void (Component::*Method)(const Cycle&) noexcept>
struct TimerCall<Method> {
    static constexpr bool is_run = true;
    static constexpr TimerOperations operations{
        [](void* component, const Cycle& cycle) noexcept
        TAPPET_REALTIME { (static_cast<Component*>(component)->*Method)(cycle); }};
};

constexpr void apply(Facet& facet, Optional) noexcept { facet.required = false; }
constexpr void apply(Facet& facet, Required) noexcept { facet.required = true; }
constexpr void apply(Facet& facet, ValidToStart) noexcept { facet.valid_to_start = true; }
constexpr void apply(Facet& facet, GrowsStale) noexcept { facet.grows_stale = true; }
constexpr void apply(Facet& facet, NeedsWake) noexcept { facet.needs_wake = true; }
constexpr void apply(Facet& facet, ComesEvery values) noexcept { facet.comes_every = values.period; }
constexpr void apply(Facet& facet, DrivesOutput output) noexcept {
    facet.device_output = static_cast<std::uint16_t>(output.number + 1);
    facet.safe_value = output.safe;
}
constexpr void apply(Facet& facet, WhileStopped stopped) noexcept { facet.at_rest = stopped.says; }
constexpr void apply(Facet& facet, StampsCause) noexcept { facet.stamps_cause = true; }
constexpr void apply(Facet& facet, HeardBy by) noexcept { facet.least_reactions = by.reactions; }
constexpr void apply(Facet& facet, AnyThread) noexcept { facet.any_thread = true; }
constexpr void apply(Facet& facet, MayBlock) noexcept { facet.may_block = true; }
constexpr void apply(Facet& facet, Motion motion) noexcept { facet.motion = motion; }
constexpr void apply(Facet& facet, ForPeople people) noexcept {
    facet.least_role = people.least;
    facet.for_people = true;
    facet.motion = people.motion;
}

template <class... Options>
constexpr Facet with(Facet facet, Options... options) noexcept {
    (apply(facet, options), ...);
    return facet;
}
template <class... Options>
inline constexpr bool says_may_block = (std::same_as<Options, MayBlock> || ...);

} // namespace detail

/// An input port; it must be connected unless `optional`.
template <auto Member, class... Options>
constexpr Facet input(std::string_view name, std::string_view unit, std::string_view doc,
                      Options... options) {
    using M = detail::MemberOf<Member>;
    using T = typename M::Type::Value;
    if constexpr (std::same_as<typename M::Type, BufferInput<T>>)
        return detail::with({.name = name,
                             .unit = unit,
                             .doc = doc,
                             .kind = FacetKind::buffer_input,
                             .type = type_id<T>,
                             .required = true,
                             .at = &M::at,
                             .buffer = &PortAccess::buffer<T>},
                            options...);
    else
        return detail::with({.name = name,
                             .unit = unit,
                             .doc = doc,
                             .kind = FacetKind::input,
                             .type = type_id<T>,
                             .required = true,
                             .at = &M::at,
                             .port = &PortAccess::data<T>},
                            options...);
}

template <auto Member, class... Options>
constexpr Facet output(std::string_view name, std::string_view unit, std::string_view doc,
                       Options... options) {
    using M = detail::MemberOf<Member>;
    using T = typename M::Type::Value;
    static_assert(std::same_as<typename M::Type, Output<bool>> ||
                      (!std::same_as<Options, WhileStopped> && ...),
                  "while_stopped(..) is for an Output<bool>; write other outputs in stop()");
    if constexpr (std::same_as<typename M::Type, BufferOutput<T>>)
        return {.name = name,
                .unit = unit,
                .doc = doc,
                .kind = FacetKind::buffer_output,
                .type = type_id<T>,
                .at = &M::at,
                .buffer = &PortAccess::buffer<T>};
    else
        return detail::with({.name = name,
                             .unit = unit,
                             .doc = doc,
                             .kind = FacetKind::output,
                             .type = type_id<T>,
                             .at = &M::at,
                             .port = &PortAccess::data<T>},
                            options...);
}

template <auto Member, class... Options>
constexpr Facet event(std::string_view name, std::string_view doc, Options... options) {
    using M = detail::MemberOf<Member>;
    using E = detail::EventArguments<typename M::Type>;
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::event,
                         .type = type_id<typename E::Signature>,
                         .at = &M::at,
                         .event = E::operations},
                        options...);
}

/// A member function `void f(A...) noexcept TAPPET_REALTIME`.
template <auto Method, class... Options>
constexpr Facet operation(std::string_view name, std::string_view doc, Options... options) {
    static_assert(OperationCall<Method>::is_operation,
                  "an operation is a member function that returns void, declared noexcept "
                  "TAPPET_REALTIME: it runs in the real-time activity");
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::operation,
                         .type = type_id<typename OperationCall<Method>::Signature>,
                         .operation = &detail::operation_of<Method>},
                        options...);
}

/// A member EventHandle; a row must name it with handled_by(...) unless `optional`.
template <auto Member, class... Options>
constexpr Facet handle(std::string_view name, std::string_view doc, Options... options) {
    using M = detail::MemberOf<Member>;
    static_assert(std::same_as<typename M::Type, EventHandle>, "a handle is a member of type EventHandle");
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::handle,
                         .type = type_id<EventHandle>,
                         .required = true,
                         .at = &M::at},
                        options...);
}

/// A member EventWait<A...>; a row must tell it an event unless `optional`.
template <auto Member, class... Options>
constexpr Facet awaits(std::string_view name, std::string_view doc, Options... options) {
    using M = detail::MemberOf<Member>;
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::wait,
                         .type = type_id<typename detail::WaitArguments<typename M::Type>::Signature>,
                         .required = true,
                         .at = &detail::WaitArguments<typename M::Type>::template at<Member>},
                        options...);
}

/// A timer and the member function it runs: `void f(const Cycle&) noexcept TAPPET_REALTIME`.
template <auto Member, auto Method>
constexpr Facet timer(std::string_view name, std::string_view doc) {
    static_assert(detail::TimerCall<Method>::is_run,
                  "a timer runs a member function void f(const Cycle&), declared noexcept TAPPET_REALTIME: "
                  "it runs in the real-time activity");
    return {.name = name,
            .doc = doc,
            .kind = FacetKind::timer,
            .type = type_id<Arguments<>>,
            .at = &detail::MemberOf<Member>::at,
            .timer = &detail::TimerCall<Method>::operations};
}

/// Makes the list of facets and bags.
template <class... F>
constexpr auto facets(const F&... each) {
    if constexpr ((std::same_as<F, Facet> && ...)) {
        return std::array<Facet, sizeof...(F)>{each...};
    } else {
        std::array<Facet, (std::size_t{0} + ... + detail::facet_count<F>)> all{};
        std::size_t at = 0;
        (detail::put(all, at, each), ...);
        return all;
    }
}

} // namespace tappet
