// A component type as the framework knows it: its size, its interface and the functions of its life, as plain
// data.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/decimal.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/whole_value.hpp"
#include "kernel/component/device_traffic.hpp"
#include "kernel/component/interface.hpp"
#include "kernel/component/life_functions.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/component/peer_property.hpp"
#include "kernel/component/wire_counters.hpp"

#include <algorithm>
#include <new>
#include <span>
#include <string_view>

namespace tappet {

/// Describes what is wrong with a value for that property: longer than its type, out of its range, not a
/// number, not a named value of its enumeration, a text that no file keeps. Empty: nothing. Every way to a
/// property asks here.
[[nodiscard]] inline Sentence check_range(const Facet& facet, const std::byte* value) noexcept
    TAPPET_REALTIME {
    const PropertyOperations& of = *facet.property;
    const TypeTag& type = *of.element;
    const Range range = range_of(facet);
    Sentence text{"property \"", facet.name, "\": "};
    if (!is_whole(*facet.type, value)) return text.add("is longer than its type; propose a shorter value");
    for (std::size_t i = 0; i < of.size(value); ++i) {
        if (of.kind == PropertySetting::Kind::text) {
            const std::byte* const element = value + i * type.size;
            if (std::find(element, element + length_in(type, element), std::byte{0}) !=
                element + length_in(type, element))
                return text.add("holds a zero character, which no file keeps; leave it out");
            continue;
        }
        const double number = of.number(value, i);
        if (type.kind == ValueKind::enumeration && !(number >= 0 && number < double(type.names.size())))
            return text.add(decimal(number))
                .add(" is not one of its ")
                .add(type.names.size())
                .add(" values; propose a named one");
        if (range.holds(number)) continue;
        if (of.is_list) text.add("element ").add(i).add(" ");
        if (!is_number(number)) return text.add("is not a finite number; propose a finite one");
        text.add(number < facet.range.low ? "is under its least value " : "is over its greatest value ");
        if (number < facet.range.low) text.add(decimal(facet.range.low));
        if (number > facet.range.high) text.add(decimal(facet.range.high));
        if (of.kind == PropertySetting::Kind::duration) text.add(" s");
        return text.add("; propose a value in its range");
    }
    return {};
}

class OutputGate;     ///< kernel/component/output_gate.hpp
struct Controlled;    ///< kernel/machine/instance/controlled.hpp
struct ScriptUnit;    ///< kernel/script/unit.hpp
struct LineFunctions; ///< kernel/machine/instance/line_functions.hpp

// clang-format off
/// A component is a plain struct. The framework uses those of the following members that it has, in this
/// order of its life. The table's check refuses a member with such a name, or nearly such a name, that is
/// spelled otherwise:
///     Sentence configure(Setup&)  once, before arming; not real-time; an empty sentence is consent
///     Sentence initialise()       before each start of its activity, on the makers' thread; not real-time
///     void start(const Cycle&) noexcept TAPPET_REALTIME   in its activity, before the first step; also
///                            after each stop
///     void step(const Cycle&) noexcept TAPPET_REALTIME    in each cycle of its activity
///     void work(const Cycle&)     instead of step: may block; for activities that are not_real_time
///     Sentence accepts(const Proposal&) const noexcept TAPPET_REALTIME  before properties
///                            change, together; an empty sentence is consent
///     void changed() noexcept TAPPET_REALTIME             after properties changed, between two steps
///     void loop(LoopControl&)     instead of step: decides itself when it runs; alone in its activity
///     void break_loop()           makes a blocked loop() return; on a thread for that alone
///     void stop(const Cycle&) noexcept TAPPET_REALTIME    leaves safe values behind; also
///                            when an input kept it from its start
///     bool stopped_safely() const noexcept TAPPET_REALTIME  of a driver: false after a stop() whose
///                            safe values did not reach the device
///     void finalise()             after its activity stopped, on the makers' thread; not real-time
// clang-format on
struct ComponentType {
    /// The aspect of another component that this one controls when its row makes it that one's master.
    enum class Controls : std::uint8_t { nothing, life, behaviour };
    TypeId tag = nullptr;
    std::size_t size = 0;
    std::size_t align = 0;
    std::span<const Facet> facets{};
    const DeviceKind* device_kind = nullptr; ///< kind of the device that it drives; null: none
    /// Its device wakes its activity: its configure() gives the device to Setup::woken_by(), and start-up
    /// refuses it otherwise. A driver without it polls its device.
    bool woken_by_device = false;
    std::span<const std::string_view> device_lines{}; ///< lines of that device that it needs, by logical name
    /// The fault of what is on that device; the table's check reports it.
    std::string_view device_fault{};
    const void* device_map =
        nullptr;              ///< map of what is on that device; only a start-up that knows the kind reads it
    DevicePace device_pace{}; ///< what its map lets cross most often; a periodic activity is as fast
    DeviceTraffic device_traffic{}; ///< the traffic of that device, and whether it can carry it
    /// Returns what was not sent as written of an input of a driver, or not passed on of an output; null: it
    /// has no such ports. Any thread.
    Unsent (*unsent)(const void* component, std::size_t facet) = nullptr;
    /// Gives an output of a driver, by the number of its facets (drives_output), a gate that outlives the
    /// machine; null: it has no such outputs. Before anything runs.
    void (*gate_output)(void* component, std::size_t output, OutputGate& gate) = nullptr;
    bool shares_device = false; ///< it may share the device with its driver; what it calls is safe there
    bool behaviour_required = false;
    bool sees_machine = false;            ///< it gets the machine: a service that shows, stores or changes it
    bool records_cycles = false;          ///< it gets the tapes of all activities
    const LineFunctions* lines = nullptr; ///< it sees the machine, and executes lines of the script language
    bool watches_life = false;            ///< its row names an activity or an output with watches(...)
    bool slot_required = false;           ///< it needs room for a behaviour that is loaded later
    Controls controls = Controls::nothing; ///< its row names another component with controls(...)
    const ScriptUnit* script = nullptr;    ///< script of the behaviour that it controls; null: any
    std::string_view instance{};           ///< name of the instance in that script
    NeverRun never_run{};                  ///< a member that the table's check refuses
    void (*construct)(void* memory) = nullptr;
    Sentence (*configure)(void* component, Setup&) = nullptr;
    Sentence (*initialise)(void* component) = nullptr;
    void (*finalise)(void* component) = nullptr;
    void (*start)(void* component, const Cycle&) noexcept TAPPET_REALTIME = nullptr;
    void (*step)(void* component, const Cycle&) noexcept TAPPET_REALTIME = nullptr;
    void (*work)(void* component, const Cycle&) = nullptr;
    void (*loop)(void* component, LoopControl&) = nullptr;
    void (*break_loop)(void* component) = nullptr;
    void (*stop)(void* component, const Cycle&) noexcept TAPPET_REALTIME = nullptr;
    bool (*stopped_safely)(const void* component) noexcept TAPPET_REALTIME = nullptr;
    Sentence (*accepts)(const void* component, const Proposal&) noexcept TAPPET_REALTIME = nullptr;
    void (*changed)(void* component) noexcept TAPPET_REALTIME = nullptr;
    void (*control)(void* component, const Controlled&) = nullptr; ///< before its properties are set

