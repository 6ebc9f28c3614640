// A CAN bus as a component: its ports and events come from a constexpr signal map.
#pragma once

#include "drivers/can/device.hpp"
#include "drivers/can/signal_map.hpp"
#include "drivers/can/signal_store.hpp"
#include "kernel/component/component.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tappet::can {

/// A signal is a whole number unless a factor, an offset or a float makes it a physical value.
constexpr bool is_whole(const Signal& s) noexcept {
    return s.factor == 1 && s.offset == 0 &&
           (s.kind == Kind::unsigned_integer || s.kind == Kind::signed_integer);
}

/// The names of a map's facets, "frame.signal" and "frame.received", as text that lives as long as the
/// program.
template <const auto& map> struct FacetNames {
    static constexpr std::size_t longest = 63;
    struct Name {
        std::array<char, longest + 1> letters{};
        std::size_t length = 0;
        constexpr void add(std::string_view piece) {
            for (const char letter : piece)
                letters[length++] = letter; // longer than `longest` does not compile
        }
        [[nodiscard]] constexpr std::string_view view() const noexcept { return {letters.data(), length}; }
    };
    static constexpr auto signals = [] {
        std::array<Name, map.signals.size()> names{};
        for (std::size_t s = 0; s < names.size(); ++s) {
            names[s].add(map.frames[map.frame_of[s]].name);
            names[s].add(".");
            names[s].add(map.signals[s].name);
        }
        return names;
    }();
    static constexpr auto received = [] {
        std::array<Name, map.frames.size()> names{};
        for (std::size_t f = 0; f < names.size(); ++f) {
            names[f].add(map.frames[f].name);
            names[f].add(".received");
        }
        return names;
    }();
};

