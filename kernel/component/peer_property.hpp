// Properties that peers may set and read (thesis 4.1.2, 4.7). The owner declares a setter, a getter, or both;
// a row of the table connects a peer's command to each.
//
//     struct Pump {                                            struct Tuner {
//         Property<double> limit{4.0};                             CommandCall<double> set;
//         ... property<&Pump::limit>("limit", "bar", ..)           CommandCall<double&> get;
//         ... setter<&Pump::limit>("set_limit", "..")              ... sends<&Tuner::set>("set", "..")
//         ... getter<&Pump::limit>("get_limit", "..")              ... sends<&Tuner::get>("get", "..")
//     };                                                       };
//     uses("tuner.set", "pump.set_limit"), uses("tuner.get", "pump.get_limit")
#pragma once

#include "kernel/component/operation_interface.hpp"

#include <array>
#include <cstring>

namespace tappet {

namespace detail {

/// Changes the property by the component's type in the table, whichever class declares the member; see
/// component.hpp. `value` is aligned and may be changed.
bool set_property(const ComponentType& type, const CommandOperations& setting, void* component,
                  void* property, std::byte* value) noexcept TAPPET_REALTIME;

/// Commands of the property behind a member. They run in the owner's engine, between two of its steps.
template <auto Member>
struct PeerProperty {
    using M = MemberOf<Member>;
    using Value = typename M::Type::Value;

    static auto& property_of(void* component) noexcept TAPPET_REALTIME {
        return static_cast<typename M::Component*>(component)->*Member;
    }
    static bool set(GatedComponent& gate, std::byte* values) noexcept TAPPET_REALTIME {
        alignas(Value) std::array<std::byte, sizeof(Value)> value; // the sent values are packed
        std::memcpy(value.data(), values, sizeof(Value));
        bool taken = false;
        const bool entered = gate.enter(Entry::queued, [&](void* component) noexcept TAPPET_REALTIME {
            taken = set_property(*gate.type, setting, component, static_cast<void*>(&property_of(component)),
                                 value.data());
        });
        return entered && taken;
    }
    static bool get(void* component, std::byte* values) noexcept TAPPET_REALTIME {
        std::memcpy(values, &property_of(component).get(), sizeof(Value));
        return true;
    }
    static constexpr CommandOperations setting{.arguments = type_id<Arguments<Value>>,
                                               .results = type_id<Arguments<>>,
                                               .argument_bytes = sizeof(Value),
                                               .begin = &set,
                                               .property = &M::at};
    static constexpr CommandOperations getting{.arguments = type_id<Arguments<>>,
                                               .results = type_id<Arguments<Value>>,
                                               .result_bytes = sizeof(Value),
                                               .begin = &GatedCommand<&get, nullptr>::begin,
                                               .property = &M::at};
};

} // namespace detail

/// A command with which a peer sets a property; its argument is the value. It is rejected, and nothing
/// changes, when the value is out of the property's range or not a number, when the owner's accepts() refuses
/// it, and while the owner does not run. Real-time.
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

/// A command with which a peer reads a property: the value is its result. It is rejected while the owner does
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
