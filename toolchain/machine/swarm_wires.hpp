// What a machine puts on its wires, judged by rules that hold of every machine: which part drives which
// output is read from its table, what is safe and what is in range from its maps.
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

namespace modbus {
struct Register;
}

/// What is on an output's wire when all that writes to it was stopped while nothing else went on.
struct LeftBehind {
    bool holds = false;                  ///< whatever it was before
    std::vector<std::uint64_t> values{}; ///< beside what is safe
};
using AllLeftBehind = std::map<std::string, LeftBehind>; ///< by the names of outputs

/// Not real-time. Lives as long as the run.
class SwarmWires {
public:
    /// `left`: null: nobody has looked.
    SwarmWires(const AcceptedMachine& machine, SimulatedDevices& devices, const Struck& struck,
               const AllLeftBehind* left = nullptr);

    /// After the devices were opened: looks at what goes over them.
    void listen();
    /// A new machine drives the wires.
    void begin(MachineInstance& instance);
    /// Somebody asks for something of the driver itself: until then its outputs follow who asked.
    void excuse(std::size_t driver, Time until);
    /// Somebody forces a port: an axis may be told anything.
    void excuse_axes(Time until);
    /// The first rule that is broken at this moment; empty: none.
    [[nodiscard]] Sentence broken(Time now);
    /// All of it is over: in order, and no driver said that its device was not reached, or by the guardian.
    [[nodiscard]] Sentence broken_at_rest(bool by_guardian) const;

    // ---- to see what is left behind

    /// The components that write to one output, for each output, each set once.
    [[nodiscard]] std::vector<std::vector<std::size_t>> all_writers() const;
    /// As long as anything takes from there to a wire.
    [[nodiscard]] Duration settles(const std::vector<std::size_t>& writers) const;
    /// They stand since so long, and nothing else went on.
    void note_left(const std::vector<std::size_t>& writers, AllLeftBehind& left) const;

    /// What a wire can say.
    struct Numbers {
        double least = 0, most = 0, step = 0;
    };

private:
    /// One output at the wires.
    struct Output {
        std::size_t driver = 0; ///< the component
        std::string name{};
        std::vector<End> facets{};          ///< of the driver: its input, or the operations that switch it
        std::vector<std::size_t> writers{}; ///< the components that write there; the driver is none of them
        std::optional<std::uint64_t> safe{};
        bool is_switch = false; ///< one bit
        bool is_line = false;
        Duration settles{};  ///< longer than anything takes from a writer to the wire
        Duration recovers{}; ///< after a fault its driver may come to it so much later
        std::function<std::optional<std::uint64_t>()> read{};
        // Of this machine.
        std::optional<std::uint64_t> before{}, left{}; ///< while a writer ran; when all had stopped
        Time since = never;                            ///< no writer runs
        Time excused{};
        bool is_meddled = false; ///< somebody asked its driver, and it was not safe since
        // Of one that goes out again and again, as its input says.
        std::size_t goes_in = nowhere; ///< its frame's or request's number
        bool grows_stale = false;      ///< by its row
        Numbers numbers{};
        std::function<double(std::uint64_t)> physical{}; ///< null: it is another kind
        std::vector<std::size_t> together{};             ///< outputs that go out with it, and itself
        double wanted = 0;
        Time wanted_since = never;
        Time told_looked{};
    };
    /// A frame that the machine sends, as it was on the wire last.
    struct Sent {
        std::string_view device;
        const can::Identifiers* map = nullptr;
        std::size_t row = 0;
        std::optional<can::Frame> last{};
    };
    /// An axis of the library, as its facets say, and what its drive tells at the wire.
    struct Axis {
        std::string_view name{}, device{};
        /// A signal of the bus, and the frame that it is in.
        struct Wire {
            can::Identifier frame{};
            const can::Signal* signal = nullptr;
        };
        Wire place{}, word{}, mode{}, target{}, control{};
        End state{}, standing{};
        std::size_t driver = 0;          ///< of its wires
        bool is_enabled = false;         ///< the drive says so
        bool is_told = false;            ///< so is the drive
        bool shows_homing = false;       ///< the drive
        bool goes_home = false;          ///< the axis, at the frame before
        bool goes_anew = false;          ///< and its drive says that this homing has not ended
        unsigned follows = 0;            ///< frames one after the other that say it follows positions
        std::optional<double> sent_to{}; ///< while it follows
        Time rests_since = never;        ///< by its state, which names no motion
        Time astray_since = never;       ///< its state names a motion that its drive does not make
        std::optional<double> rests_at{};
        double stands_below = -1.0; ///< its property as the table has it
        Time excused{};
        unsigned elsewhere = 0; ///< frames that say so, one after the other
    };

    void add_axes();
    [[nodiscard]] static Axis::Wire wire_of(const can::Identifiers& map, std::string_view facet);
    void hear_axis(Axis& axis, std::string_view device, const can::Frame& frame);
    void judge_place(Axis& axis, std::string_view device, const can::Frame& frame);
    void hear_homing(Axis& axis, std::string_view device, const can::Frame& frame);
    [[nodiscard]] std::string_view state_of(const Axis& axis) const;
    void add_lines(std::size_t component);
    void add_signals(std::size_t component);
    void add_registers(std::size_t component);
    /// `events`: what switches it, in place of an input of its name.
    void add(Output output, std::string_view name, const std::vector<std::string>& events = {});
    [[nodiscard]] static Numbers numbers_of(const can::Signal& signal);
    [[nodiscard]] static Numbers numbers_of(const modbus::Register& one);
    void find_together();
    [[nodiscard]] double said(const Output& output) const;
    [[nodiscard]] Sentence told_otherwise(Output& output, const std::optional<std::uint64_t>& value,
                                          Time now) const;
    void hear(std::string_view device, const can::Frame& frame);
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
    std::vector<Sent> sent_{};
    std::vector<Axis> axes_{};
    Sentence heard_{}; ///< what was wrong with a frame
};

} // namespace tappet
