// The carpet loom and its plant under real time: the machine in its threads, the plant in one more.
#pragma once

#include "apps/carpet_loom/host/in_process_loom.hpp"
#include "kernel/machine/worlds/real_world.hpp"

#include <array>
#include <atomic>

namespace tappet::carpet {

/// Everything of one run; lives as long as the run. One at a time. Some megabytes: static memory, not a
/// stack.
class RealRun {
public:
    RealRun(const loom::Settings& settings, std::uint64_t seed, bool quiet = true);
    ~RealRun();
    RealRun(const RealRun&) = delete;
    RealRun& operator=(const RealRun&) = delete;

    /// Configures, arms and starts. What arming found is printed on `file`. An error is the first refusal.
    std::expected<void, Sentence> start(int file);
    /// Until the plant has woven `picks` and stands, `limit` has passed, or a stop is asked for. True when
    /// they were woven.
    bool weave(std::uint64_t picks, Duration limit);
    /// The machine first, then the plant, which comes to rest meanwhile. How many threads of the machine
    /// hung.
    int stop();

    [[nodiscard]] MachineInstance& instance() noexcept { return instance_; }
    [[nodiscard]] RealWorld& world() noexcept { return world_; }
    /// After stop(): the plant is its thread's until then.
    [[nodiscard]] InProcessLoom& loom() noexcept { return loom_; }

private:
    /// The plant looks at its wires this often at least: what the machine does reaches it so late at most.
    static constexpr Duration plant_period = 200us;
    /// Below every activity of the machine, above the developer's other work, which would let frames come
    /// late.
    static constexpr int plant_priority = 1;

    static void live(void* self) noexcept;
    void follow() noexcept;

    os::Clock clock_{os::Clock::Kind::real};
    InProcessLoom loom_;
    MachineInstance instance_;
    RealWorld world_;
    bool quiet_;
    bool running_ = false;

    alignas(4096) std::array<std::byte, 128 * 1024> plant_stack_{};
    os::ThreadPlan plant_plan_{};
    os::Waiter plant_waiter_{};
    std::atomic<bool> plant_ends_{false};
    std::atomic<std::uint64_t> picks_{0};
    std::atomic<bool> stands_{true};
    os::Thread plant_thread_{};
};

} // namespace tappet::carpet
