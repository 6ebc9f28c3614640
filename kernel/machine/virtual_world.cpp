// The order of virtual time: of what is ready at an instant, the most urgent activity runs next.
#include "kernel/machine/virtual_world.hpp"

#include "kernel/base/contract.hpp"

#include <algorithm>

namespace tappet {

VirtualWorld::VirtualWorld(MachineInstance& instance) noexcept : instance_{instance} {
    const auto rank = instance.machine().index.rank;
    for (std::size_t r = 0; r < rank.size(); ++r)
        for (std::size_t a = 0; a < rank.size(); ++a)
            if (rank[a] == r) static_cast<void>(by_urgency_.push(a));
}

void VirtualWorld::start() {
    const auto engines = instance_.engines();
    for (Engine& engine : engines) engine.start(instance_.clock().now());
    for (std::size_t a = 0; a < engines.size(); ++a) wake_at_[a] = engines[a].next_wake();
}

Time VirtualWorld::next_time() const {
    Time next = never;
    for (const VirtualProcess& process : processes_) next = std::min(next, process.next(process.self));
    const auto engines = instance_.engines();
    for (std::size_t a = 0; a < engines.size(); ++a) {
        if (engines[a].waiter().is_woken()) return instance_.clock().now();
        next = std::min(next, wake_at_[a]);
    }
    return next;
}

void VirtualWorld::run_engines(Time now) {
    const auto engines = instance_.engines();
    for (int round = 0; round < max_rounds_per_instant; ++round) {
        bool ran = false;
        for (const std::size_t a : by_urgency_) {
            Engine& engine = engines[a];
            const bool woken = engine.waiter().is_woken() && engine.waiter().take();
            if (!woken && wake_at_[a] > now) continue;
            engine.run(woken);
            wake_at_[a] = engine.next_wake();
            ++steps_;
            ran = true;
            break; // the most urgent of those that are ready now runs next
        }
        if (!ran || instance_.stop_asked()) return;
    }
    TAPPET_CONTRACT(false, Contract::step_limit_exceeded, max_rounds_per_instant, max_rounds_per_instant + 1);
}

bool VirtualWorld::run_until(Time end) {
    os::Clock& clock = instance_.clock();
    while (!instance_.stop_asked()) {
        const Time next = std::max(next_time(), clock.now());
        if (next > end) {
            clock.advance_to(end);
            return true;
        }
        clock.advance_to(next);
        for (const VirtualProcess& process : processes_)
            if (process.next(process.self) <= next) process.run(process.self, next);
        run_engines(clock.now());
    }
    return false;
}

void VirtualWorld::stop() {
    const auto engines = instance_.engines();
    for (std::size_t a = engines.size(); a-- > 0;) engines[a].stop(instance_.clock().now());
}

} // namespace tappet
