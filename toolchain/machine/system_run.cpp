// Decides which node moves next, and converts the times of each clock.
#include "toolchain/machine/system_run.hpp"

#include "drivers/can/signal_map.hpp"
#include "kernel/base/digest.hpp"

#include <cmath>
#include <thread>

namespace tappet {

Time ClockFault::local(Time true_time) const noexcept TAPPET_REALTIME {
    if (true_time == never) return never;
    const auto drifted = static_cast<std::int64_t>(static_cast<double>(to_ns(true_time)) * drift_ppm * 1e-6);
    return true_time + offset + Duration{drifted};
}
/// Returns the first instant of true time at which the clock shows the local time.
Time ClockFault::true_time(Time local_time) const noexcept TAPPET_REALTIME {
    if (local_time == never || local_time == Time::min()) return local_time;
    const Time shifted = local_time - offset;
    auto guess = Time{
        Duration{static_cast<std::int64_t>(static_cast<double>(to_ns(shifted)) / (1.0 + drift_ppm * 1e-6))}};
    for (int i = 0; i < 8 && local(guess) < local_time; ++i) guess += local_time - local(guess);
    for (int i = 0; i < 8 && local(guess - 1ns) >= local_time; ++i) guess -= 1ns;
    return guess;
}

can::Receive WireEnd::receive(can::Frame& frame) noexcept TAPPET_REALTIME {
    if (has_again_) {
        has_again_ = false;
        frame = again_;
        return {can::Received::frame, 0};
    }
    for (std::size_t i = 0; i < can::Twin::inbox; ++i) {
        const can::Receive got = twin_.receive(frame);
        if (got.what != can::Received::frame) return got;
        frame.stamp = clock_.local(frame.stamp + lateness(frame.stamp));
        if (is_cut || random_.one_in(omits_one_in)) continue;
        has_again_ = random_.one_in(doubles_one_in);
        again_ = frame;
        return got;
    }
    return {};
}

can::Send WireEnd::send(const can::Frame& frame, can::Keep keep) noexcept TAPPET_REALTIME {
    if (is_cut) return can::Send::queued; // its controller believes that it was sent
    can::Frame sent = frame;
    sent.stamp = clock_.true_time(frame.stamp);
    return twin_.send(sent, keep);
}

can::Confirmation WireEnd::last_confirmed(can::Identifier of) const noexcept TAPPET_REALTIME {
    const can::Confirmation found = twin_.last_confirmed(of);
    if (found.at == Time{}) return {};
    return {clock_.local(found.made), clock_.local(found.at + lateness(found.at))};
}

/// Returns the same lateness for the same frame, on every call.
Duration WireEnd::lateness(Time of) const noexcept TAPPET_REALTIME {
    Random random{seed_ ^ static_cast<std::uint64_t>(to_ns(of))};
    return Duration{random.between(0, stamps_late.count())};
}

Time WireEnd::next_service() const noexcept TAPPET_REALTIME { return clock_.local(twin_.next_service()); }

SystemRun::SystemRun(const SystemView& system, std::span<const AcceptedMachine> machines,
                     std::span<Plant* const> plants, std::uint64_t seed)
    : system_{system}, wire_{seed, {system.wire.rate.bits_per_second, system.wire.rate.in_data_phase}} {
    for (std::size_t n = 0; n < machines.size(); ++n)
        nodes_.push_back(
            std::make_unique<Node>(machines[n], n < plants.size() ? plants[n] : nullptr, seed + n));
}

void SystemRun::browse_in(std::string_view directory) {
    for (const auto& node : nodes_) node->run.browse_in(directory);
    has_pace_ = true;
    began_at_ = now_;
    began_ = std::chrono::steady_clock::now();
}

/// Does not sleep for less than a millisecond.
void SystemRun::keep_pace() {
    const auto due = began_ + (now_ - began_at_);
    if (due - std::chrono::steady_clock::now() > 1ms) std::this_thread::sleep_until(due);
}

std::expected<void, Sentence> SystemRun::start() {
    for (std::size_t n = 0; n < nodes_.size(); ++n)
        if (auto started = start(n); !started) return started;
    return {};
}

std::expected<void, Sentence> SystemRun::start(std::size_t n) {
    Node& node = *nodes_[n];
    for (const ComponentRow& row : node.accepted.table.components) {
        if (row.device != system_.wire.name || row.type->shares_device) continue;
        const auto& map = *static_cast<const can::Identifiers*>(row.type->device_map);
        can::Settings settings{};
        settings.interface = system_.nodes[n].name;
        if (map.restarts_allowed != 0) settings.restarts_allowed = map.restarts_allowed;
        settings.receive = map.receive;
        settings.transmit = map.transmit;
        settings.takes_fd = map.has_fd;
        if (auto opened = node.twin.open(settings); !opened) return opened;
    }
    node.run.clock().advance_to(node.clock.local(now_));
    if (!node.was_started) {
        if (!wire_.attach(node.twin))
            return std::unexpected(Sentence{"the simulated wire has no room for another end"});
        node.run.devices().lend(
            {type_id<can::Device>, system_.wire.name, static_cast<can::Device*>(&node.end)});
    }
    // A box whose program died still acknowledges frames; one that was never switched on does not.
    std::size_t on_wire = 1;
    for (const auto& each : nodes_) on_wire += each.get() != &node && each->was_started ? 1u : 0u;
    wire_.set_acknowledged(on_wire > 1);
    auto started = node.was_started ? node.run.start_again() : node.run.start();
    node.was_started = true;
    node.is_alive = started.has_value();
    return started;
}

void SystemRun::stop(std::size_t n) {
    if (!nodes_[n]->is_alive) return;
    nodes_[n]->run.stop();
    nodes_[n]->is_alive = false;
}
void SystemRun::stop() {
    for (std::size_t n = nodes_.size(); n-- > 0;) stop(n);
}

Time SystemRun::next() const {
    Time first = const_cast<can::TwinBus&>(wire_).next();
    for (const auto& node : nodes_)
        if (node->is_alive) first = std::min(first, node->clock.true_time(node->run.world().next_time()));
    return first;
}

bool SystemRun::run_for(Duration time) {
    const Time end = now_ + time;
    for (;;) {
        const Time then = std::max(next(), now_);
        now_ = std::min(then, end);
        if (has_pace_) keep_pace();
        // Before a frame arrives: the machine handles it at its time of arrival.
        for (const auto& node : nodes_)
            if (node->is_alive)
                node->run.clock().advance_to(std::max(node->clock.local(now_), node->run.now()));
        wire_.deliver_until(now_);
        for (const auto& node : nodes_) {
            if (!node->is_alive) continue;
            if (!node->run.world().run_until(std::max(node->clock.local(now_), node->run.now())))
                return false;
        }
        if (look_) look_(now_);
        if (then > end) return true;
    }
}

bool SystemRun::run_until(const std::function<bool()>& done, Duration limit) {
    for (const Time end = now_ + limit; !done();)
        if (now_ >= end || !run_for(1ms)) return false;
    return true;
}

std::uint64_t SystemRun::digest() {
    Digest digest;
    for (const auto& node : nodes_) digest.add(node->run.instance().observation().event_log_digest());
    return digest.value();
}

} // namespace tappet