/// Facets: an output or an input for each signal, an event for each received frame, and the state of the bus.
/// Runs in an activity that is on_device. A frame goes out at its period or, on demand, when one of its
/// signals is written; one of whose signals was never written, or is stale, does not go out: nothing stale
/// leaves, and the receiver's own time-out notices. All real-time.
template <const auto& map> struct Bus {
    static_assert(map.fault.empty(), "the signal map is refused: its member `fault` says why");
    static constexpr std::size_t signal_count = map.signals.size();
    static constexpr std::size_t frame_count = map.frames.size();
    static constexpr std::string_view device_kind = "can";
    /// Frames taken in one cycle; more wait for the next one, which follows at once.
    static constexpr int max_frames_per_cycle = 64;

    // One port of each sort for each signal: those that the signal's direction and type do not ask for stay
    // unused.
    std::array<Output<double>, signal_count> physical_out{};
    std::array<Output<std::int64_t>, signal_count> whole_out{};
    std::array<Input<double>, signal_count> physical_in{};
    std::array<Input<std::int64_t>, signal_count> whole_in{};
    std::array<Event<>, frame_count> frame_received{};
    Output<bool> is_faulted{};
    Output<std::int64_t> bus_state{};
    Output<std::int64_t> frames_lost{};
    Output<std::int64_t> frames_received{};
    Event<> bus_fault{};
    Event<> bus_recovered{};
    Timer next_send{};
    Timer next_service{};

    Sentence configure(Setup& setup) {
        device_ = setup.device<Device>();
        waiter_ = setup.waiter;
        if (device_ == nullptr) return setup.no_device();
        if (const int handle = device_->wait_handle(); handle < 0)
            device_->set_listener(&os::Waiter::wake_thunk, waiter_);
        else if (!waiter_->watch(handle))
            return Sentence{"component \"", setup.component,
                            "\": its activity watches too many devices; give it fewer drivers"};
        return {};
    }

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        for (std::size_t f = 0; f < frame_count; ++f)
            due_[f] = is_cyclic(f) ? cycle.now + map.frames[f].every : never;
        tell_state();
        arm();
    }

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        take_frames();
        send_on_demand(cycle.now);
        finish(cycle.now);
    }

    /// The last values of every frame once more: the machine has written safe ones by now.
    void stop(const Cycle& cycle) noexcept TAPPET_REALTIME {
        for (std::size_t f = 0; f < frame_count; ++f)
            if (map.frames[f].direction == Direction::transmit) send(f, cycle.now);
        device_->service(cycle.now);
    }

    /// Drops what waits to be sent.
    void purge() noexcept TAPPET_REALTIME { device_->purge(); }

    void send_cyclic(const Cycle& cycle) noexcept TAPPET_REALTIME {
        for (std::size_t f = 0; f < frame_count; ++f) {
            if (due_[f] > cycle.now) continue;
            send(f, cycle.now);
            // Absolute times: a late cycle does not move the ones behind it. Whole periods that were missed
            // are left out.
            const Duration behind = cycle.now - due_[f];
            due_[f] += (behind / map.frames[f].every + 1) * map.frames[f].every;
        }
        finish(cycle.now);
    }
    void serve_device(const Cycle& cycle) noexcept TAPPET_REALTIME { finish(cycle.now); }

    [[nodiscard]] const DecodeCounters& decoding() const noexcept { return store_.count; }
    [[nodiscard]] Counters counters() const noexcept { return device_->counters(); }

    static constexpr auto interface() {
        std::array<Facet, signal_count + frame_count + fixed_facets> list{};
        std::size_t n = 0;
        for (std::size_t s = 0; s < signal_count; ++s) list[n++] = signal_facet(s);
        for (std::size_t f = 0; f < frame_count; ++f) {
            Facet facet =
                tappet::event<&Bus::bus_fault>(FacetNames<map>::received[f].view(), "a frame arrived");
            facet.at = [](void* c, std::size_t i) noexcept -> void* {
                return &static_cast<Bus*>(c)->frame_received[i];
            };
            facet.index = f;
            list[n++] = facet;
        }
        for (const Facet& facet : {
                 output<&Bus::is_faulted>("faulted", "", "nothing is sent or received"),
                 output<&Bus::bus_state>(
                     "state", "", "0 active, 1 warning, 2 passive, 3 unacknowledged, 4 bus-off, 5 down"),
                 output<&Bus::frames_lost>("frames_lost", "", "arrived but never read, since start"),
                 output<&Bus::frames_received>("frames_received", "", "since start"),
                 tappet::event<&Bus::bus_fault>("bus_fault", "the bus can no longer be relied on"),
                 tappet::event<&Bus::bus_recovered>("bus_recovered",
                                                    "the bus works again, with empty queues"),
                 operation<&Bus::purge>("purge", "drops what waits to be sent"),
                 timer<&Bus::next_send, &Bus::send_cyclic>("next_send", "the next cyclic frame"),
                 timer<&Bus::next_service, &Bus::serve_device>("next_service",
                                                               "the next time-out of a frame"),
             })
            list[n++] = facet;
        return list;
    }

