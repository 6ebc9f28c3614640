// A facet: one named thing in a component's interface (thesis 4.1.2), as plain data. Rows of the machine
// table name facets; the checks read this data, and the start-up wires through the function pointers in it.
#pragma once

#include "kernel/base/type_tag.hpp"
#include "kernel/component/buffer_port.hpp"
#include "kernel/component/command.hpp"
#include "kernel/component/cycle.hpp"
#include "kernel/component/event.hpp"
#include "kernel/component/event_handle.hpp"
#include "kernel/component/event_wait.hpp"
#include "kernel/component/method.hpp"
#include "kernel/component/operation.hpp"
#include "kernel/component/port.hpp"
#include "kernel/component/property.hpp"
#include "kernel/component/role.hpp"
#include "kernel/component/timer.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string_view>

namespace tappet {

enum class FacetKind : std::uint8_t {
    input,
    output,
    buffer_input,
    buffer_output,
    event,
    operation,
    method,
    method_call,
    command,
    command_call,
    property,
    bag,
    timer,
    handle,
    wait
};

/// Start-up's access to data and buffer ports of one value type.
struct PortOperations {
    std::size_t shared_bytes;
    std::size_t shared_align;
    void (*place_shared)(void* output, void* memory);
    /// Links an input to an output of its activity; also while both run by turns with others, then in their
    /// activity between two steps. `writer`: the stops of the output's component; null: it never stops.
    void (*link_local)(void* input, const void* output, const Stops* writer) noexcept TAPPET_REALTIME;
    /// Called after link_local, when the turn was not refused to the writer.
    void (*hand_force_to)(void* input, const Stops* writer) noexcept TAPPET_REALTIME;
    /// Resets the output to never written, for readers of its own activity. Called as link_local.
    void (*forget)(void* output) noexcept TAPPET_REALTIME;
    void (*link_shared)(void* input, const void* output, const Stops* writer);
    void (*set_clock)(void* port, bool is_input, const Time* now);
    void (*set_waker)(void* output, Waker waker);
    /// Closes an output; null opens it. In the port's activity. Closing wakes what a value would wake.
    void (*close)(void* output, DroppedWrites* counter) noexcept TAPPET_REALTIME;
    void (*set_filter)(void* output, PortFilter* filter);
    void (*set_policy)(void* input, const InputPolicy&);
    /// Returns the flow of an input. An abandoned value counts by its age alone: it keeps no component from
    /// its start.
    Flow (*flow)(void* input) noexcept TAPPET_REALTIME;
    /// Returns whether an output was ever written; a force does not count.
    bool (*is_written)(const void* output) noexcept TAPPET_REALTIME;
    Time (*expires)(const void* input) noexcept TAPPET_REALTIME;
    /// Returns the number of values that a shared data object was given; any thread.
    std::uint64_t (*written)(const void* shared) noexcept TAPPET_REALTIME;
    PortPlaces (*places)(const void* port, bool is_input) noexcept TAPPET_REALTIME;
    /// Forces a value from outside, as bytes, in place of what flows; between two steps of the port's
    /// activity.
    bool (*force)(void* port, bool is_input, const std::byte* value) noexcept TAPPET_REALTIME;
    void (*release)(void* port, bool is_input) noexcept TAPPET_REALTIME;
    /// Ends the force of a port because its component stops. The hidden value is abandoned.
    void (*end_force)(void* port, bool is_input) noexcept TAPPET_REALTIME;
    /// The component of this output begins to stop: from here on the output writes in the life `life`.
    void (*begin_life)(void* output, Life life) noexcept TAPPET_REALTIME;
    /// The component of this input starts.
    void (*resume)(void* input) noexcept TAPPET_REALTIME;
    /// Reads the value that an input gives its component, or that its component last gave an output, as
    /// bytes. In the port's activity. `looks`: a fresh value stays fresh.
    Flow (*read)(void* port, bool is_input, bool looks, std::byte* into) noexcept TAPPET_REALTIME;
    void (*write)(void* output, const std::byte* value) noexcept TAPPET_REALTIME;
    /// Writes a value that was true at `stamp`.
    void (*write_at)(void* output, const std::byte* value, Time stamp) noexcept TAPPET_REALTIME;
    // For a component whose ports follow from a table: memory for one port, on a cache line of its own.
    std::size_t input_bytes, output_bytes;
    void (*construct)(void* memory, bool is_input);
};

struct BufferOperations {
    // `across`: the two ends are in two activities.
    std::size_t (*ring_bytes)(std::size_t capacity, bool across);
    std::size_t ring_align;
    void (*link)(void* output, void* input, std::byte* memory, std::size_t capacity, Overflow, bool across);
    void (*set_waker)(void* output, Waker waker);
    void (*close)(void* output, DroppedWrites* counter) noexcept TAPPET_REALTIME;
    std::size_t (*lost)(const void* memory, bool across);
    // In the port's activity.
    bool (*push)(void* output, const std::byte* value) noexcept TAPPET_REALTIME;
    bool (*pop)(void* input, std::byte* into) noexcept TAPPET_REALTIME;
    bool (*empty)(const void* input) noexcept TAPPET_REALTIME;
};

struct EventOperations {
    std::size_t subscriber_bytes; ///< of one subscriber
    void (*give_storage)(void* event, void* subscribers);
    /// Adds the next row; `call` points at a typed function pointer. Returns the word of the event's
    /// connections, in which the n-th row has the n-th bit.
    std::atomic<std::uint64_t>& (*subscribe)(void* event, const void* call, void* context);
    const void* post;  ///< points at the call of the asynchronous reaction, as above
    const void* count; ///< points at that of a reaction that counts in a std::atomic<std::uint64_t>
    /// Emits with packed arguments, for emitters that know no C++ type.
    void (*emit)(void* event, const std::byte* packed) noexcept TAPPET_REALTIME;
    std::size_t event_bytes; ///< with construct(): as for a port
    void (*construct)(void* memory);
};

struct OperationOperations {
    const void* enter; ///< points at a `void (*const)(void* gated, A...)`: a GatedComponent
    /// Returns false when the component cannot be reached that way; then nothing ran.
    bool (*run)(GatedComponent&, Entry, const std::byte* packed) noexcept TAPPET_REALTIME;
};

struct TimerOperations {
    void (*fire)(void* component, const Cycle&) noexcept TAPPET_REALTIME;
};

/// The value of an output of bool while its component is stopped. A driver must state it.
enum class AtRest : std::uint8_t { unsaid, as_it_was, says_false, says_true };

struct Facet {
    std::string_view name{};
    std::string_view unit{};
    std::string_view doc{};
    FacetKind kind = FacetKind::input;
    TypeId type = nullptr; ///< of the value, or of the argument list
    bool required =
        false; ///< an input or a call that must be connected, an operation that a reaction must name
    bool valid_to_start = false; ///< an input: its component does not start before it has a valid value
    bool grows_stale = false;    ///< an input: its row says when its value is stale
    bool needs_wake = false;     ///< an input: its component looks at it only when it is woken
    Duration comes_every{};      ///< its values cross a wire to or from outside in this period; 0: not so
    /// An input or an operation: number + 1 of the device's output that it drives and that has a safe value.
    std::uint16_t device_output = 0;
    double safe_value = 0;           ///< of that output
    AtRest at_rest = AtRest::unsaid; ///< of an output of bool
    /// An output: its values have the time stamp of the edge or the frame that caused them.
    bool stamps_cause = false;
    std::uint8_t least_reactions = 0; ///< of an event: least number of reaction rows that must name it
    bool any_thread = false;          ///< an operation or a method that any activity may call
    bool may_block = false;           ///< a method or a command; never in a real-time activity
    Role least_role = Role::engineer; ///< lowest role for a property, an operation, a method or a command
    bool for_people = false;          ///< its interface offers it to people
    Motion motion = Motion::none;     ///< of an operation, a method or a command
    Range range{};                    ///< of a property
    std::size_t index = 0;            ///< within a member that is an array
    std::size_t members = 0; ///< of a bag: number of facets after it that are in it, with those of inner bags
    void* (*at)(void* component, std::size_t index) noexcept = nullptr;
    // One of these is set, by kind.
    const PortOperations* port = nullptr;
    const BufferOperations* buffer = nullptr;
    const EventOperations* event = nullptr;
    const OperationOperations* operation = nullptr;
    const MethodOperations* method = nullptr;
    const MethodCallOperations* method_call = nullptr;
    const CommandOperations* command = nullptr;
    const CommandCallOperations* command_call = nullptr;
    const PropertyOperations* property = nullptr;
    const TimerOperations* timer = nullptr;
};

/// A property's range in the numbers that its type has: both ends are in it, although a float rounds them and
/// a time is a whole number of nanoseconds.
constexpr Range range_of(const Facet& facet) noexcept TAPPET_REALTIME {
    const PropertyOperations& of = *facet.property;
    const Range& range = facet.range;
    if (of.kind == PropertySetting::Kind::duration) return {range.low - 0.5e-9, range.high + 0.5e-9};
    if (of.kind != PropertySetting::Kind::real || of.element->size != sizeof(float)) return range;
    const auto rounded = [](double end) {
        constexpr double most = std::numeric_limits<float>::max();
        return end >= -most && end <= most ? double{static_cast<float>(end)} : end;
    };
    return {rounded(range.low), rounded(range.high)};
}

constexpr std::string_view to_text(FacetKind kind) noexcept {
    switch (kind) {
    case FacetKind::input: return "an input";
    case FacetKind::output: return "an output";
    case FacetKind::buffer_input: return "a buffered input";
    case FacetKind::buffer_output: return "a buffered output";
    case FacetKind::event: return "an event";
    case FacetKind::operation: return "an operation";
    case FacetKind::method: return "a method";
    case FacetKind::method_call: return "a method call";
    case FacetKind::command: return "a command";
    case FacetKind::command_call: return "a command call";
    case FacetKind::property: return "a property";
    case FacetKind::bag: return "a bag of properties";
    case FacetKind::timer: return "a timer";
    case FacetKind::handle: return "a handle of a reaction";
    case FacetKind::wait: return "a wait for an event";
    }
    return "a facet";
}

/// Access to ports for start-up only.
struct PortAccess {
    /// Returns the value of a checked row, or the default where the row gives none.
    template <class T>
    static T value_in(const RowValue& row) {
        if (row.constant != nullptr) return *static_cast<const T*>(row.constant);
        if constexpr (std::is_arithmetic_v<T>)
            return static_cast<T>(row.number);
        else
            return default_value<T>();
    }

