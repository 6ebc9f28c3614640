// A station: lets boards pass, or stops the belt while its tool works on one.
#pragma once

#include "apps/woodworking_lane/values.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/component/component.hpp"

#include <algorithm>
#include <cstdlib>

namespace woodworking {

/// The present activity of a station.
enum class Phase : std::uint8_t { waits, stops_belt, works, lost };

} // namespace woodworking

template <>
inline constexpr auto tappet::names_of<woodworking::Phase> =
    std::array<std::string_view, 4>{"waits", "stops_belt", "works", "lost"};

namespace woodworking {

/// Real-time, periodic.
struct Station {
    Input<std::int64_t> belt_position;
    Input<bool> belt_is_there;
    Output<bool> tool;
    Output<Phase> phase;
    Output<std::int64_t> boards_done, boards_missed;
    Event<Ticket> board_out;
    Event<> done;
    CommandCall<std::int32_t> stop_belt;
    Property<std::int64_t> number{0};
    Property<Duration> takes{600ms};

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        coming_.clear();
        static_cast<void>(stop_belt.reset());
        become(Phase::waits);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const bool belt_is_known = belt_is_there.get() && belt_position.good();
        switch (phase_) {
        case Phase::waits: break;
        case Phase::stops_belt:
            if (in_flight(stop_belt.state())) break;
            if (stop_belt.state() == CommandState::done && belt_is_known) {
                ends_ = cycle.now + takes.get();
                become(Phase::works);
            } else {
                miss();
            }
            break;
        case Phase::works:
            if (!belt_is_known) {
                miss(); // it is unknown whether the board still stands there
            } else if (cycle.now >= ends_) {
                boards_done.write(++done_);
                become(Phase::waits);
                board_out.emit(here_);
                done.emit();
            }
            break;
        case Phase::lost:
            if (belt_is_known) become(Phase::waits);
            break;
        }
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { tool.write(false); }

    /// The previous station, or the infeed, has released a board.
    void board_comes(Ticket board) noexcept TAPPET_REALTIME {
        if (!coming_.push({board, belt_position.get()})) boards_missed.write(++missed_);
    }
    /// The light barrier detects the next board.
    void board_seen(Time at) noexcept TAPPET_REALTIME {
        // The known position is from the past; since then the belt moved on at its speed.
        const double since = to_seconds(at - belt_position.stamp());
        const std::int64_t position =
            belt_position.get() + static_cast<std::int64_t>(belt_speed * std::clamp(since, 0.0, 0.06));
        if (phase_ != Phase::waits || !find(position)) return; // an unknown board: somebody removes it
        if (!has_work(here_, static_cast<int>(number.get()))) {
            board_out.emit(here_);
            return;
        }
        if (belt_position.good() && stop_belt.send(static_cast<std::int32_t>(position) + barrier_before))
            become(Phase::stops_belt);
        else
            miss();
    }
    /// It is unknown whether the next station received the ticket.
    void not_handed_on() noexcept TAPPET_REALTIME { boards_missed.write(++missed_); }

    static constexpr auto interface() {
        return facets(input<&Station::belt_position>("belt_position", "mm", "how far the belt has moved"),
                      input<&Station::belt_is_there>("belt_is_there", "", "the conveyor is heard"),
                      output<&Station::tool>("tool", "", "it works"),
                      output<&Station::phase>("phase", "", "the station's current step; written on change"),
                      output<&Station::boards_done>("boards_done", "", "written on change"),
                      output<&Station::boards_missed>("boards_missed", "",
                                                      "boards that passed without work; written on change"),
                      event<&Station::board_out>("board_out", "a board leaves this station"),
                      event<&Station::done>("done", "this station lets the belt run"),
                      sends<&Station::stop_belt>("stop_belt", "stop the belt at this position in mm"),
                      operation<&Station::board_comes>("board_comes", "a board is on its way"),
                      operation<&Station::board_seen>("board_seen", "the light barrier sees it"),
                      operation<&Station::not_handed_on>("not_handed_on", "a board's ticket was lost"),
                      property<&Station::number>("number", "", "in the boards' programmes", range(0, 7)),
                      property<&Station::takes>("takes", "s", "on one board"));
    }

private:
    void become(Phase next) noexcept TAPPET_REALTIME {
        phase_ = next;
        phase.write(next);
        tool.write(next == Phase::works);
    }
    void miss() noexcept TAPPET_REALTIME {
        boards_missed.write(++missed_);
        become(Phase::lost);
    }

    /// A board on its way here.
    struct Coming {
        Ticket ticket = 0;
        std::int64_t told_at = 0; ///< position of the belt at that time
        bool operator==(const Coming&) const = default;
    };
    /// Finds the board whose front is at the barrier, by the belt's way since its ticket came. Drops the
    /// boards before it: their fate is unknown.
    bool find(std::int64_t position) noexcept TAPPET_REALTIME {
        const std::size_t count = coming_.size();
        std::size_t first = count;
        for (std::size_t i = count; i-- > 0;)
            if (std::abs(position - coming_[i].told_at - (between_stations - barrier_before)) <= tolerance)
                first = i;
        if (first == count) return false;
        here_ = coming_[first].ticket;
        for (std::size_t i = first + 1; i < count; ++i) coming_[i - first - 1] = coming_[i];
        coming_.used = count - first - 1;
        return true;
    }
    static constexpr std::int64_t between_stations = stands_at(1) - stands_at(0), tolerance = 1500; // mm

    Bounded<Coming, 16> coming_{};
    Ticket here_ = 0;
    Phase phase_ = Phase::waits;
    Time ends_{};
    std::int64_t done_ = 0, missed_ = 0;
};

} // namespace woodworking
