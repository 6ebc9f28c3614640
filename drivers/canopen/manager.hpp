// The manager of a CANopen network (CiA 302-2) as a component: starts the nodes that match the table,
// monitors them, and produces SYNC, TIME and a heartbeat.
#pragma once

#include "drivers/canopen/network.hpp"
#include "drivers/canopen/trouble_text.hpp"
#include "kernel/base/array_of.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/facet_name.hpp"
#include "kernel/component/nth.hpp"
#include "kernel/pieces/changed.hpp"

namespace tappet::canopen {

/// An emergency message (CiA 301, 7.2.7). Code 0: the errors are reset.
struct Emergency {
    std::int64_t node = 0;
    std::int64_t code = 0;
    std::int64_t error_register = 0;
    Time at{};
    bool operator==(const Emergency&) const = default;
};

/// All real-time, in a periodic activity whose period is at most that of SYNC. Rows of the table:
///     component<can::Bus<signals, canopen::frames<network>>>("can", device("can")),
///     component<canopen::Manager<network>>("network"),
///     buffer<64>("can.services", "network.received"), buffer<32>("network.to_send", "can.to_send", wakes),
///
/// At its start it resets the communication of all nodes. Each node is then checked, configured and started
/// separately: when it boots, when its heartbeat arrives, or when it answers at all; and again after a loss,
/// a reboot, or when it left its operational state. A node that does not match the table is refused until it
/// boots again.
template <const auto& map> struct Manager {
    TAPPET_ACCEPTED(map.fault);
    static constexpr std::size_t node_count = map.nodes.size();
    static constexpr int max_frames_per_cycle = 64;
    /// SDO requests sent in one cycle: the configuration must not fill the bus.
    static constexpr int max_requests_per_cycle = 1;

    BufferInput<can::Frame> received{};
    BufferOutput<can::Frame> to_send{};
    Input<Duration> time_of_day{};
    Output<bool> operational{};
    Output<std::int64_t> silent_node{};
    Output<Text<240>> reason{};
    Output<std::int64_t> reboots{};
    Output<std::int64_t> not_sent{};
    Output<std::int64_t> wrong_lengths{};
    std::array<Output<NodePhase>, node_count> phases{};
    std::array<Output<std::int64_t>, node_count> errors{};
    Event<std::int64_t, std::int64_t, std::int64_t> emergency{};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        can::Frame forgotten;
        for (int n = 0; n < max_frames_per_cycle && received.pop(forgotten);) ++n;
        for (std::size_t i = 0; i < node_count; ++i) {
            watches_[i].start(nodes[i], steps_of(i), map.first_step[i], cycle.now);
            error_[i].write(errors[i], 0);
        }
        next_sync_ = next_time_ = cycle.now;
        next_beat_ = cycle.now + map.manager.beats; // after the boot-up message
        counter_ = to_reset_ = 0;
        emergencies_.clear();
        told_ = NodeTrouble{.step = no_step};
        if constexpr (map.manager.beats != Duration{})
            send(heartbeat_frame(map.manager.id, NmtState::boot_up), cycle.now);
        send_command(NmtCommand::reset_communication, 0, cycle.now);
        tell();
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < node_count; ++i) phase_[i].write(phases[i], NodePhase::absent);
    }

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        produce(cycle.now);
        can::Frame frame;
        for (int n = 0; n < max_frames_per_cycle && received.pop(frame); ++n) take(frame, cycle.now);
        for (std::size_t i = 0; i < node_count; ++i) {
            watches_[i].tick(cycle.now);
            if (NmtCommand command{}; cycle.now >= may_command_ && watches_[i].next_command(command))
                send_command(command, nodes[i].id, cycle.now);
        }
        send_requests(cycle.now);
        tell();
    }

    /// NMT reset node, requested by a person: the node boots and is configured again.
    void reset(std::int64_t node) noexcept TAPPET_REALTIME {
        for (const WatchedNode& each : nodes)
            if (each.id == node) to_reset_ = each.id;
    }

    /// Returns the last sixteen emergency messages, oldest first.
    [[nodiscard]] std::span<const Emergency> emergencies() const noexcept {
        return {emergencies_.begin(), emergencies_.size()};
    }
    [[nodiscard]] const NodeWatch& watch(std::size_t i) const noexcept { return watches_[i]; }

    static constexpr auto interface() {
        std::array<Facet, 11 + 2 * node_count> list{};
        std::size_t n = 0;
        for (const Facet& facet : {
                 input<&Manager::received>("received", "", "frames of the network"),
                 output<&Manager::to_send>("to_send", "", "frames for the network"),
                 input<&Manager::time_of_day>("time_of_day", "s", "since 1984, for TIME", optional),
                 output<&Manager::operational>("operational", "", "every node works; written on change",
                                               while_stopped(false)),
                 output<&Manager::silent_node>("silent_node", "",
                                               "the first node that is silent, 0: none; written on change"),
                 output<&Manager::reason>("reason", "", "why not every node works; written on change"),
                 output<&Manager::reboots>("reboots", "", "of nodes that worked; written on change"),
                 output<&Manager::not_sent>(
                     "not_sent", "",
                     "frames dropped because the queue to the bus was full; written on change"),
                 output<&Manager::wrong_lengths>("wrong_lengths", "",
                                                 "frames of a wrong length; written on change"),
                 tappet::event<&Manager::emergency>("emergency", "EMCY: node, code, error register"),
                 operation<&Manager::reset>("reset", "NMT reset of one node"),
             })
            list[n++] = facet;
        for (std::size_t i = 0; i < node_count; ++i) {
            list[n++] = nth_output<&Manager::phases>(i, phase_names[i].view(), "",
                                                     "how far the node's start has come; written on change");
            list[n++] = nth_output<&Manager::errors>(
                i, error_names[i].view(), "", "code of its last emergency, 0: none; written on change");
        }
        return list;
    }