    template <class T>
    static constexpr PortOperations data{
        .shared_bytes = sizeof(DataObject<Sample<T>>),
        .shared_align = alignof(DataObject<Sample<T>>),
        .place_shared =
            [](void* output, void* memory) {
                auto& out = *static_cast<Output<T>*>(output);
                out.shared_ = new (memory) DataObject<Sample<T>>;
                out.settle();
            },
        .link_local =
            [](void* input, const void* output, const Stops* writer) noexcept TAPPET_REALTIME {
                static_cast<Input<T>*>(input)->link(static_cast<const Output<T>*>(output), writer);
            },
        .hand_force_to = [](void* input, const Stops* writer) noexcept
        TAPPET_REALTIME { static_cast<Input<T>*>(input)->hand_force_to(writer); },
        .forget =
            [](void* output) noexcept TAPPET_REALTIME {
                auto& out = *static_cast<Output<T>*>(output);
                out.last_.life = never_lived;
                out.settle();
            },
        .link_shared =
            [](void* input, const void* output, const Stops* writer) {
                auto& in = *static_cast<Input<T>*>(input);
                in.shared_ = static_cast<const Output<T>*>(output)->shared_;
                in.linked_ = writer;
            },
        .set_clock =
            [](void* port, bool is_input, const Time* now) {
                if (is_input)
                    static_cast<Input<T>*>(port)->now_ = now;
                else
                    static_cast<Output<T>*>(port)->now_ = now;
            },
        .set_waker =
            [](void* output, Waker waker) {
                auto& out = *static_cast<Output<T>*>(output);
                out.waker_ = waker;
                out.settle();
            },
        .close =
            [](void* output, DroppedWrites* counter) noexcept TAPPET_REALTIME {
                auto& out = *static_cast<Output<T>*>(output);
                out.dropped_ = counter;
                out.settle();
                if (counter != nullptr) out.waker_();
            },
        .set_filter =
            [](void* output, PortFilter* filter) {
                auto& out = *static_cast<Output<T>*>(output);
                out.filter_ = filter;
                out.settle();
            },
        .set_policy =
            [](void* input, const InputPolicy& policy) {
                auto& in = *static_cast<Input<T>*>(input);
                in.max_age_ = policy.max_age;
                in.settle();
                in.when_stale_ = policy.when_stale;
                in.is_cause_ = policy.is_cause;
                if constexpr (std::is_floating_point_v<T>) in.scale_ = {policy.scale, policy.between};
                in.substitute_ = value_in<T>(policy.substitute);
                in.before_first_ =
                    value_in<T>(policy.before_first.given ? policy.before_first : policy.substitute);
            },
        .flow = [](void* input) noexcept
        TAPPET_REALTIME { return static_cast<Input<T>*>(input)->look(never_lived); },
        .is_written = [](const void* output) noexcept
        TAPPET_REALTIME { return static_cast<const Output<T>*>(output)->last_.life != never_lived; },
        .expires = [](const void* input) noexcept
        TAPPET_REALTIME { return static_cast<const Input<T>*>(input)->expires(); },
        .written = [](const void* shared) noexcept
        TAPPET_REALTIME { return static_cast<const DataObject<Sample<T>>*>(shared)->generation(); },
        .places =
            [](const void* port, bool is_input) noexcept TAPPET_REALTIME {
                if (!is_input) {
                    const auto& out = *static_cast<const Output<T>*>(port);
                    return PortPlaces{&out.last_.value, &out.last_.stamp, &out.generation_, &out.forced_,
                                      nullptr};
                }
                const auto& in = *static_cast<const Input<T>*>(port);
                if (in.local_ == nullptr)
                    return PortPlaces{&in.cache_.value, &in.cache_.stamp, &in.cached_generation_, &in.forced_,
                                      &in.cache_.value};
                return PortPlaces{&in.local_->last_.value, &in.local_->last_.stamp, &in.local_->generation_,
                                  &in.forced_, &in.cache_.value};
            },
        .force =
            [](void* port, bool is_input, const std::byte* bytes) noexcept TAPPET_REALTIME {
                T value = default_value<T>();
                std::memcpy(static_cast<void*>(std::addressof(value)), bytes, sizeof value);
                return is_input ? static_cast<Input<T>*>(port)->force(value)
                                : static_cast<Output<T>*>(port)->force(value);
            },
        .release =
            [](void* port, bool is_input) noexcept TAPPET_REALTIME {
                is_input ? static_cast<Input<T>*>(port)->release() : static_cast<Output<T>*>(port)->release();
            },
        .end_force =
            [](void* port, bool is_input) noexcept TAPPET_REALTIME {
                is_input ? static_cast<Input<T>*>(port)->end_force()
                         : static_cast<Output<T>*>(port)->end_force();
            },
        .begin_life = [](void* output, Life life) noexcept
        TAPPET_REALTIME { static_cast<Output<T>*>(output)->begin_life(life); },
        .resume = [](void* input) noexcept TAPPET_REALTIME { static_cast<Input<T>*>(input)->resume(); },
        .read =
            [](void* port, bool is_input, bool looks, std::byte* into) noexcept TAPPET_REALTIME {
                if (!is_input) {
                    std::memcpy(into, std::addressof(static_cast<const Output<T>*>(port)->last()), sizeof(T));
                    return Flow::old;
                }
                auto& in = *static_cast<Input<T>*>(port);
                const Flow flow = looks ? in.flow() : in.refresh();
                std::memcpy(into, std::addressof(in.value_of(flow)), sizeof(T));
                return flow;
            },
        .write =
            [](void* output, const std::byte* bytes) noexcept TAPPET_REALTIME {
                T value = default_value<T>();
                std::memcpy(static_cast<void*>(std::addressof(value)), bytes, sizeof value);
                static_cast<Output<T>*>(output)->write(value);
            },
        .write_at =
            [](void* output, const std::byte* bytes, Time stamp) noexcept TAPPET_REALTIME {
                T value = default_value<T>();
                std::memcpy(static_cast<void*>(std::addressof(value)), bytes, sizeof value);
                static_cast<Output<T>*>(output)->write(value, stamp);
            },
        .input_bytes = sizeof(Input<T>),
        .output_bytes = sizeof(Output<T>),
        .construct =
            [](void* memory, bool is_input) {
                if (is_input)
                    new (memory) Input<T>;
                else
                    new (memory) Output<T>;
            },
    };

