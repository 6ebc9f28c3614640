// A CANopen node at the other end of the wires, for plants: NMT slave, heartbeat, SDO server and PDOs by its
// dictionary and the machine's configuration, with injection of every fault (CiA 301).
#pragma once

#include "drivers/can/frame.hpp"
#include "drivers/canopen/eds.hpp"
#include "drivers/canopen/simulated_objects.hpp"

#include <algorithm>

namespace tappet::canopen {

/// The receiver of a node's frames. Real-time.
class FrameSink {
public:
    FrameSink() = default;
    FrameSink(const FrameSink&) = default;
    FrameSink& operator=(const FrameSink&) = default;
    virtual ~FrameSink() = default;
    /// Sends a frame; its stamp is the time at which the node requests the bus.
    virtual void send(const can::Frame& frame) noexcept TAPPET_REALTIME = 0;
};

/// Starts without power. Real-time; each call takes bounded time.
class SimulatedNode : public SimulatedObjects {
public:
    static constexpr Duration boot_time = 100ms;
    /// The effect of a frame from the machine on the node.
    enum class Heard : std::uint8_t { nothing, process_data, started, reset };

    SimulatedNode(std::uint8_t node, const Dictionary& dictionary, std::span<std::uint64_t> values) noexcept
        TAPPET_REALTIME : SimulatedObjects{node, dictionary, values} {}

    using SimulatedObjects::id;
    /// Lets its clock run fast by this error.
    void set_clock_error(std::int64_t parts_per_million) noexcept TAPPET_REALTIME {
        ppm_ = parts_per_million;
    }
    /// Forgets its whole configuration; sends its boot-up message at that time.
    void power_on(Time boots_at) noexcept TAPPET_REALTIME {
        reset(0x1000, 0xFFFF);
        begin(boots_at);
    }
    /// Fault: the node becomes silent.
    void power_off() noexcept TAPPET_REALTIME {
        stop_work(NmtState::boot_up);
        boots_at_ = never;
        is_on_ = false;
    }
    /// Fault: its cable is broken, and it does not notice; or it is repaired.
    void cut_off(bool cut) noexcept TAPPET_REALTIME { is_cut_ = cut; }
    /// Fault: it answers no SDO request.
    void mute(bool silent) noexcept TAPPET_REALTIME { is_mute_ = silent; }

    [[nodiscard]] NmtState state() const noexcept TAPPET_REALTIME { return state_; }
    [[nodiscard]] bool alive() const noexcept TAPPET_REALTIME {
        return is_on_ && !is_cut_ && boots_at_ == never;
    }
    [[nodiscard]] bool operational() const noexcept TAPPET_REALTIME {
        return state_ == NmtState::operational;
    }

    /// Returns when tick() is due.
    [[nodiscard]] Time next() const noexcept TAPPET_REALTIME {
        Time next = std::min({boots_at_, beat_at_, master_lost_at_});
        for (const Pdo& pdo : sent_) next = std::min({next, pdo.timer_at, pdo.due});
        return next;
    }
    /// Boots and sends heartbeats. Returns true when process data are due: set the objects, then send_due().
    bool tick(Time now, FrameSink& out) noexcept TAPPET_REALTIME;
    void send_due(FrameSink& out) noexcept TAPPET_REALTIME;
    /// Reports a change in that TPDO (numbers from 0): it is sent if its type sends at events.
    void send_pdo(std::size_t number, Time due, FrameSink& out) noexcept TAPPET_REALTIME;

    /// Returns that TPDO as it would be sent now; without data while the node is not operational.
    [[nodiscard]] can::Frame pdo(std::size_t number) noexcept TAPPET_REALTIME {
        return number < sent_.size() ? pack(sent_[number]) : can::Frame{};
    }

    Heard receive(const can::Frame& frame, Time now, FrameSink& out) noexcept TAPPET_REALTIME;
    /// Sends an emergency message. Code 0: no error is left.
    void send_emergency(std::uint16_t code, std::uint8_t error_register, Time due, FrameSink& out) noexcept
        TAPPET_REALTIME;

private:
    struct Pdo {
        bool valid = false;
        std::uint32_t identifier = 0;
        std::uint8_t type = 255;
        std::uint8_t syncs = 0; ///< since it was last sent
        bool changed = false;   ///< for the next SYNC
        std::uint64_t held = 0; ///< received, without effect before the next SYNC
        Time timer_at = never;
        Duration timer{};
        Time due = never;
        unsigned bits = 0;
        Bounded<std::uint16_t, 8> objects{}; ///< indices in the dictionary
        bool operator==(const Pdo&) const = default;
    };
    using Pdos = std::array<Pdo, predefined_pdos>;

    [[nodiscard]] Duration own(Duration time) const noexcept TAPPET_REALTIME {
        return time + Duration{to_ns(Time{time}) / 1'000'000 * ppm_};
    }
    void begin(Time boots_at) noexcept TAPPET_REALTIME;
    void stop_work(NmtState state) noexcept TAPPET_REALTIME;
    void start_work(Time now) noexcept TAPPET_REALTIME;
    Heard manage(const can::Frame& frame, Time now) noexcept TAPPET_REALTIME;
    void serve(const can::Frame& frame, Time now, FrameSink& out) noexcept TAPPET_REALTIME;
    /// Returns true when commands that waited for SYNC took effect.
    bool synchronise(Time now) noexcept TAPPET_REALTIME;
    void unpack(const Pdo& pdo, std::uint64_t whole) noexcept TAPPET_REALTIME;
    bool take_pdo(const can::Frame& frame, Time now, FrameSink& out) noexcept TAPPET_REALTIME;
    void emit(can::Frame frame, Time due, FrameSink& out) const noexcept TAPPET_REALTIME;
    void read_pdo(Pdo& pdo, std::uint16_t communication, Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] can::Frame pack(const Pdo& pdo) noexcept TAPPET_REALTIME;
    SdoAbort may_write(const Object& object, std::uint64_t bits) noexcept TAPPET_REALTIME override;
    SdoAbort may_map(Address mapping, std::uint64_t bits) const noexcept TAPPET_REALTIME;
    void written(Address at) noexcept TAPPET_REALTIME override;

    bool is_on_ = false;
    bool is_cut_ = false;
    bool is_mute_ = false;
    std::int64_t ppm_ = 0;
    NmtState state_ = NmtState::boot_up;
    Time now_{}; ///< of the request being served
    Time boots_at_ = never;
    Time beat_at_ = never;
    Time master_lost_at_ = never;
    SdoServer server_{};
    Pdos sent_{}, taken_{};
};

/// A simulated node with its own values.
template <const Dictionary& device> class SimulatedDevice : public SimulatedNode {
public:
    explicit SimulatedDevice(std::uint8_t node) noexcept TAPPET_REALTIME
        : SimulatedNode{node, device, own_values_} {
        reset(0x1000, 0xFFFF);
    }
    SimulatedDevice(const SimulatedDevice&) = delete;
    SimulatedDevice& operator=(const SimulatedDevice&) = delete;

private:
    std::array<std::uint64_t, device.objects.size()> own_values_{};
};

} // namespace tappet::canopen
