// A device of the box: how it is opened when the machine starts, and how a guardian makes it safe when the
// machine's process is no more. A driver implements it for its kind.
#pragma once

#include "kernel/component/device_traffic.hpp"
#include "kernel/component/setup.hpp"
#include "kernel/component/wire_counters.hpp"
#include "kernel/os/arming.hpp"

#include <expected>

namespace tappet {

/// What a driver's row is bound to; the table's check has found all of it.
struct DevicePlace {
    std::string_view address{};    ///< where Linux has it: "can0"; or an address: "192.168.7.2:502"
    bool is_on_board = true;       ///< false: it is reached by that address alone
    std::span<const Fact> bound{}; ///< what the binding says of it
    std::span<const Fact> of_board{};
    const void* map = nullptr; ///< the driver's `device_map`
    DeviceTraffic traffic{};   ///< the driver's `device_traffic`
    DeviceUse use{};           ///< without a name: nothing is proven of it
};

/// Called between the steps of what may take long.
struct Meanwhile {
    void* context = nullptr;
    void (*call)(void* context) noexcept = nullptr;
    void operator()() const noexcept {
        if (call != nullptr) call(context);
    }
};

/// Not real-time. A device that drives nothing overrides nothing of what makes safe.
class RealDevice {
public:
    RealDevice() = default;
    RealDevice(const RealDevice&) = delete;
    RealDevice& operator=(const RealDevice&) = delete;
    virtual ~RealDevice() = default;

    /// The error says what is wrong and how to cure it, not which device it is.
    virtual std::expected<void, Sentence> open(const DevicePlace& place) = 0;
    /// For the driver's Setup::device().
    [[nodiscard]] virtual ProvidedDevice provided(std::string_view name) noexcept = 0;
    /// What open() found and who answers. It may take a server's time-out.
    virtual void report(os::ArmingReport&, std::string_view /*name*/) {}
    virtual void count(WireCounters&) const noexcept {}

    // ---- the guardian's, whose process is a copy of the machine's from before it armed

    /// A descriptor of those that were opened; -1: the guardian needs none.
    [[nodiscard]] virtual int kept_by_guardian() const noexcept { return -1; }
    /// Opens what the guardian needs for itself, and rehearses: nothing has moved, and every output has its
    /// safe value. Nothing leaves the box. The error names the device and the cure.
    virtual std::expected<void, Sentence> prepare_safe_ending() { return {}; }
    /// Of outputs that take their safe values at once: false when they did not.
    virtual bool write_safe_lines() noexcept { return true; }
    /// Of what is sent, and confirmed later: from here on all of it is wanted anew.
    virtual void begin_safe_frames() noexcept {}
    /// Sends what is due, and again what was lost. Called every few milliseconds.
    virtual void send_safe_frames() noexcept {}
    /// How many are not confirmed.
    [[nodiscard]] virtual std::size_t safe_frames_left() noexcept { return 0; }
    /// Whether it has outputs that are made safe by requests, which wait for their answers.
    [[nodiscard]] virtual bool has_safe_requests() const noexcept { return false; }
    /// Until each of them was confirmed, or that time: whether they are. On a thread of its own where the box
    /// has one to give. `meanwhile` is called at least every 50 ms, without a thread between two requests.
    virtual bool make_safe_requests(Time /*end*/, const Meanwhile&) noexcept { return true; }
};

} // namespace tappet
