// The devices of one machine in the host world: a twin for each device of its table, and the wires between it
// and the plant.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "drivers/plant/can_log.hpp"
#include "drivers/plant/plant.hpp"
#include "drivers/plant/simulated_kinds.hpp"

#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace tappet {

/// Not real-time. The machine's threads and the plant's share only the twins.
class SimulatedDevices final : public Devices {
public:
    /// `seed` selects what the faults of the twins strike.
    explicit SimulatedDevices(Plant& plant, std::uint64_t seed) : plant_{plant}, seed_{seed} {}

    /// Before open(): sets the bit rates, by which frames take time on the wire; 0: no time.
    void set_bit_rates(can::BitRates rates) noexcept { bit_rates_ = rates; }
    std::expected<void, Sentence> open(const AcceptedMachine& machine) override;
    /// Before open(): adds a device that is simulated elsewhere, such as a wire to other machines.
    void lend(const ProvidedDevice& device) { lent_.push_back(device); }
    /// Before open(): records each CAN bus as a candump log in that folder.
    void record_can(std::string folder) { recorded_in_ = std::move(folder); }
    /// Before open(): replays that candump log in place of the plant's frames on the bus. Its first frame
    /// comes `begins_at` after the start.
    void replay_can(std::string bus, std::string file, Duration begins_at = {}) {
        replays_.push_back({std::move(bus), std::move(file), begins_at});
    }
    /// Returns whether each replayed log is at its end; without replays, whether the plant is done.
    [[nodiscard]] bool is_done() const;
    /// After open(): calls `look` for each frame on a CAN bus, to judge what a machine sends.
    using Look = std::function<void(std::string_view bus, const can::Frame& frame)>;
    void look_at_frames(Look look);
    /// At the end, once: reports the result of each log. Returns false when one was not written or read.
    [[nodiscard]] bool close_logs(const std::function<void(const Sentence& what, bool good)>& tell);
    [[nodiscard]] CanReplay::Counts replayed(std::string_view bus);
    /// Opens the machine's ends of the buses again, as for a new process: a bus that was off is on again.
    /// Lines keep their state.
    std::expected<void, Sentence> open_again();
    /// The guardian's work for a machine whose process has ended: lines at once, frames and registers after
    /// the process's end. The machine's ends of the wires are then unused.
    void write_safe_lines() noexcept;
    void send_safe_frames(Time now) noexcept;
    void write_safe_registers() noexcept;
    [[nodiscard]] std::span<const ProvidedDevice> provided() const noexcept override { return provided_; }
    void report(os::ArmingReport&) override {}
    [[nodiscard]] WireCounters counters() const noexcept override;

    /// Advances plant and wires to `now`. Only the plant's thread.
    void advance(Time now);
    /// Returns whether the machine used its wires since advance(), or a twin holds something back.
    [[nodiscard]] bool are_driven() const noexcept;
    /// After advance(): skips ahead; nothing comes from the machine before `until`.
    void leap(Time until);
    /// Returns when advance() is due.
    [[nodiscard]] Time next() const noexcept { return next_; }

    // ---- for a swarm, after open(). A device that is not judged has no outputs, and nothing strikes it.
    [[nodiscard]] static bool is_judged(const ComponentRow& driver) noexcept;
    [[nodiscard]] std::vector<WireOutput> outputs(std::string_view device) const;
    [[nodiscard]] TwinFault strike(std::string_view device, Random& random, Time now, bool with_any_values);
    /// Returns what was wrong with something that the machine has sent; empty: nothing.
    [[nodiscard]] Sentence broken() const;
    [[nodiscard]] bool is_off(std::string_view device) const noexcept;
    void repair_all();

    // ---- for tests: fault injection at one device. A name that is not in the table is a broken contract.
    [[nodiscard]] can::TwinBus& bus(std::string_view device);
    [[nodiscard]] can::Twin& controller(std::string_view device);
    [[nodiscard]] gpio::Twin& lines(std::string_view device);
    [[nodiscard]] modbus::Twin& server(std::string_view device);

private:
    // A twin's addresses must not change, hence the pointers.
    template <class... Kind>
    using Lists = std::tuple<std::vector<std::unique_ptr<Kind>>...>;
    /// The recording and the replay of a bus.
    struct Log {
        explicit Log(can::SimulatedBus& of) : bus{of} {}
        can::SimulatedBus& bus;
        std::unique_ptr<can::TwinBus::Tap> tap{};
        std::unique_ptr<CanRecorder> recorder{};
        std::unique_ptr<CanReplay> replay{};
        void begin();
        void drain(Time now, const Look& look);
    };
    struct Replay {
        std::string bus, file;
        Duration begins_at;
    };
    template <class Kind>
    std::expected<void, Sentence> add(const ComponentRow& row, std::vector<ProvidedDevice>& plants_ends);
    template <class Kind>
    [[nodiscard]] Kind& named(std::string_view device);
    [[nodiscard]] auto& buses() { return std::get<std::vector<std::unique_ptr<can::SimulatedBus>>>(kinds_); }
    Sentence open_logs();
    [[nodiscard]] Time next_on_wires();

    Plant& plant_;
    std::uint64_t seed_;
    can::BitRates bit_rates_{};
    std::string recorded_in_{};
    std::vector<Replay> replays_{};
    Look look_{};
    Time next_{};
    SimulatedKinds<Lists> kinds_{};
    std::vector<Log> logs_{}; // one for each bus
    std::vector<ProvidedDevice> lent_{};
    std::vector<ProvidedDevice> provided_{};
};

} // namespace tappet
