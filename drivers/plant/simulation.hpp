// The devices of one machine in the host world: a twin for each that its table names, and the wires between
// it and the plant.
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

/// Not real-time. The machine's threads and the plant's meet in the twins only.
class SimulatedDevices final : public Devices {
public:
    /// `seed` decides what the faults of the twins strike.
    explicit SimulatedDevices(Plant& plant, std::uint64_t seed) : plant_{plant}, seed_{seed} {}

    /// Before open(): frames take their time on the wire; 0: none.
    void set_bit_rates(can::BitRates rates) noexcept { bit_rates_ = rates; }
    std::expected<void, Sentence> open(const AcceptedMachine& machine) override;
    /// Before open(): a device that somebody else simulates, as a wire to other machines.
    void lend(const ProvidedDevice& device) { lent_.push_back(device); }
    /// Before open(): what is on each CAN bus goes to a candump log in that folder.
    void record_can(std::string folder) { recorded_in_ = std::move(folder); }
    /// Before open(): that candump log in place of what the plant sends on the bus. Its first frame comes so
    /// long after the beginning.
    void replay_can(std::string bus, std::string file, Duration begins_at = {}) {
        replays_.push_back({std::move(bus), std::move(file), begins_at});
    }
    /// Each log that is replayed is at its end; without any, the plant says it.
    [[nodiscard]] bool is_done() const;
    /// After open(): told each frame that was on a CAN bus. For who judges what a machine sends.
    using Look = std::function<void(std::string_view bus, const can::Frame& frame)>;
    void look_at_frames(Look look);
    /// At the end, once: what became of each log. False: one of them could not be written, or read.
    [[nodiscard]] bool close_logs(const std::function<void(const Sentence& what, bool good)>& tell);
    [[nodiscard]] CanReplay::Counts replayed(std::string_view bus);
    /// The machine's ends of the buses anew, as a new process has them: a bus that was off is on again. Lines
    /// stay as they were left.
    std::expected<void, Sentence> open_again();
    /// What the guardian of a machine does whose process is gone: lines at once, frames and registers once it
    /// has ended. The machine's ends of the wires are nobody's then.
    void write_safe_lines() noexcept;
    void send_safe_frames(Time now) noexcept;
    void write_safe_registers() noexcept;
    [[nodiscard]] std::span<const ProvidedDevice> provided() const noexcept override { return provided_; }
    void report(os::ArmingReport&) override {}
    [[nodiscard]] WireCounters counters() const noexcept override;

    /// Moves plant and wires to `now`. One thread, the plant's.
    void advance(Time now);
    /// Whether the machine has put anything on its wires since advance(), or a twin holds something back.
    [[nodiscard]] bool are_driven() const noexcept;
    /// After advance(): nothing comes from the machine before `until`.
    void leap(Time until);
    /// When advance() has something to do.
    [[nodiscard]] Time next() const noexcept { return next_; }

    // ---- for tests: what goes wrong at one device. A name that the table has not is a broken contract.
    [[nodiscard]] can::TwinBus& bus(std::string_view device);
    [[nodiscard]] can::Twin& controller(std::string_view device);
    [[nodiscard]] gpio::Twin& lines(std::string_view device);
    [[nodiscard]] modbus::Twin& server(std::string_view device);

private:
    // What a twin is given stays where it is.
    template <class... Kind>
    using Lists = std::tuple<std::vector<std::unique_ptr<Kind>>...>;
    /// What is recorded of a bus, and replayed on it.
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