private:
    static constexpr std::size_t fixed_facets = 9;

    static constexpr bool is_cyclic(std::size_t f) noexcept {
        return map.frames[f].direction == Direction::transmit && map.frames[f].every > Duration::zero();
    }

    static constexpr Facet signal_facet(std::size_t s) {
        const Signal& signal = map.signals[s];
        const bool sent = map.frames[map.frame_of[s]].direction == Direction::transmit;
        Facet facet{.name = FacetNames<map>::signals[s].view(),
                    .unit = signal.unit,
                    .doc = sent ? "sent" : "received",
                    .kind = sent ? FacetKind::input : FacetKind::output,
                    .required = sent,
                    .index = s};
        if (is_whole(signal)) {
            facet.type = type_id<std::int64_t>;
            facet.port = &PortAccess::data<std::int64_t>;
            if (sent)
                facet.at = [](void* c, std::size_t i) noexcept -> void* {
                    return &static_cast<Bus*>(c)->whole_in[i];
                };
            else
                facet.at = [](void* c, std::size_t i) noexcept -> void* {
                    return &static_cast<Bus*>(c)->whole_out[i];
                };
        } else {
            facet.type = type_id<double>;
            facet.port = &PortAccess::data<double>;
            if (sent)
                facet.at = [](void* c, std::size_t i) noexcept -> void* {
                    return &static_cast<Bus*>(c)->physical_in[i];
                };
            else
                facet.at = [](void* c, std::size_t i) noexcept -> void* {
                    return &static_cast<Bus*>(c)->physical_out[i];
                };
        }
        return facet;
    }

    void take_frames() noexcept TAPPET_REALTIME {
        Frame frame;
        for (int n = 0; n < max_frames_per_cycle; ++n) {
            const Receive got = device_->receive(frame);
            lost_ += got.lost;
            if (got.what == Received::none) {
                tell_state();
                return;
            }
            if (got.what == Received::frame) take(frame);
        }
        tell_state();
        waiter_->wake();
    }

    void take(const Frame& frame) noexcept TAPPET_REALTIME {
        std::size_t f = no_such;
        if (store_.decode(frame, f) != Decoded::yes) return;
        ++taken_;
        const FrameRow& row = map.frames[f];
        for (std::size_t s = row.first; s < row.first + row.signals; ++s) {
            if (is_whole(map.signals[s]))
                whole_out[s].write(store_.integer(s), frame.stamp);
            else
                physical_out[s].write(store_.physical(s), frame.stamp);
        }
        frame_received[f].emit();
    }

    void tell_state() noexcept TAPPET_REALTIME {
        const State state = device_->state();
        const bool bad = faulted(state);
        if (bad != was_faulted_) {
            was_faulted_ = bad;
            if (bad)
                bus_fault.emit();
            else
                bus_recovered.emit();
        }
        is_faulted.write(bad);
        bus_state.write(static_cast<std::int64_t>(state));
        frames_lost.write(static_cast<std::int64_t>(lost_));
        frames_received.write(static_cast<std::int64_t>(taken_));
    }

    /// Takes the signals of a frame from its inputs. False when one of them must not be sent.
    bool gather(std::size_t f, bool& fresh) noexcept TAPPET_REALTIME {
        const FrameRow& row = map.frames[f];
        for (std::size_t s = row.first; s < row.first + row.signals; ++s) {
            Flow flow = Flow::never_written;
            if (is_whole(map.signals[s])) {
                std::int64_t value = 0;
                flow = whole_in[s].read(value);
                store_.set_bits(s, static_cast<std::uint64_t>(value));
            } else {
                double value = 0;
                flow = physical_in[s].read(value);
                store_.set_physical(s, value);
            }
            if (flow == Flow::never_written || flow == Flow::stale) return false;
            fresh |= flow == Flow::fresh;
        }
        return true;
    }

    void send(std::size_t f, Time now) noexcept TAPPET_REALTIME {
        bool fresh = false;
        if (gather(f, fresh))
            static_cast<void>(
                device_->send(store_.encode(f, now), is_cyclic(f) ? Keep::latest : Keep::every));
    }

    void send_on_demand(Time now) noexcept TAPPET_REALTIME {
        for (std::size_t f = 0; f < frame_count; ++f) {
            if (map.frames[f].direction != Direction::transmit || is_cyclic(f)) continue;
            bool fresh = false;
            if (gather(f, fresh) && fresh)
                static_cast<void>(device_->send(store_.encode(f, now), Keep::every));
        }
    }

    void finish(Time now) noexcept TAPPET_REALTIME {
        device_->service(now);
        tell_state();
        arm();
    }
    void arm() noexcept TAPPET_REALTIME {
        Time next = never;
        for (const Time due : due_) next = due < next ? due : next;
        next_send.arm(next);
        next_service.arm(device_->next_service());
    }

    SignalStore<frame_count, signal_count> store_{map};
    std::array<Time, frame_count> due_{};
    Device* device_ = nullptr;
    os::Waiter* waiter_ = nullptr;
    std::uint64_t lost_ = 0;
    std::uint64_t taken_ = 0;
    bool was_faulted_ = false;
};

} // namespace tappet::can
