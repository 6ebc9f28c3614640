// A device of the box: how the machine opens it at start-up, and how a guardian makes it safe after the
// machine's process has ended. A driver implements it for its kind.
#pragma once

#include "kernel/component/device_traffic.hpp"
#include "kernel/component/setup.hpp"
#include "kernel/component/wire_counters.hpp"
#include "kernel/os/arming.hpp"

#include <expected>

namespace tappet {

/// The place to which a driver's row is bound; the table's check has found all of it.
struct DevicePlace {
    std::string_view address{};    ///< the name in Linux: "can0"; or an address: "192.168.7.2:502"
    bool is_on_board = true;       ///< false: it is reached only by that address
    std::span<const Fact> bound{}; ///< facts of the binding about it
    std::span<const Fact> of_board{};
    const void* map = nullptr; ///< the driver's `device_map`
    DeviceTraffic traffic{};   ///< the driver's `device_traffic`
    DeviceUse use{};           ///< without a name: nothing is proven about it
};

/// A call between the steps of an operation that may take long.
struct Meanwhile {
    void* context = nullptr;
    void (*call)(void* context) noexcept = nullptr;
    void operator()() const noexcept {
        if (call != nullptr) call(context);
    }
};

/// The base of a driver's device. Not real-time. A device without outputs need not override the functions
/// that make it safe.
class RealDevice {
public:
    RealDevice() = default;
    RealDevice(const RealDevice&) = delete;
    RealDevice& operator=(const RealDevice&) = delete;
    virtual ~RealDevice() = default;

    /// Opens the device. The error says what is wrong and how to cure it, but does not name the device.
    virtual std::expected<void, Sentence> open(const DevicePlace& place) = 0;
    /// Returns the device for the driver's Setup::device().
    [[nodiscard]] virtual ProvidedDevice provided(std::string_view name) noexcept = 0;
    /// Reports what open() found and which peers answer. It may take a server's time-out.
    virtual void report(os::ArmingReport&, std::string_view /*name*/) {}
    virtual void count(WireCounters&) const noexcept {}

    // ---- for the guardian, whose process is a copy of the machine's from before it armed

    /// Returns an open descriptor that the guardian keeps; -1: it needs none.
    [[nodiscard]] virtual int kept_by_guardian() const noexcept { return -1; }
    /// Opens the guardian's own resources, and rehearses: nothing has moved, and every output has its safe
    /// value. Nothing leaves the box. The error names the device and the cure.
    virtual std::expected<void, Sentence> prepare_safe_ending() { return {}; }
    /// Writes the safe values of outputs that act at once. Returns false when that failed.
    virtual bool write_safe_lines() noexcept { return true; }
    /// Starts to send safe values, which are confirmed later: from here on all must be confirmed again.
    virtual void begin_safe_frames() noexcept {}
    /// Sends the frames that are due, and lost ones again. Called every few milliseconds.
    virtual void send_safe_frames() noexcept {}
    /// Returns how many are not confirmed.
    [[nodiscard]] virtual std::size_t safe_frames_left() noexcept { return 0; }
    /// Returns whether it has outputs that are made safe by requests, which wait for their answers.
    [[nodiscard]] virtual bool has_safe_requests() const noexcept { return false; }
    /// Sends the requests until each was confirmed, or until `end`. Returns whether all were confirmed. On a
    /// thread of its own if the box has one to spare. `meanwhile` is called at least every 50 ms; without
    /// such a thread, between two requests.
    virtual bool make_safe_requests(Time /*end*/, const Meanwhile&) noexcept { return true; }
};

} // namespace tappet
