// Several machines on one wire in one process and one thread: each under a virtual clock of its own, which
// goes a little faster or slower than the true one; frames take their bit times. One seed, one run.
#pragma once

#include "drivers/can/twin_bus.hpp"
#include "kernel/system/rows.hpp"
#include "toolchain/machine/host.hpp"

#include <chrono>
#include <memory>
#include <vector>

namespace tappet {

/// How one machine's clock shows the true time, which the wire has: local = true + offset, and `drift_ppm` of
/// the true time more.
struct ClockFault {
    Duration offset{};
    double drift_ppm = 0;

    [[nodiscard]] Time local(Time true_time) const noexcept TAPPET_REALTIME;
    [[nodiscard]] Time true_time(Time local) const noexcept TAPPET_REALTIME;
};

/// A machine's end of the wire, in the machine's own time; and what strikes this end alone (CAN's
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
    /// What arrives and what is confirmed is stamped up to so much later than it was through.
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
    /// `machines`: of the system's nodes, in their order. `plants`: what stands at their other wires; null:
    /// nothing.
    SystemRun(const SystemView& system, std::span<const AcceptedMachine> machines,
              std::span<Plant* const> plants, std::uint64_t seed);

    /// Before start(): each machine has a socket for browsers there. True time then goes at the pace of the
    /// host's clock, which is what people see. The characters outlive the run.
    void browse_in(std::string_view directory);
    /// Before start().
    void set_clock(std::size_t node, const ClockFault& fault) { nodes_[node]->clock = fault; }
    std::expected<void, Sentence> start();
    std::expected<void, Sentence> start(std::size_t node);
    /// The process of the node is gone, without a word; its outputs stay as they are.
    void kill(std::size_t node) { nodes_[node]->is_alive = false; }
    /// It ends in order.
    void stop(std::size_t node);
    void stop();
    [[nodiscard]] bool is_alive(std::size_t node) const { return nodes_[node]->is_alive; }
    /// False: a machine asked to stop, or could not go on; see faulted().
    bool run_for(Duration time);
    bool run_until(const std::function<bool()>& done, Duration limit);
    /// Called whenever time has moved: for who judges every moment.
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