    /// Offset of a ring's storage behind the ring itself.
    template <class AnyRing>
    static constexpr std::size_t storage_at =
        (sizeof(AnyRing) + AnyRing::alignment - 1) / AnyRing::alignment * AnyRing::alignment;

    template <class T>
    static constexpr BufferOperations buffer{
        .ring_bytes =
            [](std::size_t capacity, bool across) {
                return across ? storage_at<Ring<T>> + Ring<T>::bytes_for(capacity)
                              : storage_at<LocalRing<T>> + LocalRing<T>::bytes_for(capacity);
            },
        .ring_align = std::max({alignof(Ring<T>), Ring<T>::alignment, alignof(LocalRing<T>), alignof(T)}),
        .link =
            [](void* output, void* input, std::byte* memory, std::size_t capacity, Overflow overflow,
               bool across) {
                auto& from = static_cast<BufferOutput<T>*>(output)->rings_;
                auto& to = static_cast<BufferInput<T>*>(input)->rings_;
                if (across) {
                    auto* ring = new (memory) Ring<T>(memory + storage_at<Ring<T>>, capacity, overflow);
                    static_cast<void>(from.across.push(ring));
                    static_cast<void>(to.across.push(ring));
                } else {
                    auto* ring =
                        new (memory) LocalRing<T>(memory + storage_at<LocalRing<T>>, capacity, overflow);
                    static_cast<void>(from.inside.push(ring));
                    static_cast<void>(to.inside.push(ring));
                }
            },
        .set_waker = [](void* output, Waker waker) { static_cast<BufferOutput<T>*>(output)->waker_ = waker; },
        .close = [](void* output, DroppedWrites* counter) noexcept
        TAPPET_REALTIME { static_cast<BufferOutput<T>*>(output)->dropped_ = counter; },
        .lost =
            [](const void* memory, bool across) {
                return static_cast<std::size_t>(across ? static_cast<const Ring<T>*>(memory)->lost()
                                                       : static_cast<const LocalRing<T>*>(memory)->lost());
            },
        .push =
            [](void* output, const std::byte* bytes) noexcept TAPPET_REALTIME {
                T value = default_value<T>();
                std::memcpy(static_cast<void*>(std::addressof(value)), bytes, sizeof value);
                return static_cast<BufferOutput<T>*>(output)->push(value);
            },
        .pop =
            [](void* input, std::byte* into) noexcept TAPPET_REALTIME {
                T value = default_value<T>();
                if (!static_cast<BufferInput<T>*>(input)->pop(value)) return false;
                std::memcpy(into, std::addressof(value), sizeof value);
                return true;
            },
        .empty = [](const void* input) noexcept
        TAPPET_REALTIME { return static_cast<const BufferInput<T>*>(input)->empty(); },
    };

