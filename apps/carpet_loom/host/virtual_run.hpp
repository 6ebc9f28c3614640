// The carpet loom and its plant under virtual time.
#pragma once

#include "apps/carpet_loom/host/in_process_loom.hpp"
#include "kernel/machine/virtual_world.hpp"

namespace tappet::carpet {

/// Everything of one run; lives as long as the run. One at a time: the machine's memory is static.
class VirtualRun {
public:
    VirtualRun(const loom::Settings& settings, std::uint64_t seed, bool quiet = true);

    /// Configures and starts. An error is the first refusal.
    std::expected<void, Sentence> start();
    bool run_for(Duration time) { return world_.run_until(clock_.now() + time); }
    /// Until the plant has woven `picks` and stands, or `limit` has passed. True when they were woven.
    bool weave(std::uint64_t picks, Duration limit);
    void stop() { world_.stop(); }

    [[nodiscard]] MachineInstance& instance() noexcept { return instance_; }
    [[nodiscard]] InProcessLoom& loom() noexcept { return loom_; }
    [[nodiscard]] os::Clock& clock() noexcept { return clock_; }
    [[nodiscard]] VirtualWorld& world() noexcept { return world_; }
    /// Of everything that happened, in machine and plant.
    [[nodiscard]] std::uint64_t event_log_digest();

private:
    os::Clock clock_{os::Clock::Kind::virtual_time};
    InProcessLoom loom_;
    MachineInstance instance_;
    VirtualWorld world_;
    bool quiet_;
    std::uint64_t seen_steps_ = 0;
};

} // namespace tappet::carpet
