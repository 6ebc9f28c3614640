// A node's end of the wire: stand-ins for other nodes' facets that its machine writes to or reads from. They
// have the types of both ends and behave like a row inside the machine, which knows nothing else.
#pragma once

#include "drivers/can/device.hpp"
#include "drivers/system/link_facets.hpp"
#include "drivers/system/link_state.hpp"
#include "drivers/system/link_values.hpp"
#include "drivers/system/wire_protocol.hpp"
#include "kernel/base/bounded_text.hpp"
#include "kernel/component/component.hpp"
#include "kernel/system/protection.hpp"

namespace tappet::systems {

/// All real-time, in the activity of its bus, and after it. A node is present once its rows are known, and
/// gone when no beat came for silent_after or when it announces its stop. A row works once each end has heard
/// from the other that the row has the same layout there, in the other's present start. A row of the same
/// name with another layout, in another version, is refused by name; the others work.
template <const auto& system, std::size_t n>
struct Link {
    using Rows = NodeRows<system, n>;
    static constexpr std::size_t this_node = n;
    static constexpr auto& plan = Rows::plan;
    static constexpr const WireRow& wire = system.wire;
    static constexpr std::size_t node_count = system.nodes.size();
    static constexpr std::size_t row_count = Rows::row_count;
    static constexpr std::size_t frame_count = Rows::plan.frames.size();
    static constexpr WireShape shape = plan.shape;
    static constexpr int max_frames_per_cycle = 64;
    using CommandCallSlot = PackedCommandCall<Rows::command_bytes>;

    Link() {
        for (std::size_t i = 0; i < Rows::port_count; ++i)
            Rows::ports[i].facet->port->construct(storage_.data() + Rows::ports[i].at,
                                                  Rows::ports[i].is_input);
        for (std::size_t i = 0; i < row_count; ++i)
            if (Rows::rows[i].event_at != nowhere)
                Rows::facet_from(i).event->construct(storage_.data() + Rows::rows[i].event_at);
    }
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;

    static constexpr const DeviceKind& device_kind = can::device_kind;
    static constexpr bool shares_device = true;

    BufferInput<can::Frame> received{};
    std::array<Output<bool>, node_count> is_there{};
    std::array<PackedEventWait, row_count> emitted{};
    std::array<Event<>, row_count> lost{};
    std::array<CommandCallSlot, row_count> calls{};
    Input<Duration> ahead{};
    Input<bool> knows_time{};
    Input<std::int64_t> exchanges{};
    Output<Text<160>> refused{};
    Output<std::int64_t> events_lost{};
    Output<std::int64_t> frames_refused{};
    Output<std::int64_t> beyond{};
    Output<std::int64_t> not_sent{};
    Output<std::int64_t> held_back{};
    Timer next{};

    Sentence configure(Setup& setup) {
        device_ = setup.device<can::Device>();
        waiter_ = setup.waiter;
        return device_ == nullptr ? setup.no_device() : Sentence{};
    }
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        can::Frame forgotten;
        for (int k = 0; k < max_frames_per_cycle && received.pop(forgotten);) ++k;
        // In nanoseconds, because two starts of a box can be equal in milliseconds.
        epoch_ = static_cast<std::uint16_t>(
            static_cast<std::uint64_t>(to_ns(cycle.now)) * 0x9E37'79B9'7F4A'7C15u >> 48);
        peers_ = {};
        state_ = {};
        for (std::size_t i = 0; i < row_count; ++i) {
            const Crossing& row = Rows::crossing(i);
            state_[i].sender.configure(row.within - system.wire.service.deadline, row.within / 2,
                                       Rows::sent_by[i]);
        }
        for (std::size_t f = 0; f < due_.size(); ++f) due_[f] = Rows::is_periodic(f) ? cycle.now : never;
        for (ProtectionCheck& each : checks_) each.reset();
        told_row_ = 0;
        for (std::size_t node = 0; node < node_count; ++node)
            if (node != n) is_there[node].write(false);
        refused.write({});
        serve(cycle.now);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        can::Frame frame;
        for (int k = 0; k < max_frames_per_cycle && received.pop(frame); ++k) take(frame, cycle.now);
        serve(cycle.now);
    }
    void fire(const Cycle& cycle) noexcept TAPPET_REALTIME { serve(cycle.now); }
    /// Announces the stop: the others need not wait for silence, and this end stops listening to them.
    void stop(const Cycle& cycle) noexcept TAPPET_REALTIME {
        for (std::size_t node = 0; node < node_count; ++node)
            if (peers_[node].there) lose(node);
        Room payload{};
        put_beat(shape, payload, {.runs = false, .epoch = epoch_});
        send(Rows::beat_frame, payload, cycle.now);
        device_->service(cycle.now); // the bus continues, and handles arrivals itself
    }

