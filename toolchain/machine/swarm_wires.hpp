// The values that a machine puts on its wires, judged by rules that hold for every machine. Its table tells
// which part drives which output; its maps tell what is safe and what is in range.
#pragma once

#include "drivers/can/signal_map.hpp"
#include "drivers/plant/simulation.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "toolchain/machine/swarm_rules.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tappet {

/// The value on an output's wire when all its writers were stopped while nothing else happened.
struct LeftBehind {
    bool holds = false;                  ///< it keeps its previous value
    std::vector<std::uint64_t> values{}; ///< beside the safe value
};
using AllLeftBehind = std::map<std::string, LeftBehind>; ///< by the names of outputs

/// Must live as long as the run. Not real-time.
class SwarmWires {
public:
    /// `left`: null: not learnt.
    SwarmWires(const AcceptedMachine& machine, SimulatedDevices& devices, const Struck& struck,
               const AllLeftBehind* left = nullptr);

    /// Call after the devices were opened: listens to their traffic.
    void listen();
    /// Starts to judge a new machine that drives the wires.
    void begin(MachineInstance& instance);
    /// Somebody sends a request to the driver itself: until then its outputs follow that request.
    void excuse(std::size_t driver, Time until);
    /// Somebody forces a port: an axis may get any value.
    void excuse_axes(Time until);
    /// Returns the first rule that is broken at this moment; empty: none.
    [[nodiscard]] Sentence broken(Time now);
    /// Judges after the end: an orderly stop in which every device was reached, or one by the guardian.
    [[nodiscard]] Sentence broken_at_rest(bool by_guardian) const;

    // ---- for learning what is left behind

    /// Returns for each output the components that write to it, each set once.
    [[nodiscard]] std::vector<std::vector<std::size_t>> all_writers() const;
    /// Returns the longest time from these writers to a wire.
    [[nodiscard]] Duration settles(const std::vector<std::size_t>& writers) const;
    /// Records what they left: they have been stopped that long, and nothing else happened.
    void note_left(const std::vector<std::size_t>& writers, AllLeftBehind& left) const;

private:
    /// One output at the wires. `settles` is longer than any way from a writer to the wire.
    struct Output : WireOutput {
        std::size_t driver = 0;             ///< the component
        std::vector<End> facets{};          ///< of the driver: its input, or the operations that switch it
        std::vector<std::size_t> writers{}; ///< the components that write there, without the driver
        // State of this machine's life.
        std::optional<std::uint64_t> before{}, left{}; ///< while a writer ran; when all had stopped
        Time since = never;                            ///< since when no writer runs
        Time excused{};
        bool is_meddled = false; ///< somebody sent a request to its driver, and it was not safe since
        // For an output that is sent cyclically from its input.
        bool grows_stale = false;            ///< by its row
        std::vector<std::size_t> together{}; ///< outputs that go out with it, including itself
        double wanted = 0;
        Time wanted_since = never;
        Time told_looked{};
    };
    /// An axis of the library, by its facets, and the messages of its drive at the wire.
    struct Axis {
        std::string_view name{}, device{};
        /// A signal of the bus, and its frame.
        struct Wire {
            can::Identifier frame{};
            const can::Signal* signal = nullptr;
        };
        Wire place{}, word{}, mode{}, target{}, control{};
        End state{}, standing{};
        std::size_t driver = 0;          ///< of its wires
        bool is_enabled = false;         ///< the drive reports enabled
        bool is_told = false;            ///< the drive is commanded to be enabled
        bool shows_homing = false;       ///< the drive reports homing
        bool goes_home = false;          ///< the axis was homing at the previous frame
        bool goes_anew = false;          ///< the drive reports that this homing has not ended
        unsigned follows = 0;            ///< consecutive frames that report following of positions
        std::optional<double> sent_to{}; ///< while it follows
        Time rests_since = never;        ///< by its state, which names no motion
        Time astray_since = never;       ///< its state names a motion that its drive does not make
        std::optional<double> rests_at{};
        double stands_below = -1.0; ///< its property as in the table
        Time excused{};
        unsigned elsewhere = 0; ///< consecutive frames at another position
    };

    void add_axes();
    [[nodiscard]] static Axis::Wire wire_of(const can::Identifiers& map, std::string_view facet);
    void hear_axis(Axis& axis, std::string_view device, const can::Frame& frame);
    void judge_place(Axis& axis, std::string_view device, const can::Frame& frame);
    void hear_homing(Axis& axis, std::string_view device, const can::Frame& frame);
    [[nodiscard]] std::string_view state_of(const Axis& axis) const;
    void add(std::size_t driver, WireOutput output);
    void find_together();
    [[nodiscard]] double said(const Output& output) const;
    [[nodiscard]] Sentence told_otherwise(Output& output, const std::optional<std::uint64_t>& value,
                                          Time now) const;
    [[nodiscard]] bool drives(const Output& output) const;
    [[nodiscard]] bool is_forced(const Output& output) const;
    [[nodiscard]] Sentence broken(Output& output, Time now) const;
    [[nodiscard]] Sentence told(const Output& output, std::uint64_t value) const;

    const AcceptedMachine& machine_;
    SimulatedDevices& devices_;
    const Struck& struck_;
    const AllLeftBehind* left_;
    MachineInstance* instance_ = nullptr;
    Time now_{};
    std::vector<Output> outputs_{};
    std::vector<Axis> axes_{};
    Sentence heard_{}; ///< the fault in an axis' frame
};

} // namespace tappet
