// A CAN bus as a component: its ports and events come from a constexpr signal map.
#pragma once

#include "drivers/can/bus_traffic.hpp"
#include "drivers/can/demand.hpp"
#include "drivers/can/device.hpp"
#include "drivers/can/services.hpp"
#include "drivers/can/signal_store.hpp"
#include "drivers/can/transmit_queue.hpp"
#include "drivers/can/unsent_signals.hpp"
#include "kernel/base/array_of.hpp"
#include "kernel/component/cause.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/nth.hpp"
#include "kernel/component/output_gate.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace tappet::can {

/// Facets: an output or an input for each signal, an event for each received frame, and the state of the bus.
/// Runs in an activity that is on_device. All real-time.
///
/// A cyclic frame is sent at its period with the last values of its inputs. When a writer was interrupted
/// between two of them (their stamps differ although they agreed before), the previous values are sent once
/// more.
/// A frame on demand is sent once for each write that has its own time stamp. All its signals are written in
/// one cycle of one writer, so no command is sent with another's arguments; two values without a time never
/// count as one command. A row that wakes sends it at once. A demand made behind a force is sent after the
/// force, but not when the force ends with a stop.
/// A frame is not sent when an input was never written, is not a number, or is stale without a substitute;
/// the receiver's own time-out detects this. A received value that is not a number is counted, and its output
/// becomes stale. In a multiplexed frame, only the signals that its multiplexors select are written, read and
/// sent.
///
/// After a fault or a stop the bus starts fresh: earlier arrivals, queued frames and demands are discarded.
/// While faulted, it polls for its restart and rests in between.
///
/// With services, their received frames leave by the buffered output `services`. Frames from the buffered
/// input `to_send` are sent, all of them in order.
template <const auto& map, const auto& protocol = no_services>
struct Bus {
    static constexpr std::string_view device_fault = map.fault.view();
    static constexpr std::size_t signal_count = map.signals.size();
    static constexpr std::size_t frame_count = map.frames.size();
    static_assert(AllFrames<map, protocol>::transmit.size() <= TransmitQueue::capacity,
                  "what is sent at one time fits the queue");
    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr bool woken_by_device = true;
    static constexpr DevicePace device_pace = AllFrames<map, protocol>::pace;
    static constexpr Identifiers device_map = AllFrames<map, protocol>::value;
    static constexpr Sentence analyse_traffic(const DeviceUse& use, std::span<TrafficRow> into) {
        const ProvenRates proven{protocol.bit_rate, protocol.data_bit_rate};
        const BusFacts bus = bus_facts(use.facts);
        if (const Sentence fault = bit_rate_fault(proven, bus); !fault.empty()) return fault;
        return bus_traffic(AllFrames<map, protocol>::traffic, bus, use.response, into);
    }
    static Duration longest_seen(const void* bus, std::string_view frame) {
        return static_cast<const Bus*>(bus)->longest_response(frame);
    }
    static Unsent unsent(const void* bus, std::size_t facet) noexcept {
        return facet < signal_count ? static_cast<const Bus*>(bus)->unsent_.of(facet) : Unsent{};
    }
    static void gate_output(void* bus, std::size_t signal, OutputGate& gate) noexcept {
        static_cast<Bus*>(bus)->gates_.add(signal, gate);
    }
    static constexpr DeviceTraffic device_traffic{AllFrames<map, protocol>::traffic.size(), &analyse_traffic,
                                                  &longest_seen};
    /// Most frames taken in one cycle; more are left to the next cycle, which follows at once.
    static constexpr int max_frames_per_cycle = 64;
    static constexpr Duration look_while_faulted = 20ms; ///< period of polling for a restart
    static constexpr Duration retry_after = 1ms;         ///< when the kernel had no room for a frame
    static constexpr Duration shortest_wait = 100us;     ///< lower limit of a request: the cycle cannot spin