    /// For tests and summaries.
    [[nodiscard]] const SendCounts& sent(std::size_t crossing) const noexcept {
        return state_[Rows::row_of(crossing)].sender.count;
    }
    [[nodiscard]] const ReceiveCounts& served(std::size_t crossing) const noexcept {
        return state_[Rows::row_of(crossing)].receiver.count;
    }
    [[nodiscard]] bool works(std::size_t crossing) const noexcept {
        return state_[Rows::row_of(crossing)].agreed;
    }

    static constexpr auto interface() { return LinkFacets<Link>::list(); }

private:
    friend struct LinkFacets<Link>;
    friend struct LinkValues<Link>;

    using Peer = LinkPeer;
    using Call = LinkCall;
    using RowState = LinkRow<Rows::command_bytes>;
    /// The contents of a frame.
    using Room = std::array<std::uint8_t, shape.most_bits / 8>;
    static constexpr std::size_t contents = shape.channel_bits() / 8; ///< bytes of a channel's frame

    // ---- received frames

    void take(const can::Frame& frame, Time now) noexcept TAPPET_REALTIME {
        if (frame.remote || frame.extended != system.wire.fixed_identifiers) return;
        const std::size_t f = Rows::frame_of(frame.id);
        if (f == plan.frames.size()) return;
        const WireFrame& what = plan.frames[f];
        // Another sender of this node's frames is counted by the bus. The clock belongs to another component.
        if (what.node == n || what.is_of_clock()) return;
        // Another version may have fewer values, or more.
        const bool is_whole = what.kind == WireFrameKind::data || frame.length >= what.bytes;
        if (can::format_of(frame) != format_of(system.wire, what) || !is_whole || !is_good(f, frame)) {
            frames_refused.write(++refused_frames_);
            return;
        }
        if (what.kind == WireFrameKind::beat) {
            take_beat(what.node, beat_of(shape, frame.data), frame.stamp, now);
        } else if (what.kind == WireFrameKind::data) {
            LinkValues<Link>::take(*this, f, frame);
        } else if constexpr (row_count > 0) {
            take_channel(what, frame.data, now);
        }
    }

    bool is_good(std::size_t f, const can::Frame& frame) noexcept TAPPET_REALTIME {
        const ProtectionVerdict verdict = checks_[f].check(std::span{frame.data}.first(frame.length));
        // Channels and beats detect old frames themselves; for values the last one counts.
        return verdict.kind != ProtectionVerdict::Kind::wrong_crc;
    }

