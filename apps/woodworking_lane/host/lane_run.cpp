// Moves the lane and judges the result of its boards.
#include "apps/woodworking_lane/host/lane_run.hpp"

#include "apps/woodworking_lane/lane.hpp"
#include "board/host/board.hpp"
#include "kernel/machine/firmware.hpp"

namespace woodworking {

std::array<AcceptedMachine, node_count> machines() {
    return {
        Firmware<at_conveyor::table, board::host>::machine(), Firmware<at_saw::table, board::host>::machine(),
        Firmware<at_drill::table, board::host>::machine(), Firmware<at_polish::table, board::host>::machine(),
        Firmware<at_glue::table, board::host>::machine()};
}
const SystemView& lane_view() {
    static const SystemView view = lane.view();
    return view;
}

LaneRun::LaneRun(std::uint64_t seed, int boards)
    : hall{seed}, system{lane_view(), machines(), plants(), seed} {
    hall.wanted = boards;
}

std::expected<void, Sentence> LaneRun::start() {
    if (auto started = system.start(); !started) return started;
    run_for(500ms);
    acknowledge();
    return {};
}

void LaneRun::acknowledge() {
    hall.acknowledges = true;
    run_for(50ms);
    hall.acknowledges = false;
}

bool LaneRun::run_for(Duration time) {
    for (const Time end = system.now() + time; system.now() < end;) {
        if (!system.run_for(std::min(Duration{20ms}, end - system.now()))) return false;
        Moment now{to_seconds(system.now() - Time{}), hall.gone, hall.speed, hall.tools, {}};
        for (std::size_t n = 0; n < node_count; ++n) now.alive[n] = system.is_alive(n);
        moments.push_back(now);
    }
    return true;
}

bool LaneRun::run_through(Duration limit) {
    for (const Time end = system.now() + limit; hall.left() < hall.wanted;)
        if (system.now() >= end || !run_for(100ms)) return false;
    return true;
}

Sentence fault_of(const Hall& hall, int& missed) {
    constexpr std::array<Duration, station_count> takes{800ms, 500ms, 1200ms, 300ms}; // as in the tables
    missed = 0;
    for (const Workpiece& board : hall.boards) {
        if (!board.left) continue;
        if (board.harmed)
            return Sentence{"a tool worked on board ", number_of(board.ticket), " while it moved"};
        for (int s = 0; s < station_count; ++s) {
            const auto i = static_cast<std::size_t>(s);
            if (!has_work(board.ticket, s) && board.worked[i] > Duration::zero())
                return Sentence{"station ", s, " worked on board ", number_of(board.ticket),
                                ", which its programme does not ask for"};
            if (board.off_by[i] > 40.0)
                return Sentence{"board ",
                                number_of(board.ticket),
                                " stood ",
                                static_cast<int>(board.off_by[i]),
                                " mm from its place at station ",
                                s};
            if (has_work(board.ticket, s) && board.worked[i] + 20ms < takes[i]) ++missed;
        }
    }
    return {};
}

} // namespace woodworking
