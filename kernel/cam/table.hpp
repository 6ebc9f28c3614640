// The cam table: events at angles of the shaft, as flat constexpr rows, and its compile-time checks.
//     constexpr auto cams = cam_table(700_rpm,
//         cam("pick_window", at(80_deg)),
//         cam("main_nozzle", window(60_deg, 180_deg), dead_time(2500us, 1800us), exclusive("nozzles")));
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"
#include "kernel/cam/angle.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace tappet {

/// The direction of turning in which a row acts. An entered window is left in either direction.
enum class Direction : std::uint8_t { forward, backward, both };

/// One row. A point has one event; a window [enter, leave) has two; turning backward, it is entered at its
/// end.
struct CamRow {
    std::string_view name;
    Rotation enter;
    Rotation leave;
    bool is_window = false;
    Duration dead_time = Duration::zero();       // from firing to the effect: of a point, or of entering
    Duration leave_dead_time = Duration::zero(); // of leaving
    Duration dead_time_jitter = Duration::zero();
    Direction direction = Direction::forward;
    Speed min_speed;        // below this speed only leaving fires
    std::string_view group; // rows of one group never overlap
};

struct CamTableView {
    std::span<const CamRow> rows;
    Speed max_speed;
};

/// N rows and their maximum speed.
template <std::size_t N> struct CamTable {
    std::array<CamRow, N> rows{};
    Speed max_speed;
    [[nodiscard]] constexpr CamTableView view() const noexcept { return {rows, max_speed}; }
    [[nodiscard]] static constexpr std::size_t size() noexcept { return N; }
};

// The words of a row.
struct CamPlace {
    Rotation enter, leave;
    bool is_window;
};
struct CamDeadTime {
    Duration enter, leave;
};
struct CamJitter {
    Duration value;
};
struct CamGroup {
    std::string_view name;
};
struct CamMinSpeed {
    Speed value;
};
/// One event at one angle.
constexpr CamPlace at(Rotation angle) noexcept { return {angle, angle, false}; }
/// Two events: entering and leaving. May span 0: window(300_deg, 60_deg).
constexpr CamPlace window(Rotation enter, Rotation leave) noexcept { return {enter, leave, true}; }
/// Delay of the actuator: the row fires that much earlier, so that the effect is at the angle.
constexpr CamDeadTime dead_time(Duration both) noexcept { return {both, both}; }
/// Different delays for opening and closing.
constexpr CamDeadTime dead_time(Duration enter, Duration leave) noexcept { return {enter, leave}; }
/// Maximum variation of the dead time from one firing to the next.
constexpr CamJitter dead_time_jitter(Duration most) noexcept { return {most}; }
/// Windows of one group are never open together.
constexpr CamGroup exclusive(std::string_view group) noexcept { return {group}; }
constexpr CamMinSpeed min_speed(Speed slowest) noexcept { return {slowest}; }
constexpr Direction direction(Direction which) noexcept { return which; }

namespace cam_words {
constexpr void put(CamRow& row, CamDeadTime word) noexcept {
    row.dead_time = word.enter;
    row.leave_dead_time = word.leave;
}
constexpr void put(CamRow& row, CamJitter word) noexcept { row.dead_time_jitter = word.value; }
constexpr void put(CamRow& row, CamGroup word) noexcept { row.group = word.name; }
constexpr void put(CamRow& row, CamMinSpeed word) noexcept { row.min_speed = word.value; }
constexpr void put(CamRow& row, Direction word) noexcept { row.direction = word; }
} // namespace cam_words

/// One row; the words may come in any order.
template <class... Words>
constexpr CamRow cam(std::string_view name, CamPlace place, Words... words) noexcept {
    CamRow row;
    row.name = name;
    row.enter = place.enter;
    row.leave = place.leave;
    row.is_window = place.is_window;
    (cam_words::put(row, words), ...);
    return row;
}

/// The table: the maximum speed for which the dead times must hold, and the rows.
template <class... Rows>
constexpr CamTable<sizeof...(Rows)> cam_table(Speed max_speed, const Rows&... rows) noexcept {
    return {{rows...}, max_speed};
}

/// Returns the first fault of the table in one sentence that names the row, the fault and the cure; empty
/// when there is none.
constexpr Sentence check(const CamTableView& table);

