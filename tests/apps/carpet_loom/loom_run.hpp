// The carpet loom and its plant under virtual time, quiet, as tests run it.
#pragma once

#include "apps/carpet_loom/console.hpp"
#include "apps/carpet_loom/plant.hpp"
#include "toolchain/machine/host.hpp"

namespace tappet::carpet {

AcceptedMachine on_host();

class LoomRun {
public:
    LoomRun(const loom::Settings& settings, std::uint64_t seed)
        : plant_{settings, seed}, run_{on_host(), plant_, seed} {}

    std::expected<void, Sentence> start() { return silence(run_.start()); }
    /// Starts a new machine at the same plant.
    std::expected<void, Sentence> start_again() { return silence(run_.start_again()); }
    bool run_for(Duration time) { return run_.run_for(time); }
    /// Runs until the plant has woven `picks` and stands, or `limit` has passed. Returns true when they were
    /// woven.
    bool weave(std::uint64_t picks, Duration limit) {
        for (const Time end = run_.now() + limit; run_.now() < end && !instance().stop_asked();) {
            run_for(50ms);
            if (plant_.has_woven(picks)) return true;
        }
        return false;
    }
    void stop() { run_.stop(); }

    [[nodiscard]] MachineInstance& instance() { return run_.instance(); }
    [[nodiscard]] VirtualWorld& world() { return run_.world(); }
    [[nodiscard]] Time now() { return run_.now(); }
    [[nodiscard]] loom::Plant& plant() { return plant_.loom(); }
    [[nodiscard]] SimulatedDevices& devices() { return run_.devices(); }
    [[nodiscard]] std::uint64_t event_log_digest() { return digest_of(instance(), plant_); }

private:
    std::expected<void, Sentence> silence(std::expected<void, Sentence> started) {
        if (started) instance().find<Console>("console")->quiet.set(true);
        return started;
    }

    Plant plant_;
    VirtualRun run_;
};

} // namespace tappet::carpet
