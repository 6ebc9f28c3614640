// Properties that peers may set and read (thesis 4.1.2, 4.7). The owner declares a setter, a getter, or both;
// a row of the table says whose commands they are.
//
//     struct Pump {                                            struct Tuner {
//         Property<double> limit{4.0};                             CommandCall<double> set;
//         ... property<&Pump::limit>("limit", "bar", ..)           CommandCall<double&> get;
//         ... setter<&Pump::limit>("set_limit", "..")              ... sends<&Tuner::set>("set", "..")
//         ... getter<&Pump::limit>("get_limit", "..")              ... sends<&Tuner::get>("get", "..")
//     };                                                       };
//     uses("tuner.set", "pump.set_limit"), uses("tuner.get", "pump.get_limit")
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/component/proposal.hpp"

#include <array>
#include <cstring>
#include <span>

namespace tappet {

namespace detail {

/// ComponentType::change; component.hpp has it.
template <class Owner>
Sentence change_properties(void* component, std::span<const ProposedValue> values) noexcept TAPPET_REALTIME;

/// Commands of the property behind a member. They run in the owner's engine, between two of its steps.
template <auto Member>
struct PeerProperty {
    using M = MemberOf<Member>;
    using Owner = typename M::Component;
    using Value = typename M::Type::Value;

    static constexpr std::size_t facet() noexcept {
        const auto& facets = full_facets<Owner>();
        std::size_t at = 0;
        while (at < facets.size() && !(facets[at].kind == FacetKind::property && facets[at].at == &M::at))
            ++at;
        return at;
    }
    static bool set(void* component, std::byte* values) noexcept TAPPET_REALTIME {
        constexpr std::size_t index = facet();
        static_assert(index < full_facets<Owner>().size(),
                      "a setter names a property that stands in its component's interface(), not in a bag");
        auto& property = static_cast<Owner*>(component)->*Member;
        alignas(Value) std::array<std::byte, sizeof(Value)> value; // what was sent is packed
        std::memcpy(value.data(), values, sizeof(Value));
        const ProposedValue proposed{static_cast<std::byte*>(static_cast<void*>(&property)), value.data(),
                                     sizeof(Value), static_cast<std::uint32_t>(index)};
        return change_properties<Owner>(component, {&proposed, 1}).empty();
    }
    static bool get(void* component, std::byte* values) noexcept TAPPET_REALTIME {
        std::memcpy(values, &(static_cast<const Owner*>(component)->*Member).get(), sizeof(Value));
        return true;
    }
    static constexpr CommandOperations setting{.arguments = type_id<Arguments<Value>>,
                                               .results = type_id<Arguments<>>,
                                               .argument_bytes = sizeof(Value),
                                               .begin = &GatedCommand<&set, nullptr>::begin};
    static constexpr CommandOperations getting{.arguments = type_id<Arguments<>>,
                                               .results = type_id<Arguments<Value>>,
                                               .result_bytes = sizeof(Value),
                                               .begin = &GatedCommand<&get, nullptr>::begin};
};

} // namespace detail

/// A command by which a peer sets a property, sent with its value. It is rejected, and nothing changes, when
/// the value is outside of the property's range or no number, when the owner's accepts() refuses it, and
/// while the owner does not run. Real-time.
template <auto Member, class... Options>
constexpr Facet setter(std::string_view name, std::string_view doc, Options... options) {
    using P = detail::PeerProperty<Member>;
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::command,
                         .type = type_id<Arguments<typename detail::Parameter<typename P::Value>::InName>>,
                         .command = &P::setting},
                        options...);
}

/// A command by which a peer reads a property: the value is its result. It is rejected while the owner does
/// not run. Real-time.
template <auto Member, class... Options>
constexpr Facet getter(std::string_view name, std::string_view doc, Options... options) {
    using P = detail::PeerProperty<Member>;
    return detail::with({.name = name,
                         .doc = doc,
                         .kind = FacetKind::command,
                         .type = type_id<Arguments<typename detail::Parameter<typename P::Value&>::InName>>,
                         .command = &P::getting},
                        options...);
}

} // namespace tappet