    void take_beat(std::size_t node, const Beat& beat, Time at, Time now) noexcept TAPPET_REALTIME {
        Peer& peer = peers_[node];
        if (!beat.runs) {
            if (peer.there && peer.epoch == beat.epoch) lose(node);
            return;
        }
        if (!peer.there || peer.epoch != beat.epoch) begin(node, beat.epoch, now);
        peer.silent_at = at + system.wire.silent_after;
        for (std::size_t i = 0; i < row_count; ++i) {
            if (Rows::rows[i].name != beat.row || Rows::other(i) != node) continue;
            if (Rows::rows[i].layout == beat.layout)
                state_[i].agreed = true;
            else
                refuse(i, true);
        }
        if (!std::exchange(peer.has_told, true))
            peer.first_row = beat.row;
        else if (peer.rounds < told_twice && beat.row == peer.first_row && ++peer.rounds == told_twice)
            for (std::size_t i = 0; i < row_count; ++i)
                if (Rows::other(i) == node && !state_[i].agreed) refuse(i, false);
        if (!is_there[node].last() && knows_rows_of(node)) is_there[node].write(true);
    }
    void refuse(std::size_t i, bool has_it) noexcept TAPPET_REALTIME {
        if (std::exchange(state_[i].is_refused, true)) return;
        refused.write(Rows::refusal(i, has_it));
    }
    /// A row missing in the other version is never announced; known after two rounds, as a beat may be lost.
    static constexpr std::uint8_t told_twice = 2;
    [[nodiscard]] bool knows_rows_of(std::size_t node) const noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < row_count; ++i)
            if (Rows::other(i) == node && !state_[i].agreed && !state_[i].is_refused) return false;
        return true;
    }
    /// Starts a node that is heard again, or after a restart. After a restart, everything pending with its
    /// previous start is over. After a silence within the same start both ends continue where they were.
    void begin(std::size_t node, std::uint16_t epoch, Time now) noexcept TAPPET_REALTIME {
        if (peers_[node].there) lose(node); // it restarted before its silence was detected
        const bool is_new = peers_[node].epoch != epoch;
        const Time begun = is_new ? now : peers_[node].begun;
        peers_[node] = {.there = true, .epoch = epoch, .begun = begun};
        for (std::size_t i = 0; is_new && i < row_count; ++i) {
            if (Rows::other(i) != node) continue;
            state_[i].sender.begin();
            state_[i].receiver.begin();
            state_[i].serves = state_[i].refuses = false; // it still executes; its end is not reported
        }
    }
    void lose(std::size_t node) noexcept TAPPET_REALTIME {
        end_rows(node);
        peers_[node].there = false;
        is_there[node].write(false);
    }
    void end_rows(std::size_t node) noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < row_count; ++i) {
            if (Rows::other(i) != node) continue;
            RowState& row = state_[i];
            row.agreed = row.is_refused = row.was_valid = false;
            if (Rows::sends_events(i)) {
                if (row.sender.state() == ChannelSender::State::sends) tell_loss(i);
                if (row.is_held) tell_loss(i);
            }
            row.is_held = false;
            row.sender.give_up();
            if (row.is_under_way()) row.call = Call::failed;
        }
    }

    void take_channel(const WireFrame& what, Contents payload, Time now) noexcept TAPPET_REALTIME {
        const std::size_t i = Rows::row_of(what.crossing);
        if (i == nowhere) return;
        RowState& row = state_[i];
        const ChannelHead head = head_of(shape, payload);
        const bool is_message = what.kind == WireFrameKind::message || what.kind == WireFrameKind::reply;
        const std::uint16_t other = peers_[what.node].epoch;
        if (!row.agreed ||
            head.session != (is_message ? session_of(other, epoch_) : session_of(epoch_, other)))
            return;
        if (!is_message) {
            row.sender.taken(head.number, payload[contents]);
            return;
        }
        const bool serves = row.receiver.take(head.word, head.number);
        if (what.kind == WireFrameKind::message) {
            if (serves && Rows::is_command(i))
                begin_command(i, head.number, payload);
            else if (serves)
                emit(i, payload);
            answer(i, plan.place[what.crossing].answer, now);
        } else {
            take_reply(i, serves, payload);
            answer(i, plan.place[what.crossing].received, now);
        }
    }
    void emit(std::size_t i, Contents payload) noexcept TAPPET_REALTIME {
        std::array<std::byte, 56> packed{};
        if (!on_wire::hear(payload, 8 * contents, Rows::index(i).value, packed.data())) return tell_loss(i);
        Rows::facet_from(i).event->emit(storage_.data() + Rows::rows[i].event_at, packed.data());
    }
    void begin_command(std::size_t i, std::uint8_t number, Contents payload) noexcept TAPPET_REALTIME {
        CommandCallSlot& call = calls[i];
        RowState& row = state_[i];
        if (row.serves || !call.slot.is_mine()) { // an earlier one still executes
            row.refuses = true, row.refused = number;
            return;
        }
        row.serving = number;
        call.values = {};
        row.serves = on_wire::hear(payload, 8 * contents, Rows::index(i).value, call.values.data()) &&
                     call.slot.send();
        if (!row.serves) row.refuses = true, row.refused = number;
    }
    /// Takes the reply to a command sent from here.
    void take_reply(std::size_t i, bool serves, Contents payload) noexcept TAPPET_REALTIME {
        RowState& row = state_[i];
        if (row.call != Call::offered) return;
        // It may be the reply to an earlier command whose reply was lost.
        if (serves && (payload[contents] >> 3) != (row.asked & 31u)) return;
        const auto how = static_cast<CommandState>(payload[contents] & 7u);
        const bool is_done = serves && how == CommandState::done &&
                             on_wire::hear(payload, 8 * contents + 8, Rows::index(i).result,
                                           row.values.data() + Rows::index(i).value.bytes);
        row.call = is_done ? Call::done : Call::failed; // rejected, failed, or the reply was lost
    }

    // ---- sent frames

    void serve(Time now) noexcept TAPPET_REALTIME {
        // On a faulted bus this end may receive without being heard, so it treats the others as lost.
        if (can::faulted(device_->state()))
            for (std::size_t node = 0; node < node_count; ++node)
                if (peers_[node].there) lose(node);
        for (std::size_t node = 0; node < node_count; ++node)
            if (peers_[node].there && now >= peers_[node].silent_at) lose(node);
        for (std::size_t i = 0; i < row_count; ++i) {
            if (Rows::sends_events(i)) take_emissions(i, now);
            if (Rows::serves_command(i)) follow_command(i, now);
            if (state_[i].call == Call::wanted) send_wanted(i, now);
            send_channel(i, now);
        }
        for (std::size_t f = 0; f < due_.size(); ++f) {
            if (due_[f] > now) continue;
            due_[f] += ((now - due_[f]) / plan.frames[f].apart + 1) * plan.frames[f].apart;
            plan.frames[f].kind == WireFrameKind::beat ? send_beat(now) : send_data(f, now);
        }
        const can::State before = device_->state();
        device_->service(now);
        if (device_->state() != before) waiter_->wake(); // the bus reports it
        arm(now);
    }
    void arm(Time now) noexcept TAPPET_REALTIME {
        Time first = device_->next_service();
        for (const Time due : due_) first = std::min(first, due);
        for (const Peer& peer : peers_)
            if (peer.there) first = std::min(first, peer.silent_at);
        for (const RowState& row : state_) {
            if (!row.agreed) continue;
            first = std::min(first, row.sender.next());
            if (row.is_held && row.may_offer > now) first = std::min(first, row.may_offer);
        }
        next.arm(first);
    }
    void send_wanted(std::size_t i, Time now) noexcept TAPPET_REALTIME {
        RowState& row = state_[i];
        if (now < row.may_offer) return hold(row);
        row.is_held = false;
        row.call = Call::offered;
        offer(i, row.values.data(), now);
        row.asked = row.sender.number();
    }
    void take_emissions(std::size_t i, Time now) noexcept TAPPET_REALTIME {
        RowState& row = state_[i];
        for (int k = 0; k < max_frames_per_cycle; ++k) {
            if (row.is_held) {
                if (!row.sender.is_free() || now < row.may_offer) return;
                row.is_held = false;
                offer(i, row.values.data(), now);
            }
            if (row.agreed && !row.sender.is_free()) return;
            const std::byte* packed = emitted[i].take();
            if (packed == nullptr) return;
            if (!row.agreed) {
                tell_loss(i);
                continue;
            }
            if (now < row.may_offer) {
                std::copy_n(packed, Rows::index(i).value.bytes, row.values.data());
                hold(row);
                return;
            }
            offer(i, packed, now);
        }
    }
    /// Holds back and counts an offer sooner than its row allows: the wire's proof relies on the rows.
    void hold(RowState& row) noexcept TAPPET_REALTIME {
        if (!row.is_held) held_back.write(++held_back_);
        row.is_held = true;
    }
    void offer(std::size_t i, const std::byte* packed, Time now) noexcept TAPPET_REALTIME {
        Room arguments{};
        // Keeps its own time grid: a late activity does not delay an offer that comes in time.
        Time& may_offer = state_[i].may_offer;
        may_offer = std::max(may_offer, now - system.wire.service.deadline) + Rows::crossing(i).at_most_per;
        const WireValue& as = Rows::index(i).value;
        const on_wire::Told told = on_wire::tell(packed, as, arguments, 0);
        if (told != on_wire::Told::well) beyond.write(++beyond_);
        if (told == on_wire::Told::no_number) return give_up(i);
        state_[i].sender.offer(std::span{arguments}.first((as.bits + 7u) / 8u), now);
    }
    void give_up(std::size_t i) noexcept TAPPET_REALTIME {
        if (Rows::sends_events(i)) tell_loss(i);
        if (state_[i].call == Call::offered) state_[i].call = Call::failed;
    }
    void tell_loss(std::size_t i) noexcept TAPPET_REALTIME {
        events_lost.write(++lost_events_);
        lost[i].emit();
    }
    /// Processes commands of another node that execute here.
    void follow_command(std::size_t i, Time now) noexcept TAPPET_REALTIME {
        RowState& row = state_[i];
        if (!row.sender.is_free()) return;
        if (row.refuses) {
            row.refuses = false;
            reply(i, CommandState::rejected, row.refused, now);
        } else if (row.serves && calls[i].slot.is_mine()) {
            row.serves = false;
            reply(i, calls[i].slot.state(), row.serving, now);
        }
    }
    void reply(std::size_t i, CommandState how, std::uint8_t number, Time now) noexcept TAPPET_REALTIME {
        Room payload{};
        static_assert(static_cast<unsigned>(CommandState::done) < 8, "a state has three bits");
        const CrossingIndex& index = Rows::index(i);
        if (on_wire::tell(calls[i].values.data() + index.value.bytes, index.result, payload, 8) ==
            on_wire::Told::no_number)
            how = CommandState::failed;
        payload[0] = static_cast<std::uint8_t>(static_cast<unsigned>(how) | unsigned{number} << 3);
        state_[i].sender.offer(std::span{payload}.first(1 + (index.result.bits + 7u) / 8u), now);
    }
    void send_channel(std::size_t i, Time now) noexcept TAPPET_REALTIME {
        RowState& row = state_[i];
        if (!row.agreed) return;
        const bool was_sending = row.sender.state() == ChannelSender::State::sends;
        ChannelSender::Frame frame;
        const bool has_frame = row.sender.due(now, frame);
        if (was_sending && row.sender.state() == ChannelSender::State::gives_up) give_up(i);
        if (!has_frame) return;
        Room payload{};
        put_head(shape, payload,
                 {frame.word, frame.number, session_of(epoch_, peers_[Rows::other(i)].epoch)});
        std::copy(frame.bytes.begin(), frame.bytes.end(), payload.begin() + contents);
        send(Rows::message_frame(i), payload, now);
    }
    void answer(std::size_t i, std::size_t f, Time now) noexcept TAPPET_REALTIME {
        Room payload{};
        put_head(shape, payload,
                 {ChannelWord::taken, state_[i].receiver.last(),
                  session_of(peers_[Rows::other(i)].epoch, epoch_)});
        payload[contents] = state_[i].receiver.lost();
        send(f, payload, now);
    }
    void send_beat(Time now) noexcept TAPPET_REALTIME {
        Room payload{};
        Beat beat{.runs = true, .epoch = epoch_};
        if constexpr (row_count > 0) {
            beat.row = Rows::rows[told_row_].name, beat.layout = Rows::rows[told_row_].layout;
            told_row_ = (told_row_ + 1) % row_count;
        }
        put_beat(shape, payload, beat);
        send(Rows::beat_frame, payload, now);
    }
    void send_data(std::size_t f, Time now) noexcept TAPPET_REALTIME {
        Room payload{};
        LinkValues<Link>::tell(*this, f, payload);
        send(f, payload, now);
    }
    void send(std::size_t f, const Room& payload, Time now) noexcept TAPPET_REALTIME {
        can::Frame frame;
        frame.id = plan.frames[f].id;
        frame.extended = system.wire.fixed_identifiers;
        can::set_format(frame, format_of(system.wire, plan.frames[f]));
        frame.length = plan.frames[f].bytes;
        std::copy(payload.begin(), payload.end(), frame.data.begin());
        frame.stamp = now;
        static_cast<void>(
            protectors_[f].protect(std::span{frame.data}.first(frame.length))); // it fits: see protected_by
        // A faulted bus sends nothing; the next frame has newer contents.
        const can::Send sent = device_->send(frame, can::Keep::every);
        if (sent != can::Send::queued && sent != can::Send::replaced) not_sent.write(++not_sent_);
    }

    // ---- commands sent from here

    template <std::size_t i>
    static bool begin_call(void* self, std::byte* values) noexcept TAPPET_REALTIME {
        auto& link = *static_cast<Link*>(self);
        RowState& row = link.state_[i];
        if (!row.agreed || !row.sender.is_free()) return false;
        row.call = Call::wanted;
        std::copy_n(values, Rows::index(i).value.bytes, row.values.data());
        link.next.arm(Time{}); // as soon as the engine checks
        return true;
    }
    template <std::size_t i>
    static CommandProgress call_progress(void* self, std::byte* values) noexcept TAPPET_REALTIME {
        RowState& row = static_cast<Link*>(self)->state_[i];
        if (row.is_under_way()) return CommandProgress::executing;
        const bool is_done = row.call == Call::done;
        row.call = Call::none;
        if (!is_done) return CommandProgress::failed;
        const CrossingIndex& index = Rows::index(i);
        std::copy_n(row.values.data() + index.value.bytes, index.result.bytes, values + index.value.bytes);
        return CommandProgress::done;
    }

    /// Returns the protection: AUTOSAR's E2E P11 for frames of 8 bytes, P05 for up to 64.
    static constexpr Protection protected_by(std::size_t f) {
        return {.form = system.wire.is_fd() ? Protection::Form::wide : Protection::Form::id_both,
                .id = plan.frames[f].data_id};
    }
    static constexpr std::make_index_sequence<frame_count> each_frame{};
    template <class End, std::size_t... f>
    static constexpr std::array<End, frame_count> of_each_frame(std::index_sequence<f...>) {
        static_assert((protection_fault(protected_by(f), plan.frames[f].bytes).empty() && ...));
        return {End{protected_by(f)}...};
    }

    can::Device* device_ = nullptr;
    os::Waiter* waiter_ = nullptr;
    alignas(64) std::array<std::byte, Rows::storage_bytes> storage_{};
    std::array<Peer, node_count> peers_{};
    std::array<RowState, row_count> state_{};
    std::array<Time, frame_count> due_{};
    std::array<ProtectionCheck, frame_count> checks_ = of_each_frame<ProtectionCheck>(each_frame);
    std::array<Protector, frame_count> protectors_ = of_each_frame<Protector>(each_frame);
    std::uint16_t epoch_ = 0;
    std::size_t told_row_ = 0;
    std::int64_t refused_frames_ = 0, lost_events_ = 0, beyond_ = 0, not_sent_ = 0, held_back_ = 0;
};

} // namespace tappet::systems
