// The carpet loom and its plant under virtual time.
#pragma once

#include "apps/carpet_loom/host/in_process_loom.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"

#include <optional>

namespace tappet::carpet {

/// Everything of one run; lives as long as the run. One at a time: the machine's memory is static.
class VirtualRun {
public:
    VirtualRun(const loom::Settings& settings, std::uint64_t seed, bool quiet = true);

    /// Configures and starts. An error is the first refusal.
    std::expected<void, Sentence> start();
    /// A new machine at the same plant, which stays as it is. The one before is gone, be it stopped or not.
    std::expected<void, Sentence> start_again();
    bool run_for(Duration time) { return machine_->world.run_until(clock_.now() + time); }
    /// Until the plant has woven `picks` and stands, or `limit` has passed. True when they were woven.
    bool weave(std::uint64_t picks, Duration limit);
    void stop() { machine_->world.stop(); }

    [[nodiscard]] MachineInstance& instance() noexcept { return machine_->instance; }
    [[nodiscard]] InProcessLoom& loom() noexcept { return loom_; }
    [[nodiscard]] os::Clock& clock() noexcept { return clock_; }
    [[nodiscard]] VirtualWorld& world() noexcept { return machine_->world; }
    /// Of everything that happened, in machine and plant.
    [[nodiscard]] std::uint64_t event_log_digest();

private:
    std::expected<void, Sentence> start_machine();
    struct Machine {
        explicit Machine(os::Clock& clock);
        MachineInstance instance;
        VirtualWorld world{instance};
    };

    os::Clock clock_{os::Clock::Kind::virtual_time};
    InProcessLoom loom_;
    std::optional<Machine> machine_;
    bool quiet_;
    std::uint64_t seen_steps_ = 0;
};

} // namespace tappet::carpet