    // One port of each sort for each signal; those that do not fit its direction and type stay unused.
    std::array<Output<double>, signal_count> physical_out{};
    std::array<Output<std::int64_t>, signal_count> integer_out{};
    std::array<Input<double>, signal_count> physical_in{};
    std::array<Input<std::int64_t>, signal_count> integer_in{};
    std::array<Event<>, frame_count> frame_received{};
    Output<bool> is_faulted{};
    Output<std::int64_t> bus_state{};
    Output<std::int64_t> frames_lost{};
    Output<std::int64_t> frames_received{};
    Output<std::int64_t> wrong_lengths{};
    Output<std::int64_t> sent_too_often{};
    Output<std::int64_t> no_numbers{};
    Output<std::int64_t> out_of_range{};
    Event<> bus_fault{};
    Event<> bus_recovered{};
    [[no_unique_address]] ServicePort<protocol.any, BufferOutput<Frame>> services{};
    [[no_unique_address]] ServicePort<protocol.any, BufferInput<Frame>> to_send{};
    Timer next_send{};
    Timer next_service{};

    Sentence configure(Setup& setup) {
        device_ = setup.device<Device>();
        waiter_ = setup.waiter;
        return device_ == nullptr ? setup.no_device() : setup.woken_by(*device_);
    }

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        for (std::size_t f = 0; f < frame_count; ++f)
            // All frames share one time grid; the proof of their response times relies on it.
            due_[f] = is_cyclic(f) ? cycle.now + map.frames[f].every : never;
        may_repeat_ = {};
        was_faulted_ = false;
        if (was_stopped_) forget_stopped_time();
        if (was_stopped_ && !faulted(device_->state())) bus_recovered.emit();
        lost_ = taken_ = 0;
        too_often_ = 0;
        status_ = status_now();
        write_state();
        arm(cycle.now);
        waiter_->wake(); // for frames that arrived before
    }

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        // Demands made in the meantime are sent before arrivals are read.
        if (send_on_demand(cycle.now)) device_->service(cycle.now);
        take_frames();
        send_services();
        static_cast<void>(send_on_demand(cycle.now));
        finish(cycle.now);
    }

    /// Sends what is still to be sent, then the safe frames of the map. The guardian would send the same
    /// ones. They do not depend on values left by a writer's stop().
    void stop(const Cycle& cycle) noexcept TAPPET_REALTIME {
        for (std::size_t f = 0; f < frame_count; ++f)
            if (is_cyclic(f) && map.frames[f].silence_is_safe) send(f, cycle.now);
        send_services();
        static_cast<void>(send_on_demand(cycle.now));
        static_cast<void>(device_->finish(cycle.now));
        stopped_safely_ = true;
        for (Frame frame : device_map.safe) {
            frame.stamp = cycle.now;
            Send answer = device_->send(frame, Keep::last);
            if (answer == Send::refused_full && device_->finish(cycle.now))
                answer = device_->send(frame, Keep::last);
            stopped_safely_ = stopped_safely_ && answer == Send::queued;
        }
        stopped_safely_ = (device_->finish(cycle.now) && stopped_safely_) || device_map.safe.empty();
        // A bus without service cannot be relied on, even if it is healthy.
        bus_state.write(static_cast<std::int64_t>(State::down));
        if (!was_faulted_) bus_fault.emit();
        was_stopped_ = true;
        gates_.stop(cycle.now);
    }

    [[nodiscard]] bool stopped_safely() const noexcept TAPPET_REALTIME { return stopped_safely_; }
    /// Drops what is queued for sending.
    void purge() noexcept TAPPET_REALTIME { device_->purge(); }
    void send_cyclic(const Cycle& cycle) noexcept TAPPET_REALTIME {
        for (std::size_t f = 0; f < frame_count; ++f) {
            if (due_[f] > cycle.now) continue;
            send(f, cycle.now);
            next_period(f, cycle.now);
        }
        finish(cycle.now);
    }
    void serve_device(const Cycle& cycle) noexcept TAPPET_REALTIME {
        take_frames(); // before a confirmation counts as missing
        finish(cycle.now);
    }

    [[nodiscard]] const DecodeCounters& decoding() const noexcept { return store_.count; }
    [[nodiscard]] Counters counters() const noexcept { return device_->counters(); }
    /// Returns the longest time of a sent frame from the making of its contents to its confirmation.
    [[nodiscard]] Duration longest_response(std::string_view frame) const noexcept {
        for (const FrameRow& row : AllFrames<map, protocol>::traffic)
            if (row.name == frame) return device_->longest_response(row.identifier);
        return Duration::zero();
    }

    static constexpr auto interface() {
        std::array<Facet, signal_count + frame_count + fixed_facets + (protocol.any ? 2 : 0)> list{};
        std::size_t n = 0;
        for (std::size_t s = 0; s < signal_count; ++s) list[n++] = signal_facet(s);
        for (std::size_t f = 0; f < frame_count; ++f)
            list[n++] = nth_event<&Bus::frame_received>(f, received_names[f].view(), "a frame arrived");
        for (const Facet& facet : {
                 output<&Bus::is_faulted>("faulted", "", "nothing is sent; written on change",
                                          while_stopped(true)),
                 output<&Bus::bus_state>("state", "",
                                         "0 active, 1 warning, 2 passive, 3 unacknowledged, 4 bus-off, 5 "
                                         "down or stopped; written on change"),
                 output<&Bus::frames_lost>("frames_lost", "",
                                           "arrived but never read, since its start; written on change"),
                 output<&Bus::frames_received>("frames_received", "", "since its start; written on change"),
                 output<&Bus::wrong_lengths>(
                     "wrong_lengths", "",
                     "frames of another length or format than the map's; written on change"),
                 output<&Bus::sent_too_often>(
                     "sent_too_often", "",
                     "frames on demand that followed sooner than the map says; written on change"),
                 output<&Bus::no_numbers>("no_numbers", "",
                                          "received signals that are not a number, since start"),
                 output<&Bus::out_of_range>("out_of_range", "",
                                            "values outside their signal's range, since the machine's start: "
                                            "sent as its nearest bound; held back when not a number"),
                 tappet::event<&Bus::bus_fault>("bus_fault", "the bus can no longer be relied on"),
                 tappet::event<&Bus::bus_recovered>("bus_recovered",
                                                    "the bus works again, with empty queues"),
                 operation<&Bus::purge>("purge", "drops the queued frames"),
                 timer<&Bus::next_send, &Bus::send_cyclic>("next_send", "the next cyclic frame"),
                 timer<&Bus::next_service, &Bus::serve_device>("next_service",
                                                               "the next time-out of a frame"),
             })
            list[n++] = facet;
        if constexpr (protocol.any) {
            list[n++] = output<&Bus::services>("services", "", "frames of the protocol's own, received");
            list[n] = input<&Bus::to_send>("to_send", "", "frames of the protocol's own, to be sent");
            list[n++].required = protocol.sends_by_bus();
        }
        return list;
    }