    /// Changes properties: the only way once they are configured. Checks the ranges, asks the component and,
    /// when it consents, sets all values together. Returns why it refuses; empty: done. Called where the
    /// component runs, or while it is stopped. Real-time.
    Sentence change(void* component, std::span<const ProposedValue> values) const noexcept TAPPET_REALTIME {
        for (const ProposedValue& each : values)
            if (const Sentence fault = check_range(facets[each.facet], each.value); !fault.empty())
                return fault;
        if (accepts != nullptr)
            if (const Sentence refusal = accepts(component, Proposal{values}); !refusal.empty())
                return refusal;
        for (const ProposedValue& each : values) std::memcpy(each.target, each.value, each.size);
        if (changed != nullptr) changed(component);
        return {};
    }
};

namespace detail {

template <class T>
inline constexpr const auto& facets_of = full_facets<T>();

template <class T>
constexpr ComponentType describe() {
    ComponentType type;
    type.tag = type_id<T>;
    type.size = sizeof(T);
    type.align = alignof(T);
    type.facets = facets_of<T>;
    type.construct = [](void* memory) { new (memory) T{}; };
    if constexpr (requires { T::device_fault; }) type.device_fault = T::device_fault;
    if constexpr (requires { T::device_kind; }) type.device_kind = &T::device_kind;
    if constexpr (requires { T::woken_by_device; }) type.woken_by_device = T::woken_by_device;
    if constexpr (requires { T::device_pace; }) type.device_pace = T::device_pace;
    if constexpr (requires { T::device_lines(); }) type.device_lines = T::device_lines();
    if constexpr (requires { T::device_map; }) type.device_map = &T::device_map;
    if constexpr (requires { T::device_traffic; }) type.device_traffic = T::device_traffic;
    if constexpr (requires { &T::unsent; }) type.unsent = &T::unsent;
    if constexpr (requires { &T::gate_output; }) type.gate_output = &T::gate_output;
    if constexpr (requires { T::shares_device; }) type.shares_device = T::shares_device;
    if constexpr (requires { T::sees_machine; }) type.sees_machine = T::sees_machine;
    if constexpr (requires { T::line_functions; }) type.lines = &T::line_functions;
    if constexpr (requires { T::records_cycles; }) type.records_cycles = T::records_cycles;
    if constexpr (requires { T::watches_life; }) type.watches_life = T::watches_life;
    if constexpr (requires { T::slot_required; }) type.slot_required = T::slot_required;
    if constexpr (requires(T& t, const Controlled& controlled) { t.control(controlled); }) {
        type.controls = T::controls;
        type.control = [](void* c, const Controlled& controlled) { static_cast<T*>(c)->control(controlled); };
        if constexpr (T::controls == ComponentType::Controls::behaviour) {
            type.script = T::script_unit;
            type.instance = T::instance_name;
        }
    }
    if constexpr (requires { T::behaviour_required; }) type.behaviour_required = T::behaviour_required;
    if constexpr (life_configure<T>)
        type.configure = [](void* c, Setup& s) { return static_cast<T*>(c)->configure(s); };
    if constexpr (life_initialise<T>)
        type.initialise = [](void* c) -> Sentence { return static_cast<T*>(c)->initialise(); };
    if constexpr (life_finalise<T>) type.finalise = [](void* c) { static_cast<T*>(c)->finalise(); };
    if constexpr (life_start<T>)
        type.start = [](void* c, const Cycle& cycle) noexcept
            TAPPET_REALTIME { static_cast<T*>(c)->start(cycle); };
    if constexpr (life_step<T>)
        type.step = [](void* c, const Cycle& cycle) noexcept
            TAPPET_REALTIME { static_cast<T*>(c)->step(cycle); };
    if constexpr (life_work<T>)
        type.work = [](void* c, const Cycle& cycle) { static_cast<T*>(c)->work(cycle); };
    if constexpr (life_loop<T>)
        type.loop = [](void* c, LoopControl& control) { static_cast<T*>(c)->loop(control); };
    if constexpr (life_break_loop<T>) type.break_loop = [](void* c) { static_cast<T*>(c)->break_loop(); };
    if constexpr (life_stop<T>)
        type.stop = [](void* c, const Cycle& cycle) noexcept
            TAPPET_REALTIME { static_cast<T*>(c)->stop(cycle); };
    if constexpr (life_stopped_safely<T>)
        type.stopped_safely = [](const void* c) noexcept
            TAPPET_REALTIME { return static_cast<const T*>(c)->stopped_safely(); };
    if constexpr (life_accepts<T>)
        type.accepts = [](const void* c, const Proposal& proposal) noexcept
            TAPPET_REALTIME { return static_cast<const T*>(c)->accepts(proposal); };
    if constexpr (life_changed<T>)
        type.changed = [](void* c) noexcept TAPPET_REALTIME { static_cast<T*>(c)->changed(); };
    type.never_run = first_never_run<T>(type.facets);
    return type;
}

} // namespace detail

template <class T>
inline constexpr ComponentType component_type = detail::describe<T>();

inline bool detail::set_property(const ComponentType& type, const CommandOperations& setting, void* component,
                                 void* property, std::byte* value) noexcept TAPPET_REALTIME {
    for (std::size_t f = 0; f < type.facets.size(); ++f) {
        const Facet& facet = type.facets[f];
        if (facet.kind != FacetKind::property || facet.at != setting.property) continue;
        const PropertyOperations& of = *facet.property;
        if (is_whole(*facet.type, value)) of.resize(value, of.size(value)); // no old bytes behind its end
        const ProposedValue proposed{static_cast<std::byte*>(property), value,
                                     static_cast<std::uint32_t>(facet.type->size),
                                     static_cast<std::uint32_t>(f)};
        return type.change(component, {&proposed, 1}).empty();
    }
    return false; // the table's check refuses it
}

} // namespace tappet
