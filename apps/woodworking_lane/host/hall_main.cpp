// The hall on the bench: one process simulates the other ends of all five machines' wires.
#include "apps/woodworking_lane/bindings.hpp"
#include "apps/woodworking_lane/plant.hpp"
#include "board/bench/board.hpp"
#include "kernel/machine/table/machine.hpp"
#include "toolchain/machine/bench/plant_program.hpp"

namespace {

using namespace woodworking;

/// The devices on those wires; no machine runs this table.
constexpr auto wires =
    machine("woodworking-hall",
            components(component<can::Bus<belt_signals>>("drive", device("belt-can")),
                       component<gpio::LinePort<belt_lines>>("belt", device("belt-io")),
                       component<gpio::LinePort<station_lines>>("saw", device("saw-io")),
                       component<gpio::LinePort<station_lines>>("drill", device("drill-io")),
                       component<gpio::LinePort<station_lines>>("polish", device("polish-io")),
                       component<gpio::LinePort<station_lines>>("glue", device("glue-io"))),
            activities(), connections(), reactions(), behaviours());
constexpr Binding bound = binding(belt_can, belt_io, station_io("saw-io", 0), station_io("drill-io", 1),
                                  station_io("polish-io", 2), station_io("glue-io", 3));

/// Acknowledges at the conveyor upon the signal USR1.
class HallPlant final : public Plant {
public:
    explicit HallPlant(std::uint64_t seed) : hall_{seed} {}
    Time move(Time now) override {
        hall_.acknowledges = now < acknowledges_until_;
        conveyor_.move(hall_, step());
        for (StationWires& each : stations_) each.move(hall_);
        now_ = now;
        return now + 1ms;
    }
    void told() override { acknowledges_until_ = now_ + 100ms; }
    void report(JsonText& json) const override {
        std::int64_t works = 0, harmed = 0;
        for (const Workpiece& board : hall_.boards) {
            harmed += board.harmed ? 1 : 0;
            for (const Duration worked : board.worked) works += worked > Duration::zero() ? 1 : 0;
        }
        json.field("boards", static_cast<std::int64_t>(hall_.boards.size())).field("works", works);
        json.field("harmed", harmed).field("belt_m", hall_.gone / 1000.0);
    }

private:
    Hall hall_;
    ConveyorWires conveyor_{ends};
    std::array<StationWires, station_count> stations_{
        StationWires{ends, "saw-io", 0}, StationWires{ends, "drill-io", 1},
        StationWires{ends, "polish-io", 2}, StationWires{ends, "glue-io", 3}};
    Time now_{}, acknowledges_until_{};
};

} // namespace

int main(int count, char** words) {
    static constexpr auto table = wires;
    return run_plant(
        table.view(), board::bench, bound,
        [](std::uint64_t seed) -> std::unique_ptr<Plant> { return std::make_unique<HallPlant>(seed); }, count,
        words);
}
