// A machine and its plant in one process, under virtual or real time: what the host's program of every
// machine does, and what a machine's tests hold in hand.
#pragma once

#include "drivers/plant/simulation.hpp"
#include "kernel/machine/worlds/real_world.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"
#include "kernel/services/configuration/property_files.hpp"
#include "toolchain/machine/host_hooks.hpp"

#include <atomic>
#include <expected>
#include <functional>
#include <optional>

namespace tappet {

/// Of everything that happened, in machine and plant.
[[nodiscard]] std::uint64_t digest_of(const MachineInstance& instance, const Plant& plant);

/// Virtual time: one thread, the same run for the same seed. Lives as long as the run; one at a time, since
/// the machine's memory is static.
class VirtualRun {
public:
    VirtualRun(const AcceptedMachine& machine, Plant& plant, std::uint64_t seed);

    /// Before start(): where rows with a properties file have their values from; nowhere unless told, so that
    /// a run depends on its seed alone. The characters outlive the run.
    void keep_properties_in(std::string_view directory) noexcept { files_.keep_in(directory); }
    /// Before start(): each machine of the run listens to browsers there. The characters outlive the run.
    void browse_in(std::string_view directory) noexcept { browsed_in_ = directory; }
    /// Before start(): cycles take times that the seed draws, up to their budgets, and frames theirs on the
    /// wire.
    void take_times(std::uint64_t seed, can::BitRates rates) {
        timed_by_ = seed;
        devices_.set_bit_rates(rates);
    }
    [[nodiscard]] MachineInstance& instance() noexcept { return machine_->instance; }
    /// Opens the twins, configures and starts. An error is the first refusal.
    std::expected<void, Sentence> start();
    /// A new machine at the same plant, which stays as it is. The one before is gone, be it stopped or not.
    std::expected<void, Sentence> start_again();
    /// Called whenever the plant has moved, which it does after each step of the machine: for who judges
    /// every moment.
    void judge_by(std::function<void(Time now)> look) { look_ = std::move(look); }
    /// False: the machine asked to stop.
    bool run_for(Duration time) { return machine_->world.run_until(clock_.now() + time); }
    /// Until `done`, looked at each millisecond. False: `limit` has passed, or the machine asked to stop.
    bool run_until(const std::function<bool()>& done, Duration limit);
    void stop() { machine_->world.stop(); }

    [[nodiscard]] SimulatedDevices& devices() noexcept { return devices_; }
    [[nodiscard]] VirtualWorld& world() noexcept { return machine_->world; }
    [[nodiscard]] os::Clock& clock() noexcept { return clock_; }
    [[nodiscard]] Time now() noexcept { return clock_.now(); }

private:
    struct Machine {
        Machine(const AcceptedMachine& accepted, os::Clock& clock) : instance{accepted, clock} {}
        MachineInstance instance;
        VirtualWorld world{instance};
    };
    std::expected<void, Sentence> start_machine();

    os::Clock clock_{os::Clock::Kind::virtual_time};
    AcceptedMachine accepted_;
    SimulatedDevices devices_;
    PropertyFiles files_{""};
    std::string_view browsed_in_{};
    std::optional<Machine> machine_;
    std::optional<std::uint64_t> timed_by_{};
    std::uint64_t seen_steps_ = 0;
    std::function<void(Time now)> look_{};
};

/// Real time: the machine in its threads, the plant in one more.
class RealRun {
public:
    RealRun(const AcceptedMachine& machine, Plant& plant, std::uint64_t seed);
    ~RealRun();
    RealRun(const RealRun&) = delete;
    RealRun& operator=(const RealRun&) = delete;

    /// As VirtualRun's.
    void keep_properties_in(std::string_view directory) noexcept { files_.keep_in(directory); }
    [[nodiscard]] MachineInstance& instance() noexcept { return instance_; }
    /// Opens the twins, configures, arms and starts. What arming found is printed on `file`. An error is the
    /// first refusal.
    std::expected<void, Sentence> start(int file);
    /// Sleeps; false: a stop is asked for, or a signal asks to end.
    bool supervise(Duration time) { return world_.supervise(time); }
    /// As SimulatedDevices::is_done() said after the plant's last move.
    [[nodiscard]] bool is_done() const noexcept { return done_.load(std::memory_order_acquire); }
    /// The machine first, then the plant, which has `coming_to_rest` for its last moves. How many threads of
    /// the machine hung.
    int stop();

    [[nodiscard]] RealWorld& world() noexcept { return world_; }
    /// After stop(): they are the plant's thread's until then.
    [[nodiscard]] SimulatedDevices& devices() noexcept { return devices_; }

    static constexpr Duration coming_to_rest = 300ms;

private:
    /// The plant looks at its wires this often at least: what the machine does reaches it so late at most.
    static constexpr Duration plant_period = 200us;
    /// Below every activity of the machine, above the developer's other work, which would let frames come
    /// late.
    static constexpr int plant_priority = 1;

    static void live(void* self) noexcept;
    void follow();

    os::Clock clock_{os::Clock::Kind::real};
    SimulatedDevices devices_;
    PropertyFiles files_{""};
    MachineInstance instance_;
    RealWorld world_;
    bool running_ = false;

    alignas(4096) std::array<std::byte, 256 * 1024> plant_stack_{};
    os::ThreadPlan plant_plan_{};
    os::Waiter plant_waiter_{};
    std::atomic<bool> plant_ends_{false};
    std::atomic<bool> done_{false};
    os::Thread plant_thread_{};
};

/// The host's program of a machine. Makes the plant for the seed of its command line. The exit code: 0 well,
/// 1 it ended otherwise, 2 a wrong set-up.
[[nodiscard]] int run_host(const AcceptedMachine& machine,
                           const std::function<std::unique_ptr<Plant>(std::uint64_t seed)>& make_plant,
                           int count, char** words, const HostHooks& hooks = {});

} // namespace tappet