private:
    static constexpr std::size_t fixed_facets = 13;
    static constexpr auto received_names =
        array_of<frame_count>([](std::size_t f) { return FacetName{map.frames[f].name, ".received"}; });
    // At the start: the kernel's buffer holds fewer frames.
    static constexpr int max_passes = 4096;

    static constexpr bool is_cyclic(std::size_t f) noexcept {
        return map.frames[f].direction == Direction::transmit && map.frames[f].every > Duration::zero();
    }
    static constexpr bool is_on_demand(std::size_t f) noexcept {
        return map.frames[f].direction == Direction::transmit && map.frames[f].every == Duration::zero();
    }

    static constexpr Facet signal_facet(std::size_t s) {
        const Signal& signal = map.signals[s];
        const auto& frame = map.frames[map.row_of[s]];
        const std::string_view name = ValueNames<map>::all[s].view();
        const auto comes = comes_every(frame.every);
        if (frame.direction == Direction::receive)
            return is_integer(signal)
                       ? nth_output<&Bus::integer_out>(s, name, signal.unit, "received", comes, stamps_cause)
                       : nth_output<&Bus::physical_out>(s, name, signal.unit, "received", comes,
                                                        stamps_cause);
        Facet sent = is_integer(signal) ? nth_input<&Bus::integer_in>(s, name, signal.unit, "sent", comes)
                                        : nth_input<&Bus::physical_in>(s, name, signal.unit, "sent", comes);
        sent.needs_wake =
            frame.every == Duration::zero(); // a cyclic frame takes what is there when it is due
        if (is_cyclic(map.row_of[s]) && signal.says_safe)
            tappet::detail::apply(sent, drives_output(s, signal.safe_value));
        return sent;
    }

    /// Uses absolute times: a late cycle does not shift later ones, and whole missed periods are skipped.
    void next_period(std::size_t f, Time now) noexcept TAPPET_REALTIME {
        const Duration every = map.frames[f].every;
        due_[f] += ((now - due_[f]) / every + 1) * every;
    }

    void take_frames() noexcept TAPPET_REALTIME {
        Frame frame;
        for (int n = 0; n < max_frames_per_cycle; ++n) {
            const Receive got = device_->receive(frame);
            lost_ += got.lost;
            if (got.what == Received::frame) take(frame);
            if (got.what == Received::none && got.lost == 0) return;
        }
        waiter_->wake();
    }

    void take(const Frame& frame) noexcept TAPPET_REALTIME {
        std::size_t f = no_such;
        if (const Decoded decoded = store_.decode(frame, f); decoded != Decoded::yes) {
            if (decoded == Decoded::wrong_length)
                wrong_lengths.write(static_cast<std::int64_t>(store_.count.wrong_lengths));
            if constexpr (protocol.any)
                if (protocol.takes(frame)) ++(services.push(frame) ? taken_ : lost_);
            return;
        }
        ++taken_;
        const FrameRow& row = map.frames[f];
        const CausedBy arrival{frame.stamp};
        for (std::size_t s = row.first; s < row.end(); ++s) {
            if (!store_.is_in(row, s, frame)) continue;
            if (is_integer(map.signals[s]))
                integer_out[s].write(store_.integer(s), frame.stamp);
            else if (const double value = store_.physical(s); is_number(value))
                physical_out[s].write(value, frame.stamp);
            else
                unsent_.received_no_number(s), no_numbers.write(no_numbers.last() + 1);
        }
        frame_received[f].emit();
    }

    /// Values of the outputs that report the bus state.
    struct Status {
        State state = State::active;
        std::uint64_t lost = 0;
        std::uint64_t taken = 0;
    };
    [[nodiscard]] Status status_now() const noexcept TAPPET_REALTIME {
        return {device_->state(), lost_, taken_};
    }

    void write_state() noexcept TAPPET_REALTIME {
        is_faulted.write(faulted(status_.state));
        bus_state.write(static_cast<std::int64_t>(status_.state));
        frames_lost.write(static_cast<std::int64_t>(status_.lost));
        frames_received.write(static_cast<std::int64_t>(status_.taken));
        wrong_lengths.write(static_cast<std::int64_t>(store_.count.wrong_lengths));
        sent_too_often.write(too_often_);
        no_numbers.write(0);
        out_of_range.write(unsent_.all());
    }

    void tell_state(Time now) noexcept TAPPET_REALTIME {
        const Status before = status_;
        status_ = status_now();
        if (status_.lost != before.lost) frames_lost.write(static_cast<std::int64_t>(status_.lost));
        if (status_.taken != before.taken) frames_received.write(static_cast<std::int64_t>(status_.taken));
        if (unsent_.all() != out_of_range.last()) out_of_range.write(unsent_.all());
        if (status_.state != before.state) bus_state.write(static_cast<std::int64_t>(status_.state));
        const bool bad = faulted(status_.state);
        if (bad == was_faulted_) return;
        was_faulted_ = bad;
        is_faulted.write(bad);
        if (bad) return bus_fault.emit();
        forget_demands();
        for (std::size_t f = 0; f < frame_count; ++f)
            if (due_[f] <= now) next_period(f, now);
        bus_recovered.emit();
    }

    /// Returns whether the multiplexors read before this signal select it.
    [[nodiscard]] bool is_selected(const FrameRow& row, std::size_t s) const noexcept TAPPET_REALTIME {
        return map.holds(row, s, [this](std::size_t m) noexcept TAPPET_REALTIME {
            return to_raw_integer(map.signals[m], integers_[m]).bits;
        });
    }

    Reading read_inputs(std::size_t f, Time now) noexcept TAPPET_REALTIME {
        Reading found;
        const auto take = [&](std::size_t s, auto& input, auto& value) noexcept TAPPET_REALTIME {
            const Flow flow = input.read(value);
            bool is_now = input.forced() || (flow == Flow::stale && input.has_substitute());
            found.usable &= flow == Flow::fresh || flow == Flow::old || is_now;
            const Signal& row = map.signals[s];
            const auto safe = static_cast<std::remove_reference_t<decltype(value)>>(row.safe_value);
            if (input.is_abandoned()) {
                found.usable &= is_now = row.says_safe && !is_on_demand(f); // else silence is safe
                value = safe;
            }
            if (gates_.hold(s, value == safe, now)) value = safe, found.held = true;
            found.forced |= input.forced();
            if (is_on_demand(f)) found.writes += input.writes();
            found.fresh |= flow == Flow::fresh;
            if (is_now) return;
            // Two values without a time cannot be known to be from one cycle.
            const Time at = input.claimed_stamp();
            found.agreed &= found.at == never || (at == found.at && at != before_all);
            found.at = at;
        };
        for (std::size_t s = map.frames[f].first; s < map.frames[f].end(); ++s)
            if (is_selected(map.frames[f], s))
                is_integer(map.signals[s]) ? take(s, integer_in[s], integers_[s])
                                           : take(s, physical_in[s], physical_[s]);
        return found;
    }

    /// Stores the values read; returns false when one is not a number, and counts it.
    bool keep_inputs(std::size_t f) noexcept TAPPET_REALTIME {
        const FrameRow& row = map.frames[f];
        bool are_numbers = true;
        for (std::size_t s = row.first; s < row.end(); ++s) {
            if (!is_selected(row, s)) continue;
            const Raw raw = is_integer(map.signals[s]) ? store_.set_integer(s, integers_[s])
                                                       : store_.set_physical(s, physical_[s]);
            unsent_.stored(s, raw);
            are_numbers &= !raw.refused;
        }
        return are_numbers;
    }
    /// Sends the stored values, and counts those that were clamped for it.
    void send_stored(std::size_t f, Time now, Keep keep) noexcept TAPPET_REALTIME {
        const Send answer = device_->send(store_.encode(f, now), keep);
        if (answer != Send::queued && answer != Send::replaced) return;
        const FrameRow& row = map.frames[f];
        for (std::size_t s = row.first; s < row.end(); ++s)
            if (store_.is_encoded(row, s)) unsent_.sent(s);
    }

    void send(std::size_t f, Time now) noexcept TAPPET_REALTIME {
        const Reading found = read_inputs(f, now);
        const bool repeats = found.usable && !found.agreed && may_repeat_[f] && !found.held;
        may_repeat_[f] = found.usable && found.agreed;
        if (!found.usable) return;
        if (repeats || keep_inputs(f))
            send_stored(f, now, Keep::latest);
        else
            may_repeat_[f] = false;
    }

    /// Sends the demanded frames; returns false when there were none.
    bool send_on_demand(Time now) noexcept TAPPET_REALTIME {
        bool sent = false;
        for (std::size_t f = 0; f < frame_count; ++f) {
            if (!is_on_demand(f)) continue;
            Demand& demand = demands_[f];
            const Reading found = read_inputs(f, now);
            demand.is_open |= found.fresh;
            const bool was_hidden = std::exchange(demand.is_hidden, found.forced) && !found.forced;
            const bool is_forgotten = was_hidden && found.writes == demand.forgotten;
            if (!demand.is_open || !found.usable || !found.agreed) continue;
            demand.is_open = false;
            const Frame before = store_.encode(f, now);
            const bool is_new =
                found.at == never || (found.at != demand.at && found.writes != demand.handled);
            if (!keep_inputs(f)) continue;
            if (found.at != never) demand.at = found.at;
            demand.handled = found.writes;
            // The end of a force shows the value from before the force.
            if (is_forgotten || (!is_new && store_.encode(f, now).data == before.data)) continue;
            if (now < demand.may_follow) sent_too_often.write(++too_often_);
            demand.may_follow = now + map.frames[f].apart;
            send_stored(f, now, Keep::every);
            sent = true;
        }
        return sent;
    }
    void send_services() noexcept TAPPET_REALTIME {
        if constexpr (protocol.any) {
            Frame frame;
            for (int n = 0; n < max_frames_per_cycle && to_send.pop(frame); ++n)
                static_cast<void>(device_->send(frame, Keep::every));
        }
    }
    /// Discards what was queued, arrived or demanded while the bus had no service.
    void forget_stopped_time() noexcept TAPPET_REALTIME {
        device_->purge();
        device_->drop_arrivals();
        forget_demands();
    }
    void forget_demands() noexcept TAPPET_REALTIME {
        if constexpr (protocol.any) {
            Frame forgotten;
            for (int n = 0; n < max_passes && to_send.pop(forgotten);) ++n;
        }
        for (std::size_t f = 0; f < frame_count; ++f) {
            if (!is_on_demand(f)) continue;
            const Reading found = read_inputs(f, {}); // on demand: it has no gate
            Demand& demand = demands_[f];
            demand.is_hidden = found.forced;
            demand.forgotten = found.writes;
            if (found.usable && keep_inputs(f) && found.at != never) demand.at = found.at;
            demand.is_open = false;
        }
    }

    void finish(Time now) noexcept TAPPET_REALTIME {
        device_->service(now);
        tell_state(now);
        arm(now);
    }
    void arm(Time now) noexcept TAPPET_REALTIME {
        if (faulted(status_.state)) {
            next_send.cancel();
            // Polling keeps its time when something else wakes the activity in between.
            if (next_service.when() <= now || next_service.when() > now + look_while_faulted)
                next_service.arm(now + look_while_faulted);
            return;
        }
        Time next = never;
        for (const Time due : due_) next = due < next ? due : next;
        next_send.arm(next);
        Time service = std::max(device_->next_service(), now + shortest_wait);
        // A frame that found no room gets no confirmation, so only a retry by time sends it.
        const std::uint64_t before = std::exchange(pressed_, device_->counters().back_pressure);
        if (pressed_ != before) service = std::min(service, now + retry_after);
        next_service.arm(service);
    }

    SignalStore<frame_count, signal_count> store_{map};
    std::array<std::int64_t, signal_count> integers_{};
    std::array<double, signal_count> physical_{};
    UnsentSignals<signal_count> unsent_{};
    std::array<Time, frame_count> due_{};
    std::array<Demand, frame_count> demands_{};
    OutputGates<signal_count> gates_{};
    std::array<bool, frame_count> may_repeat_{}; // the values sent last had one time stamp
    Device* device_ = nullptr;
    os::Waiter* waiter_ = nullptr;
    std::uint64_t lost_ = 0, taken_ = 0, pressed_ = 0;
    std::int64_t too_often_ = 0;
    Status status_{};
    bool was_faulted_ = false, was_stopped_ = false, stopped_safely_ = true;
};

} // namespace tappet::can