namespace cam_check {

constexpr void add_degrees(Sentence& to, double degrees) {
    const auto tenths = static_cast<std::int64_t>(degrees * 10.0 + (degrees < 0.0 ? -0.5 : 0.5));
    if (tenths < 0) to.add("-");
    const std::int64_t size = tenths < 0 ? -tenths : tenths;
    to.add(size / 10);
    if (size % 10 != 0) to.add(".").add(size % 10);
    to.add(" deg");
}
constexpr Sentence about(const CamRow& row) { return Sentence{"cam row '", row.name, "': "}; }
constexpr double moved_deg(Speed speed, Duration in) { return speed.in_deg_s() * to_seconds(in); }
constexpr double width_deg(const CamRow& row) {
    return forward_way(Angle{row.enter}, Angle{row.leave}).in_degrees();
}

constexpr Sentence check_angle(const CamRow& row, Rotation angle) {
    if (angle >= Rotation{} && angle < Rotation::turns(1)) return {};
    Sentence s = about(row);
    s.add("the angle ");
    add_degrees(s, angle.in_degrees());
    s.add(" lies outside [0, 360); write ");
    add_degrees(s, Angle{angle}.in_degrees());
    return s;
}

constexpr Sentence check_dead_time(const CamRow& row, Speed max_speed) {
    if (row.dead_time < 0ns || row.leave_dead_time < 0ns || row.dead_time_jitter < 0ns)
        return about(row).add("a dead time or its jitter is negative; give how late the actuator answers");
    for (const Duration dead : {row.dead_time, row.leave_dead_time}) {
        const double lead = moved_deg(max_speed, dead + row.dead_time_jitter);
        if (lead < 360.0) continue;
        Sentence s = about(row);
        s.add("its dead time is ");
        add_degrees(s, lead);
        s.add(" at the table's maximum speed, not less than a turn; choose a faster actuator or lower the "
              "maximum speed");
        return s;
    }
    return {};
}

constexpr Sentence check_window(const CamRow& row, Speed max_speed) {
    const double width = width_deg(row);
    if (row.enter == row.leave)
        return about(row).add("the window opens and closes at one angle; give two angles, or write at(...)");
    const double blur = moved_deg(max_speed, row.dead_time_jitter);
    const double closing_ahead = moved_deg(max_speed, row.leave_dead_time - row.dead_time);
    // Closing fires before opening when its longer dead time uses up the window; and vice versa.
    const double open = width - (closing_ahead > 0.0 ? closing_ahead : 0.0);
    const double shut = 360.0 - width + (closing_ahead < 0.0 ? closing_ahead : 0.0);
    const bool too_short = open <= blur;
    if (!too_short && shut > blur) return {};
    Sentence s = about(row);
    s.add(too_short ? "the window is " : "the way outside the window is ");
    add_degrees(s, too_short ? width : 360.0 - width);
    s.add(" wide, but its dead times and their jitter take ");
    add_degrees(s, too_short ? width - open + blur : 360.0 - width - shut + blur);
    s.add(" at the table's maximum speed; ");
    s.add(too_short ? "widen" : "narrow");
    return s.add(" the window or choose a steadier actuator");
}

constexpr Sentence check_pair(const CamRow& a, const CamRow& b, Speed max_speed) {
    if (a.name == b.name) return about(b).add("the name is used by two rows; rename one of them");
    if (a.group.empty() || a.group != b.group) return {};
    const double blur = moved_deg(max_speed, a.dead_time_jitter + b.dead_time_jitter);
    const double a_to_b = forward_way(Angle{a.enter}, Angle{b.enter}).in_degrees();
    const double b_to_a = forward_way(Angle{b.enter}, Angle{a.enter}).in_degrees();
    const double over_a = width_deg(a) + blur - a_to_b;
    const double over_b = width_deg(b) + blur - b_to_a;
    if (a.enter != b.enter && over_a <= 0.0 && over_b <= 0.0) return {};
    Sentence s = about(b);
    s.add("its window overlaps that of '").add(a.name).add("' by ");
    const double least = width_deg(a) < width_deg(b) ? width_deg(a) : width_deg(b);
    const double most = over_a > over_b ? over_a : over_b;
    add_degrees(s, a.enter == b.enter ? least : most);
    if (blur > 0.0) s.add(" with the jitter of both dead times");
    return s.add(", but both are exclusive(\"").add(a.group).add("\"); move one window or drop its group");
}

constexpr Sentence check_row(const CamRow& row, Speed max_speed) {
    if (row.name.empty()) return Sentence{"cam table: a row has no name; give it one"};
    if (Sentence s = check_angle(row, row.enter); !s.empty()) return s;
    if (Sentence s = check_angle(row, row.leave); !s.empty()) return s;
    if (Sentence s = check_dead_time(row, max_speed); !s.empty()) return s;
    if (row.min_speed < Speed{} || row.min_speed >= max_speed)
        return about(row).add("its min_speed is negative or not below the table's maximum speed, so it never "
                              "fires; give a speed between 0 and the maximum");
    if (row.is_window) return check_window(row, max_speed);
    if (!row.group.empty())
        return about(row)
            .add("it is exclusive(\"")
            .add(row.group)
            .add("\"), but a point has no width; write window(...) or drop the group");
    return {};
}

} // namespace cam_check

constexpr Sentence check(const CamTableView& table) {
    if (!(table.max_speed > Speed{}))
        return Sentence{"cam table: the maximum speed is not above 0; give the fastest speed of the shaft"};
    for (const CamRow& row : table.rows)
        if (Sentence s = cam_check::check_row(row, table.max_speed); !s.empty()) return s;
    for (std::size_t i = 0; i < table.rows.size(); ++i)
        for (std::size_t j = i + 1; j < table.rows.size(); ++j)
            if (Sentence s = cam_check::check_pair(table.rows[i], table.rows[j], table.max_speed); !s.empty())
                return s;
    return {};
}

} // namespace tappet