private:
    static constexpr std::uint16_t no_step = 0xFFFF;

    // The parts of the table that a program needs.
    static constexpr auto nodes = array_of<node_count>([](std::size_t i) {
        const NodeRow& row = map.nodes[i];
        return WatchedNode{row.id,    row.name,       row.dictionary.product, row.dictionary.file,
                           row.beats, row.lost_after, row.answers_within};
    });
    static constexpr auto steps = array_of<map.steps.used>([](std::size_t i) { return map.steps[i]; });
    static constexpr auto first_step = map.first_step;
    static constexpr auto names(std::string_view end) {
        return array_of<node_count>([end](std::size_t i) { return FacetName{map.nodes[i].name, end}; });
    }
    static constexpr auto phase_names = names(".phase");
    static constexpr auto error_names = names(".error");

    static constexpr std::span<const ConfigurationStep> steps_of(std::size_t i) noexcept TAPPET_REALTIME {
        return std::span{steps}.subspan(first_step[i], first_step[i + 1] - first_step[i]);
    }

    void send(can::Frame frame, Time now) noexcept TAPPET_REALTIME {
        frame.stamp = now;
        if (!to_send.push(frame)) ++lost_;
    }

    void send_command(NmtCommand command, std::uint8_t node, Time now) noexcept TAPPET_REALTIME {
        send(nmt_frame(command, node), now);
        may_command_ = now + commands_apart;
    }

    void take(const can::Frame& frame, Time now) noexcept TAPPET_REALTIME {
        const std::uint32_t service = frame.id & ~std::uint32_t{most_nodes};
        const std::uint8_t length = service == cob::heartbeat ? 1 : 8;
        for (std::size_t i = 0; i < node_count; ++i) {
            if ((frame.id & most_nodes) != nodes[i].id) continue;
            if (frame.length != length) {
                ++malformed_;
                return;
            }
            if (service == cob::heartbeat) watches_[i].take_heartbeat(frame.data[0], now);
            if (service == cob::sdo_answer) watches_[i].take_answer(frame.data);
            if (service == cob::emergency) take_emergency(i, frame);
            return;
        }
    }
    void take_emergency(std::size_t i, const can::Frame& frame) noexcept TAPPET_REALTIME {
        const auto code = static_cast<std::int64_t>(frame.data[0] | frame.data[1] << 8);
        if (emergencies_.full()) {
            for (std::size_t k = 1; k < emergencies_.size(); ++k) emergencies_[k - 1] = emergencies_[k];
            --emergencies_.used;
        }
        static_cast<void>(emergencies_.push({nodes[i].id, code, frame.data[2], frame.stamp}));
        error_[i].write(errors[i], code);
        emergency.emit(nodes[i].id, code, frame.data[2]);
    }

    /// Advances by absolute times: a late cycle does not shift later ones, and missed ones are skipped.
    static bool is_due(Time& next, Duration every, Time now) noexcept TAPPET_REALTIME {
        if (next > now) return false;
        next += ((now - next) / every + 1) * every;
        return true;
    }
    void produce(Time now) noexcept TAPPET_REALTIME {
        constexpr ManagerRow row = map.manager;
        if constexpr (row.sync_every != Duration{})
            if (is_due(next_sync_, row.sync_every, now)) {
                if constexpr (row.sync_overflow != 0)
                    counter_ = counter_ == row.sync_overflow ? std::uint8_t{1}
                                                             : static_cast<std::uint8_t>(counter_ + 1);
                send(sync_frame(row.sync_overflow, counter_), now);
            }
        if constexpr (row.beats != Duration{})
            if (is_due(next_beat_, row.beats, now)) send(heartbeat_frame(row.id, NmtState::operational), now);
        if constexpr (row.time_every != Duration{})
            if (is_due(next_time_, row.time_every, now)) send_time(now);
        if (to_reset_ == 0 || now < may_command_) return;
        send_command(NmtCommand::reset_node, to_reset_, now);
        to_reset_ = 0;
    }
    /// Sends TIME_OF_DAY: milliseconds of the day in 28 bits, days since 1984 in 16. Time unknown: nothing.
    void send_time(Time now) noexcept TAPPET_REALTIME {
        if (!time_of_day.good()) return;
        const Duration since = time_of_day.get() + (now - time_of_day.stamp());
        constexpr Duration day = 24h;
        can::Frame time{.id = cob::time, .length = 6};
        to_bytes(static_cast<std::uint64_t>(since % day / 1ms), std::span{time.data}.first(4));
        to_bytes(static_cast<std::uint64_t>(since / day), std::span{time.data}.subspan(4, 2));
        send(time, now);
    }

    /// Serves the nodes in turn, so that no node waits for another one.
    void send_requests(Time now) noexcept TAPPET_REALTIME {
        int left = max_requests_per_cycle;
        for (std::size_t k = 0; k < node_count && left > 0; ++k) {
            turn_ = turn_ + 1 < node_count ? turn_ + 1 : 0;
            can::Frame frame{.id = cob::sdo_request + nodes[turn_].id, .length = 8};
            if (!watches_[turn_].next_request(frame.data, now)) continue;
            send(frame, now);
            --left;
        }
    }

    void tell() noexcept TAPPET_REALTIME {
        bool all = true;
        std::int64_t silent = 0;
        std::uint64_t reboots_now = 0;
        std::size_t worst = node_count;
        for (std::size_t i = 0; i < node_count; ++i) {
            const NodePhase phase = watches_[i].phase();
            phase_[i].write(phases[i], phase);
            reboots_now += watches_[i].reboots();
            if (phase == NodePhase::operational) continue;
            all = false;
            if (phase == NodePhase::lost && silent == 0) silent = nodes[i].id;
            const bool worse =
                worst == node_count || (watches_[worst].trouble().kind == NodeTrouble::Kind::none &&
                                        watches_[i].trouble().kind != NodeTrouble::Kind::none);
            if (worse) worst = i;
        }
        operational_.write(operational, all);
        silent_.write(silent_node, silent);
        reboots_.write(reboots, static_cast<std::int64_t>(reboots_now));
        not_sent_.write(not_sent, static_cast<std::int64_t>(lost_));
        malformed_told_.write(wrong_lengths, static_cast<std::int64_t>(malformed_));
        const NodeTrouble trouble = all ? NodeTrouble{} : watches_[worst].trouble();
        if (worst == worst_ && trouble == told_) return;
        worst_ = worst;
        told_ = trouble;
        Text<240> text;
        if (!all) text.append(to_text(nodes[worst], trouble, steps[trouble.step]).view());
        reason.write(text);
    }

    std::array<NodeWatch, node_count> watches_{};
    Bounded<Emergency, 16> emergencies_{};
    std::array<Changed<NodePhase>, node_count> phase_{};
    std::array<Changed<std::int64_t>, node_count> error_{};
    Changed<bool> operational_{};
    Changed<std::int64_t> silent_{}, reboots_{}, not_sent_{}, malformed_told_{};
    NodeTrouble told_{};
    std::size_t worst_ = node_count;
    std::size_t turn_ = 0;
    std::uint64_t lost_ = 0;
    std::uint64_t malformed_ = 0;
    std::uint8_t counter_ = 0;
    std::uint8_t to_reset_ = 0;
    Time next_beat_{}, next_sync_{}, next_time_{}, may_command_{};
};

} // namespace tappet::canopen