    template <class... A>
    static constexpr void (*post)(void*, A...) noexcept TAPPET_REALTIME = &detail::post<A...>;

    template <class... A>
    static constexpr void (*count)(void*, A...) noexcept TAPPET_REALTIME = [](void* counter, A...) noexcept
        TAPPET_REALTIME {
            static_cast<std::atomic<std::uint64_t>*>(counter)->fetch_add(
                1, std::memory_order_relaxed); // no step: looked at again and again
        };

    template <class... A>
    static constexpr EventOperations event{
        .subscriber_bytes = sizeof(Subscriber<A...>),
        .give_storage =
            [](void* event, void* memory) {
                static_cast<Event<A...>*>(event)->subscribers_ = static_cast<Subscriber<A...>*>(memory);
            },
        .subscribe = [](void* event, const void* call, void* context) -> std::atomic<std::uint64_t>& {
            auto& target = *static_cast<Event<A...>*>(event);
            target.subscribers_[target.count_++] = {
                *static_cast<void (*const*)(void*, A...) noexcept TAPPET_REALTIME>(call), context};
            return target.connected_;
        },
        .post = &post<A...>,
        .count = &count<A...>,
        .emit = [](void* event, const std::byte* packed) noexcept
        TAPPET_REALTIME { detail::emit_packed<A...>(*static_cast<Event<A...>*>(event), packed); },
        .event_bytes = sizeof(Event<A...>),
        .construct = [](void* memory) { new (memory) Event<A...>; },
    };
};

} // namespace tappet
