// A board: what one kind of box has and can do. It knows no machine; which of its devices a machine uses, and
// for what, is said by a binding. One binary is one machine on one board.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/device_kind.hpp"
#include "kernel/component/role.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet {

struct BoardDevice {
    std::string_view name{};    ///< as on the housing: what a binding says
    std::string_view kind{};    ///< "can", "gpio", "serial", or what a driver of one's own drives
    std::string_view address{}; ///< where Linux has it: "can0", "/dev/gpiochip0", "/dev/ttyS1"
    Bounded<Fact, 4> facts{};   ///< in the words of that kind, which its driver declares

    /// Of a board that is another one but for a word: in place of what that one says with it.
    constexpr void say(const Fact& fact) noexcept {
        for (Fact& each : facts)
            if (each.word == fact.word) {
                each = fact;
                return;
            }
        static_cast<void>(facts.push(fact));
    }
};

/// Whoever is this user, or in this group, has this role at least.
struct BoardRole {
    bool is_group = false;
    std::uint32_t number = 0;
    Role role = Role::observer;
};

/// The local socket for browsers: where it stands and who may use it. Root and the user that runs the machine
/// are engineers; whoever else may open the socket's file and is not listed is an observer.
struct BoardBrowsing {
    std::string_view directory{}; ///< empty: no socket unless the program's options name one
    unsigned mode = 0660;         ///< of the socket's file
    std::int64_t group = -1;      ///< of the socket's file; -1: that of the process
    Bounded<BoardRole, 16> roles{};
};

/// An Ethernet port of the box, as the kernel names it, and its address: "192.168.7.1/24".
struct BoardNetwork {
    std::string_view name{};
    std::string_view address{};
};

/// What the box's init does when the firmware ended without being asked to: it starts it again, and leaves it
/// after so many times within so long. A started machine stands until somebody at it acknowledges.
struct BoardRestarts {
    int most = 3;
    Duration within = std::chrono::minutes{10};
};

/// What the box's image carries beside the firmware, and what its init brings up.
struct BoardImage {
    /// Kernel modules, with their parameters after a blank. One that drives devices is loaded when one of
    /// them is there, any other always; what they need comes with them.
    Bounded<std::string_view, 48> modules{};
    Bounded<std::string_view, 48> later_modules{}; ///< as those, but loaded when the machine has armed
    Bounded<std::string_view, 4>
        consoles{};                      ///< where kernel, init and firmware speak: "tty0", "ttyS0,115200"
    Bounded<BoardNetwork, 4> networks{}; ///< Ethernet interfaces that the box brings up
    int interrupt_priority =
        0; ///< SCHED_FIFO of the bound devices' interrupt threads; 0: as the kernel has them
    BoardRestarts restarts{};
    /// TCP, on every network of the box: tells what runs, takes signed updates and orders, which wait for
    /// consent at the machine. 0: none.
    std::uint16_t service_port = 0;
};

