// A CANopen node's life on the bus (CiA 301): boot-up message, NMT state, heartbeat, and falling silent.
#pragma once

#include "apps/carpet_loom/plant/wire.hpp"
#include "kernel/base/random.hpp"

#include <algorithm>

namespace tappet::loom {

/// A cyclic duty of a node, by the node's own clock.
struct Cycle {
    Time next = never;
    Duration period{};
    void start(Time now) noexcept TAPPET_REALTIME { next = now + period; }
    void stop() noexcept TAPPET_REALTIME { next = never; }
    void done() noexcept TAPPET_REALTIME { next += period; }
};

class Node {
public:
    /// `pdo_period_us` 0: the node sends its PDO on change only. Each node's clock is off by up to 50 ppm.
    Node(std::uint8_t id, std::int64_t pdo_period_us, Random& random) noexcept TAPPET_REALTIME : id_(id) {
        const std::int64_t ppm = random.between(-50, 50);
        pdo_.period = Duration{pdo_period_us * 1000 + pdo_period_us * ppm / 1000};
        heartbeat_.period =
            Duration{wires::heartbeat_period_us * 1000 + wires::heartbeat_period_us * ppm / 1000};
        boot_at_ = at_ns(random.between(20'000'000, 120'000'000));
    }

    [[nodiscard]] std::uint8_t id() const noexcept TAPPET_REALTIME { return id_; }
    [[nodiscard]] bool operational() const noexcept TAPPET_REALTIME {
        return state_ == wires::nmt_state::operational;
    }
    /// Has power and takes part in the traffic.
    [[nodiscard]] bool alive() const noexcept TAPPET_REALTIME { return alive_ && boot_at_ == never; }
    [[nodiscard]] Time next() const noexcept TAPPET_REALTIME {
        return alive_ ? std::min({boot_at_, heartbeat_.next, pdo_.next}) : never;
    }

    /// Network management for this node. True when the node restarts: its application starts afresh, too.
    bool network_management(std::uint8_t command, std::uint8_t node, Time now) noexcept TAPPET_REALTIME {
        namespace order = wires::nmt_command;
        if (!alive() || (node != 0 && node != id_)) return false;
        switch (command) {
        case order::start:
            if (!operational() && pdo_.period > Duration{}) pdo_.start(now);
            state_ = wires::nmt_state::operational;
            return false;
        case order::stop: leave_operational(wires::nmt_state::stopped); return false;
        case order::pre_operational: leave_operational(wires::nmt_state::pre_operational); return false;
        case order::reset_communication: restart(now); return false;
        case order::reset_node: restart(now); return true;
        default: return false;
        }
    }

    /// Sends the boot-up message or the heartbeat when due. True when the process data is due: the caller
    /// sends it.
    bool tick(Time now, Wire& out) noexcept TAPPET_REALTIME {
        if (!alive_) return false;
        if (boot_at_ <= now) {
            beat(wires::nmt_state::boot_up, boot_at_, out);
            heartbeat_.start(boot_at_);
            boot_at_ = never;
            state_ = wires::nmt_state::pre_operational;
        }
        if (heartbeat_.next <= now) {
            beat(state_, heartbeat_.next, out);
            heartbeat_.done();
        }
        if (pdo_.next > now) return false;
        pdo_.done();
        return true;
    }

    void die() noexcept TAPPET_REALTIME { alive_ = false; }
    void revive(Time now) noexcept TAPPET_REALTIME {
        alive_ = true;
        restart(now);
    }

private:
    struct Heartbeat {
        Wire::Signals::Sent frame;
        Wire::Signals::SentSignal state;
    };
    static constexpr Heartbeat heartbeats[wires::node::count] = {
        {"heartbeat_1", "heartbeat_1.state"}, {"heartbeat_2", "heartbeat_2.state"},
        {"heartbeat_3", "heartbeat_3.state"}, {"heartbeat_4", "heartbeat_4.state"},
        {"heartbeat_5", "heartbeat_5.state"}, {"heartbeat_6", "heartbeat_6.state"}};

    void beat(std::uint8_t state, Time due, Wire& out) const noexcept TAPPET_REALTIME {
        const Heartbeat& own = heartbeats[id_ - 1];
        out.signals.set_integer(own.state, state);
        out.send(own.frame, due);
    }
    void leave_operational(std::uint8_t state) noexcept TAPPET_REALTIME {
        state_ = state;
        pdo_.stop();
    }
    void restart(Time now) noexcept TAPPET_REALTIME {
        leave_operational(wires::nmt_state::boot_up);
        heartbeat_.stop();
        boot_at_ = now + 100ms;
    }

    std::uint8_t id_;
    std::uint8_t state_ = wires::nmt_state::boot_up;
    bool alive_ = true;
    Time boot_at_;
    Cycle heartbeat_;
    Cycle pdo_;
};

} // namespace tappet::loom
