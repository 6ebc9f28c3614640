// The conveyor: it stops where stations request it, and when a station falls silent.
#pragma once

#include "apps/woodworking_lane/values.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/component/component.hpp"
#include "kernel/statechart/rows.hpp"

#include <algorithm>
#include <cmath>

namespace woodworking {

/// Real-time, periodic.
struct Belt {
    Input<std::int64_t> drive_position, drive_speed, code;
    Input<bool> bus_faulted, saw_is_there, drill_is_there, polish_is_there, glue_is_there;
    Output<std::int64_t> speed_command;
    Output<std::int64_t> position; ///< mm
    Output<bool> lamp;
    Output<std::int64_t> boards_in, boards_out;
    Event<Ticket> board_in;

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        stops_.clear();
        works_ = 0;
        may_run_ = false;
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        position_ = drive_position.get();
        position.write(position_, drive_position.stamp());
        speed_command.write(static_cast<std::int64_t>(wanted_speed()));
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { speed_command.write(0); }

    // ---- operations of stations

    /// Requests a stop at this position of the belt, mm.
    bool stop_at(std::int32_t where) noexcept TAPPET_REALTIME {
        if (!may_run_ || where <= position_) return false;
        return stops_.push(where);
    }
    CommandProgress stopped_at(std::int32_t where) noexcept TAPPET_REALTIME {
        if (!may_run_) return forget(where), CommandProgress::failed;
        if (std::abs(position_ - where) > 1 || drive_speed.get() != 0) return CommandProgress::executing;
        forget(where);
        ++works_;
        return CommandProgress::done;
    }
    /// A station has finished its work.
    void go() noexcept TAPPET_REALTIME { works_ = std::max(works_ - 1, 0); }
    void board_leaves(Ticket) noexcept TAPPET_REALTIME { boards_out.write(++out_); }

    // ---- operations of the infeed

    void scanned() noexcept TAPPET_REALTIME {
        boards_in.write(++in_);
        board_in.emit(static_cast<Ticket>(code.get()));
    }

    // ---- operations of its state machine

    [[nodiscard]] bool all_are_there() noexcept TAPPET_REALTIME {
        return saw_is_there.get() && drill_is_there.get() && polish_is_there.get() && glue_is_there.get();
    }
    [[nodiscard]] bool is_in_danger() noexcept TAPPET_REALTIME {
        return !all_are_there() || bus_faulted.get();
    }
    [[nodiscard]] bool may_start() noexcept TAPPET_REALTIME { return !is_in_danger(); }
    [[nodiscard]] std::string_view obstacle() noexcept TAPPET_REALTIME {
        if (bus_faulted.get()) return "the drive's bus cannot be relied on";
        if (!saw_is_there.get()) return "the saw is not heard";
        if (!drill_is_there.get()) return "the drill is not heard";
        if (!polish_is_there.get()) return "the polisher is not heard";
        return "the glue station is not heard";
    }
    void enter_standing() noexcept TAPPET_REALTIME { become(false); }
    void enter_running() noexcept TAPPET_REALTIME { become(true); }

    static constexpr auto interface() {
        return facets(
            input<&Belt::drive_position>("drive_position", "mm", "measured by its encoder"),
            input<&Belt::drive_speed>("drive_speed", "mm/s", "measured by its encoder"),
            input<&Belt::code>("code", "", "the board that was scanned last"),
            input<&Belt::bus_faulted>("bus_faulted", "", "the drive is not heard"),
            input<&Belt::saw_is_there>("saw_is_there", "", "it is heard on the wire"),
            input<&Belt::drill_is_there>("drill_is_there", "", "it is heard on the wire"),
            input<&Belt::polish_is_there>("polish_is_there", "", "it is heard on the wire"),
            input<&Belt::glue_is_there>("glue_is_there", "", "it is heard on the wire"),
            output<&Belt::speed_command>("speed_command", "mm/s", "of the drive"),
            output<&Belt::position>("position", "mm",
                                    "how far the belt has moved, at the time of the drive's last message"),
            output<&Belt::lamp>("lamp", "", "the belt may run"),
            output<&Belt::boards_in>("boards_in", "", "that were scanned; written on change"),
            output<&Belt::boards_out>("boards_out", "", "that left the last station; written on change"),
            event<&Belt::board_in>("board_in", "a board lies on the belt"),
            command<&Belt::stop_at, &Belt::stopped_at>("stop_at", "stops the belt at this position in mm"),
            operation<&Belt::go>("go", "a station has done its work"),
            operation<&Belt::board_leaves>("board_leaves", "a board left the last station"),
            operation<&Belt::scanned>("scanned", "the scanner has read a board"));
    }

private:
    void become(bool runs) noexcept TAPPET_REALTIME {
        may_run_ = runs;
        lamp.write(runs);
        if (!runs) works_ = 0;
    }
    void forget(std::int32_t where) noexcept TAPPET_REALTIME {
        const std::size_t count = stops_.size();
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count; ++i)
            if (stops_[i] != where) stops_[kept++] = stops_[i];
        stops_.used = kept;
    }
    /// Returns the speed with which the belt stops at the next requested position.
    [[nodiscard]] double wanted_speed() const noexcept TAPPET_REALTIME {
        if (!may_run_ || works_ > 0) return 0.0;
        double left = 1e9;
        const std::size_t count = stops_.size();
        for (std::size_t i = 0; i < count; ++i)
            left = std::min(left, std::max(0.0, static_cast<double>(stops_[i] - position_)));
        // Brakes less than possible, and creeps the last millimetre.
        return std::min(belt_speed, std::floor(std::sqrt(2.0 * 0.6 * belt_brakes * left)));
    }

    Bounded<std::int32_t, 8> stops_{};
    std::int64_t position_ = 0, in_ = 0, out_ = 0;
    int works_ = 0;
    bool may_run_ = false;
};

// clang-format off
inline constexpr auto belt_states = state_machine<Belt>("belt_states",
    states(
        state("standing", initial, entry<&Belt::enter_standing>), // nothing moves: acknowledge once
        state("running",  entry<&Belt::enter_running>),
        state("safe",     final, entry<&Belt::enter_standing>)),
    transitions(
        transition("standing", "running", on("io.acknowledge.rises"), guard<&Belt::may_start>.because<&Belt::obstacle>("the belt may not run")),
        transition("running", "standing", guard<&Belt::is_in_danger>, because("a station or the drive is not heard"))));
// clang-format on

} // namespace woodworking
