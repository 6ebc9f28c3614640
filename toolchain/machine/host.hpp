// A machine and its plant in one process, under virtual or real time: for every machine's host program, and
// for a machine's tests.
#pragma once

#include "drivers/plant/simulation.hpp"
#include "kernel/machine/worlds/real_world.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"
#include "kernel/services/configuration/property_files.hpp"
#include "toolchain/machine/host_hooks.hpp"

#include <array>
#include <atomic>
#include <expected>
#include <functional>
#include <optional>

namespace tappet {

/// Returns a digest of everything that happened, in machine and plant.
[[nodiscard]] std::uint64_t digest_of(const MachineInstance& instance, const Plant& plant);

/// Virtual time: one thread, the same run for the same seed. Must live as long as the run; one at a time,
/// because the machine's memory is static.
class VirtualRun {
public:
    VirtualRun(const AcceptedMachine& machine, Plant& plant, std::uint64_t seed);

    /// Call before start(): sets the directory from which rows with a properties file read their values.
    /// Default: none, so that a run depends on its seed alone. The characters must outlive the run.
    void keep_properties_in(std::string_view directory) noexcept { files_.keep_in(directory); }
    /// Call before start(): each machine listens to browsers there. The characters must outlive the run.
    void browse_in(std::string_view directory) noexcept { browsed_in_ = directory; }
    /// Call before start(): cycles take times that the seed draws, up to their budgets, and frames take bit
    /// times.
    void take_times(std::uint64_t seed, can::BitRates rates) {
        timed_by_ = seed;
        devices_.set_bit_rates(rates);
    }
    [[nodiscard]] MachineInstance& instance() noexcept { return machine_->instance; }
    /// Opens the twins, configures and starts. The error is the first refusal.
    std::expected<void, Sentence> start();
    /// Starts a new machine at the same plant, which keeps its state. The old one is gone, stopped or not.
    std::expected<void, Sentence> start_again();
    /// Sets a function that is called whenever the plant has moved, which is after each step of the machine:
    /// for judges that check every moment.
    void judge_by(std::function<void(Time now)> look) { look_ = std::move(look); }
    /// Runs for `time`. Returns false when the machine asked to stop.
    bool run_for(Duration time) { return machine_->world.run_until(clock_.now() + time); }
    /// Runs until `done`, checked each millisecond. False: `limit` has passed, or the machine asked to stop.
    bool run_until(const std::function<bool()>& done, Duration limit);
    /// Stops the machine and saves its properties if keep_properties_in() named a directory. Tells which
    /// real-time code used the heap, a lock or the system meanwhile, if the program links tappet_host_watch.
    void stop();
    /// Returns why stop() could not save the properties; empty: they are saved, or none are kept.
    [[nodiscard]] const Sentence& unsaved() const noexcept { return unsaved_; }

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
    void watch_real_time_code();

    os::Clock clock_{os::Clock::Kind::virtual_time};
    AcceptedMachine accepted_;
    SimulatedDevices devices_;
    PropertyFiles files_{""};
    std::string_view browsed_in_{};
    std::optional<Machine> machine_;
    std::optional<std::uint64_t> timed_by_{};
    std::array<bool, max_activities> watched_{};
    Sentence unsaved_{};
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

    /// As in VirtualRun.
    void keep_properties_in(std::string_view directory) noexcept { files_.keep_in(directory); }
    [[nodiscard]] MachineInstance& instance() noexcept { return instance_; }
    /// Opens the twins, configures, arms and starts. Prints the results of arming to `file`. The error is the
    /// first refusal.
    std::expected<void, Sentence> start(int file);
    /// Sleeps for `time`. Returns false when a stop is requested, or a signal asks to end.
    bool supervise(Duration time) { return world_.supervise(time); }
    /// Returns SimulatedDevices::is_done() as of the plant's last move.
    [[nodiscard]] bool is_done() const noexcept { return done_.load(std::memory_order_acquire); }
    /// Stops the machine first, then the plant, which has `coming_to_rest` for its last moves, then saves the
    /// properties. Returns how many threads of the machine hung.
    int stop();
    /// As in VirtualRun.
    [[nodiscard]] const Sentence& unsaved() const noexcept { return unsaved_; }

    [[nodiscard]] RealWorld& world() noexcept { return world_; }
    /// Call only after stop(): until then the plant's thread owns them.
    [[nodiscard]] SimulatedDevices& devices() noexcept { return devices_; }

    static constexpr Duration coming_to_rest = 300ms;

private:
    /// The plant polls its wires at least this often: a change by the machine reaches it at most this late.
    static constexpr Duration plant_period = 200us;
    /// Below every activity of the machine, above the developer's other work, which would delay frames.
    static constexpr int plant_priority = 1;

    static void live(void* self) noexcept;
    void follow();

    os::Clock clock_{os::Clock::Kind::real};
    SimulatedDevices devices_;
    PropertyFiles files_{""};
    Sentence unsaved_{};
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

/// The host's program of a machine. `make_plant` gets the seed of the command line. Exit code: 0 well, 1 it
/// ended otherwise, 2 a wrong set-up.
[[nodiscard]] int run_host(const AcceptedMachine& machine,
                           const std::function<std::unique_ptr<Plant>(std::uint64_t seed)>& make_plant,
                           int count, char** words, const HostHooks& hooks = {});

} // namespace tappet
