// A run under virtual time: configure, weave until the picks are done, digest the event log.
#include "apps/carpet_loom/host/virtual_run.hpp"

#include "apps/carpet_loom/console.hpp"
#include "apps/carpet_loom/host/loom_on_host.hpp"

namespace tappet::carpet {

VirtualRun::VirtualRun(const loom::Settings& settings, std::uint64_t seed, bool quiet)
    : loom_{settings, seed}, quiet_{quiet} {
    machine_.emplace(clock_);
}

VirtualRun::Machine::Machine(os::Clock& clock) : instance{loom_on_host(), clock} {}

std::expected<void, Sentence> VirtualRun::start() {
    if (auto opened = loom_.open(); !opened) return opened;
    return start_machine();
}

std::expected<void, Sentence> VirtualRun::start_again() {
    machine_.emplace(clock_);
    seen_steps_ = 0;
    return start_machine();
}

std::expected<void, Sentence> VirtualRun::start_machine() {
    MachineInstance& instance = machine_->instance;
    instance.read_properties_from(properties_on_host());
    if (auto configured = instance.configure(loom_.devices()); !configured)
        return std::unexpected(configured.error());
    instance.find<Console>("console")->quiet.set(quiet_);
    machine_->world.add({this,
                         [](void* self) {
                             auto& run = *static_cast<VirtualRun*>(self);
                             // Whenever the machine has run it may have put something on the wires: the plant
                             // gets it at once.
                             return run.seen_steps_ != run.world().steps() ? run.clock_.now()
                                                                           : run.loom_.next();
                         },
                         [](void* self, Time now) {
                             auto& run = *static_cast<VirtualRun*>(self);
                             run.seen_steps_ = run.world().steps();
                             run.loom_.advance(now);
                         }});
    if (const Sentence refusal = machine_->world.start(); !refusal.empty()) return std::unexpected(refusal);
    return {};
}

bool VirtualRun::weave(std::uint64_t picks, Duration limit) {
    const Time end = clock_.now() + limit;
    while (clock_.now() < end && !instance().stop_asked()) {
        run_for(50ms);
        if (loom_.plant().picks() >= picks && loom_.plant().speed_rpm() == 0.0) return true;
    }
    return false;
}

std::uint64_t VirtualRun::event_log_digest() {
    Digest digest;
    digest.add(instance().observation().event_log_digest());
    digest.add(loom_.plant().report().digest);
    return digest.value();
}

} // namespace tappet::carpet