struct Board {
    std::string_view name{};
    std::string_view world = "box"; ///< or "host", "bench"
    /// Of all static memory, the heap's arena and the stacks included.
    std::size_t memory_budget_bytes = 4 * 1024 * 1024;
    std::size_t heap_bytes = 0; ///< the arena that configuring may use before arming
    int processors = 1;
    int highest_priority = 80; ///< SCHED_FIFO; interrupt threads stay above it
    int default_processor = 0;
    Bounded<BoardDevice, 16> devices{};
    bool simulated =
        false; ///< any device that a machine names is there, as its twin: nothing needs a binding
    Bounded<std::string_view, 16>
        only_warned{}; ///< arming checks that this development board downgrades to warnings
    std::string_view kernel_command_line{}; ///< without console=, which follows from the image's consoles
    BoardImage image{};
    std::string_view properties_directory{}; ///< where properties files lie; "": they are not kept
    BoardBrowsing browsing{};
    std::string_view
        black_box_directory{}; ///< of what is kept of an ending that nobody asked for; "": nothing
    const char* watchdog =
        nullptr; ///< "/dev/watchdog": the guardian kicks it while the machine lives; null: none
    Duration watchdog_within = 10s; ///< then the watchdog resets the box
    /// A real-time activity that is due, or in a cycle, and gets no further for so long, ends the machine:
    /// see kernel/machine/worlds/life_watch.hpp. Longer than any deadline.
    Duration life_sign_within = 200ms;
    /// A stop that was asked for leaves every output safe within so long, whatever a component does: what the
    /// machine has not done by then its guardian does. At least what the table promises: see check/stop.hpp.
    Duration stop_within = 1s;
    /// A stop that has not begun by then the guardian does not wait for.
    [[nodiscard]] constexpr Duration stop_begins_within() const noexcept { return stop_within / 4; }
    /// How long all activities that are not real-time, together, may hold up the stop of those that are: they
    /// may block. Who is not stopped by then is waited for when the others stand.
    static constexpr Duration stop_grace = 20ms;
};

/// board_device("can0", "can", "can0", bit_rate(500'000)),
/// board_device("io", "gpio", "/dev/gpiochip0", lines(32))
/// The words stand in the driver's kind.hpp, drivers/can/kind.hpp; four at most.
template <std::same_as<Fact>... Facts>
constexpr BoardDevice board_device(std::string_view name, std::string_view kind, std::string_view address,
                                   const Facts&... facts) {
    static_assert(sizeof...(Facts) <= 4, "a device of a board has four words at most");
    BoardDevice device{.name = name, .kind = kind, .address = address};
    (static_cast<void>(device.facts.push(facts)), ...);
    return device;
}

namespace detail {

template <class T, std::size_t N, class... Items>
constexpr Bounded<T, N> list_of(const Items&... items) {
    static_assert(
        sizeof...(Items) <= N,
        "a board's list is longer than its room: raise the bound in kernel/machine/table/board.hpp");
    Bounded<T, N> list;
    (static_cast<void>(list.push(T{items})), ...);
    return list;
}

} // namespace detail

/// The devices of the box, 16 at most.
template <class... Devices>
constexpr Bounded<BoardDevice, 16> board_devices(const Devices&... devices) {
    return detail::list_of<BoardDevice, 16>(devices...);
}
/// The user of that number has this role at least.
constexpr BoardRole user(std::uint32_t number, Role role) noexcept { return {false, number, role}; }
/// Who is in the group of that number has this role at least.
constexpr BoardRole group(std::uint32_t number, Role role) noexcept { return {true, number, role}; }
/// Who may do more than look, 16 rows at most.
template <class... Rows>
constexpr Bounded<BoardRole, 16> roles(const Rows&... rows) {
    return detail::list_of<BoardRole, 16>(rows...);
}
/// Arming checks, by name, that this development board downgrades to warnings.
template <class... Names>
constexpr Bounded<std::string_view, 16> warn_only(const Names&... names) {
    return detail::list_of<std::string_view, 16>(names...);
}

/// Kernel modules, 48 rows at most.
template <class... Rows>
constexpr Bounded<std::string_view, 48> kernel_modules(const Rows&... rows) {
    return detail::list_of<std::string_view, 48>(rows...);
}
/// "tty0", "ttyS0,115200"; four at most.
template <class... Names>
constexpr Bounded<std::string_view, 4> consoles(const Names&... names) {
    return detail::list_of<std::string_view, 4>(names...);
}
/// ethernet("eth0", "192.168.7.1/24"); four at most.
constexpr BoardNetwork ethernet(std::string_view name, std::string_view address) noexcept {
    return {name, address};
}
/// Of a board: the interfaces of Ethernet, as ethernet() writes each.
template <class... Rows>
constexpr Bounded<BoardNetwork, 4> networks(const Rows&... rows) {
    return detail::list_of<BoardNetwork, 4>(rows...);
}

} // namespace tappet
