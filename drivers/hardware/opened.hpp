// The real devices of one machine: opened at the binding's places, and made safe together by its guardian.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/component/real_device.hpp"
#include "kernel/os/thread.hpp"

#include <span>

namespace tappet {

/// Returns the place of a driver row's device, by an accepted binding.
[[nodiscard]] DevicePlace place_of(const ComponentRow& row, const Board& board,
                                   const Binding& binding) noexcept;

/// One opened device, in the order of the table.
struct OpenedDevice {
    RealDevice* device = nullptr;
    std::string_view name{}; ///< its name in the table
    // For a device with safe requests: the thread that sends them.
    bool is_safe = false;
    Time end{};
    os::ThreadPlan plan{};
    os::Thread thread{};
};

/// Sends the frames of all devices until all are confirmed, at most for `within`; returns how many are not.
std::size_t send_safe_frames(std::span<OpenedDevice> devices, Duration within) noexcept;
/// Sends the safe requests of all devices at the same time, each until it is safe or `within` has passed.
/// Returns the number of devices not safe. A dead device delays no other one, unless the box refuses a
/// thread: such devices share the time. Calls `meanwhile` at least every 50 ms; without a thread, between two
/// requests.
std::size_t make_safe_requests(std::span<OpenedDevice> devices, Duration within,
                               const Meanwhile& meanwhile) noexcept;

/// Not real-time.
class OpenedDevices : public GuardedDevices {
public:
    std::expected<void, Sentence> open(const AcceptedMachine& machine) override;
    [[nodiscard]] std::span<const ProvidedDevice> provided() const noexcept override {
        return provided_.first(used_);
    }
    void report(os::ArmingReport& report) override;
    [[nodiscard]] WireCounters counters() const noexcept override;

    [[nodiscard]] Bounded<int, 16> kept_by_guardian() const noexcept override;
    std::expected<void, Sentence> prepare_safe_ending() override;
    std::size_t write_safe_lines() noexcept override;
    std::size_t send_safe_frames(Duration within) noexcept override {
        return tappet::send_safe_frames(opened(), within);
    }
    std::size_t write_safe_registers(Duration within, const Meanwhile& meanwhile) noexcept override {
        return make_safe_requests(opened(), within, meanwhile);
    }

protected:
    /// The rooms have an entry for each device of the table.
    OpenedDevices(std::span<OpenedDevice> room, std::span<ProvidedDevice> provided) noexcept
        : room_{room}, provided_{provided} {}
    /// Returns an unused device of that kind; null for a kind that is unknown here.
    [[nodiscard]] virtual RealDevice* take(const DeviceKind& kind) noexcept = 0;
    virtual void give_back_all() noexcept = 0;

private:
    [[nodiscard]] std::span<OpenedDevice> opened() const noexcept { return room_.first(used_); }

    std::span<OpenedDevice> room_;
    std::span<ProvidedDevice> provided_;
    std::size_t used_ = 0;
};

} // namespace tappet
