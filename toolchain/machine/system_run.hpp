// Several machines on one wire, in one process and one thread. Each has its own virtual clock, slightly
// faster or slower than true time; frames take their bit times. One seed gives one run.
#pragma once

#include "drivers/can/twin_bus.hpp"
#include "kernel/system/rows.hpp"
#include "toolchain/machine/host.hpp"

#include <chrono>
#include <memory>
#include <vector>

namespace tappet {

/// How one machine's clock relates to the wire's true time: local = true + offset, plus `drift_ppm` of the
/// true time.
struct ClockFault {
    Duration offset{};
    double drift_ppm = 0;

    [[nodiscard]] Time local(Time true_time) const noexcept TAPPET_REALTIME;
    [[nodiscard]] Time true_time(Time local) const noexcept TAPPET_REALTIME;
};

/// A machine's end of the wire, in the machine's own time, with the faults of this end alone (CAN's
/// inconsistent omission and duplicates).
class WireEnd final : public can::Device {
public:
    WireEnd(can::Twin& twin, const ClockFault& clock, std::uint64_t seed)
        : twin_{twin}, clock_{clock}, random_{seed}, seed_{seed} {}

    can::Receive receive(can::Frame& frame) noexcept TAPPET_REALTIME override;
    can::Send send(const can::Frame& frame, can::Keep keep) noexcept TAPPET_REALTIME override;
    void service(Time now) noexcept TAPPET_REALTIME override { twin_.service(clock_.true_time(now)); }
    bool finish(Time now) noexcept TAPPET_REALTIME override { return twin_.finish(clock_.true_time(now)); }
    [[nodiscard]] Time next_service() const noexcept TAPPET_REALTIME override;
    [[nodiscard]] can::State state() const noexcept TAPPET_REALTIME override { return twin_.state(); }
    [[nodiscard]] can::Counters counters() const noexcept TAPPET_REALTIME override {
        return twin_.counters();
    }
    [[nodiscard]] Duration longest_response(can::Identifier of) const noexcept TAPPET_REALTIME override {
        return twin_.longest_response(of);
    }
    [[nodiscard]] can::Confirmation last_confirmed(can::Identifier of) const noexcept
        TAPPET_REALTIME override;
    void purge() noexcept TAPPET_REALTIME override { twin_.purge(); }
    can::Restart restart() noexcept override { return twin_.restart(); }
    [[nodiscard]] bool wakes(os::Waiter& waiter) noexcept override { return twin_.wakes(waiter); }

    std::uint32_t omits_one_in = 0, doubles_one_in = 0;
    /// Received and confirmed frames are stamped up to this much too late.
    Duration stamps_late{};
    /// Nothing passes: the cable is cut on this side of the node.
    bool is_cut = false;

private:
    can::Twin& twin_;
    const ClockFault& clock_;
    [[nodiscard]] Duration lateness(Time of) const noexcept TAPPET_REALTIME;

    Random random_;
    std::uint64_t seed_;
    can::Frame again_{};
    bool has_again_ = false;
};

/// Not real-time.
class SystemRun {
public:
    /// `machines`: of the system's nodes, in their order. `plants`: the plants at their other wires; null:
    /// none.
    SystemRun(const SystemView& system, std::span<const AcceptedMachine> machines,
              std::span<Plant* const> plants, std::uint64_t seed);

    /// Call before start(): each machine has a socket for browsers there. True time then passes at the pace
    /// of the host's clock, for people who watch. The characters must outlive the run.
    void browse_in(std::string_view directory);
    /// Call before start().
    void set_clock(std::size_t node, const ClockFault& fault) { nodes_[node]->clock = fault; }
    std::expected<void, Sentence> start();
    std::expected<void, Sentence> start(std::size_t node);
    /// Ends the node's process without warning; its outputs stay as they are.
    void kill(std::size_t node) { nodes_[node]->is_alive = false; }
    /// Stops the node in order.
    void stop(std::size_t node);
    void stop();
    [[nodiscard]] bool is_alive(std::size_t node) const { return nodes_[node]->is_alive; }
    /// Runs for `time`. Returns false when a machine asked to stop, or could not continue; see faulted().
    bool run_for(Duration time);
    bool run_until(const std::function<bool()>& done, Duration limit);
    /// Sets a function that is called whenever time has moved: for judges that check every moment.
    void judge_by(std::function<void(Time now)> look) { look_ = std::move(look); }

    [[nodiscard]] Time now() const { return now_; } ///< the true time
    [[nodiscard]] can::TwinBus& wire() { return wire_; }
    [[nodiscard]] can::Twin& twin(std::size_t node) { return nodes_[node]->twin; }
    [[nodiscard]] WireEnd& end(std::size_t node) { return nodes_[node]->end; }
    [[nodiscard]] MachineInstance& instance(std::size_t node) { return nodes_[node]->run.instance(); }
    [[nodiscard]] VirtualRun& run(std::size_t node) { return nodes_[node]->run; }
    [[nodiscard]] std::uint64_t digest();

private:
    struct NoPlant final : Plant {
        Time move(Time) override { return never; }
    };
    struct Node {
        Node(const AcceptedMachine& machine, Plant* plant, std::uint64_t seed)
            : accepted{machine},
              end{twin, clock, seed},
              run{machine, plant == nullptr ? none : *plant, seed} {}
        AcceptedMachine accepted;
        NoPlant none{};
        ClockFault clock{};
        can::Twin twin{};
        WireEnd end;
        VirtualRun run;
        bool is_alive = false, was_started = false;
    };
    [[nodiscard]] Time next() const;

    SystemView system_;
    can::TwinBus wire_;
    std::vector<std::unique_ptr<Node>> nodes_{};
    void keep_pace();

    Time now_{};
    bool has_pace_ = false;
    Time began_at_{};
    std::chrono::steady_clock::time_point began_{};
    std::function<void(Time now)> look_{};
};

} // namespace tappet
