// The car tracker and its room under virtual time, with the record of the run.
#pragma once

#include "apps/car_tracking/plant.hpp"
#include "toolchain/machine/host.hpp"

namespace tappet::car_tracking {

AcceptedMachine on_host();

class CarRun {
public:
    /// `machine`: the car tracker, or a variant that executes its behaviour differently.
    explicit CarRun(std::uint64_t seed, const AcceptedMachine& machine = on_host())
        : plant_{seed}, run_{machine, plant_, seed} {}

    std::expected<void, Sentence> start() { return run_.start(); }
    /// Returns false when the machine asked to stop.
    bool run_for(Duration time) {
        for (const Time end = run_.now() + time; run_.now() < end; look())
            if (!run_.run_for(std::min(end - run_.now(), Record::every))) return false;
        return true;
    }
    void stop() {
        run_.stop();
        look();
    }
    [[nodiscard]] const std::vector<Moment>& moments() const { return plant_.record.moments(); }
    [[nodiscard]] const std::vector<Look>& looks() const { return plant_.record.looks(); }
    [[nodiscard]] std::string_view state() { return state_of(instance(), "tracking"); }
    [[nodiscard]] Scene& scene() { return plant_.scene; }
    [[nodiscard]] MachineInstance& instance() { return run_.instance(); }
    /// Digest of everything that happened, in machine and room.
    [[nodiscard]] std::uint64_t digest() {
        Digest digest;
        digest.add(instance().observation().event_log_digest());
        plant_.record.add_to(digest);
        return digest.value();
    }

private:
    void look() { plant_.record.look(instance(), plant_.scene, run_.now()); }

    Plant plant_;
    VirtualRun run_;
};

} // namespace tappet::car_tracking
