// The lane's other end: one belt with boards on it, as each machine's wires see it. Somebody lays boards on
// the belt, acknowledges, and removes boards that nobody worked on.
#pragma once

#include "apps/woodworking_lane/maps.hpp"
#include "drivers/can/far_end.hpp"
#include "drivers/gpio/far_end.hpp"
#include "drivers/plant/plant.hpp"
#include "kernel/base/random.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace woodworking {

/// The true state of a board.
struct Workpiece {
    Ticket ticket = 0;
    double laid_at = 0; ///< position of the belt at that time, mm
    std::array<Duration, station_count> worked{};
    std::array<double, station_count> off_by{}; ///< mm: largest distance from its working place
    bool harmed = false;                        ///< a tool worked on it while it moved
    bool left = false;
};

/// The state that all plants of the lane share; one thread. Times are true ones.
class Hall {
public:
    explicit Hall(std::uint64_t seed) : random_{seed} {}

    static constexpr double apart = 7000.0; ///< mm between the fronts of two boards
    static constexpr double length = 1200.0;
    static constexpr double end = 90'000.0;

    int wanted = 12; ///< boards that are laid on
    std::array<bool, station_count> tools{};
    double command = 0;         ///< mm/s
    double gone = 0, speed = 0; ///< of the belt, mm and mm/s
    std::vector<Workpiece> boards{};
    bool acknowledges = false;
    bool runs = false; ///< the conveyor's lamp says that the belt may run

    /// Call once per millisecond of the conveyor's time.
    void move(Duration step) {
        const double dt = to_seconds(step);
        const double change = belt_brakes * dt, before = speed;
        speed += std::clamp(command - speed, -change, change);
        gone += (before + speed) / 2 * dt;
        scanned_ = 0;
        if (static_cast<int>(boards.size()) < wanted && speed > 100.0 &&
            (boards.empty() || gone - boards.back().laid_at > apart + spread_)) {
            const auto number = static_cast<std::int32_t>(boards.size() + 1);
            const auto programme = static_cast<std::int32_t>(random_.below(1u << station_count));
            boards.push_back({.ticket = ticket(number, programme), .laid_at = gone});
            scanned_ = boards.back().ticket;
            spread_ = static_cast<double>(random_.below(3000));
        }
        for (Workpiece& board : boards) {
            const double at = gone - board.laid_at;
            board.left |= at > end;
            for (int s = 0; s < station_count; ++s) {
                const auto i = static_cast<std::size_t>(s);
                if (!tools[i] || at < stands_at(s) - barrier_before || at - length > stands_at(s)) continue;
                board.worked[i] += step;
                board.off_by[i] = std::max(board.off_by[i], std::abs(at - stands_at(s)));
                board.harmed |= speed > 1.0;
            }
        }
    }
    [[nodiscard]] Ticket scanned() const { return scanned_; }
    [[nodiscard]] bool barrier(int station) const {
        for (const Workpiece& board : boards) {
            const double at = gone - board.laid_at - (stands_at(station) - barrier_before);
            if (at >= 0 && at < length) return true;
        }
        return false;
    }
    [[nodiscard]] int left() const {
        return static_cast<int>(
            std::ranges::count_if(boards, [](const Workpiece& each) { return each.left; }));
    }

private:
    Random random_;
    double spread_ = 0;
    Ticket scanned_ = 0;
};

/// The conveyor's drive and scanner, and the person who acknowledges.
class ConveyorWires {
public:
    explicit ConveyorWires(FarEnds& ends) : can{ends, "belt-can"}, io{ends, "belt-io"} {
        can.send_every("drive", 5ms);
    }
    void move(Hall& hall, Duration step) {
        hall.command = can.get("drive_command.speed");
        hall.move(step);
        can.set_integer("drive.position", static_cast<std::uint64_t>(std::llround(hall.gone)));
        can.set_integer("drive.speed", static_cast<std::uint64_t>(std::llround(hall.speed)));
        if (hall.scanned() != 0) {
            can.set_integer("scanner.code", static_cast<std::uint64_t>(hall.scanned()));
            can.send("scanner");
        }
        io.set("acknowledge", hall.acknowledges);
        hall.runs = io.get("lamp");
    }

private:
    can::FarEnd<belt_signals> can;
    gpio::FarEnd<belt_lines> io;
};

class StationWires {
public:
    StationWires(FarEnds& ends, std::string_view device, int station) : station_{station}, io{ends, device} {}
    void move(Hall& hall) {
        hall.tools[static_cast<std::size_t>(station_)] = io.get("tool");
        io.set("board", hall.barrier(station_));
    }

private:
    int station_;
    gpio::FarEnd<station_lines> io;
};

// ---- plants of one machine each, where all of them live in one process

class ConveyorPlant final : public tappet::Plant {
public:
    explicit ConveyorPlant(Hall& hall) : hall_{hall} {}
    Time move(Time now) override {
        wires_.move(hall_, step());
        return now + 1ms;
    }

private:
    Hall& hall_;
    ConveyorWires wires_{ends};
};

class StationPlant final : public tappet::Plant {
public:
    StationPlant(Hall& hall, int station) : hall_{hall}, wires_{ends, "station-io", station} {}
    Time move(Time now) override {
        wires_.move(hall_);
        return now + 1ms;
    }

private:
    Hall& hall_;
    StationWires wires_;
};

} // namespace woodworking
