// A board: the devices and properties of one kind of box. It does not know the machine; a binding says which
// of its devices a machine uses, and for what. One binary is one machine on one board.
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
    std::string_view name{};    ///< as on the housing; a binding uses this name
    std::string_view kind{};    ///< "can", "gpio", "serial", or the kind of a user's own driver
    std::string_view address{}; ///< the device's name in Linux: "can0", "/dev/gpiochip0", "/dev/ttyS1"
    Bounded<Fact, 4> facts{};   ///< words of that kind; its driver declares them

    /// Replaces the fact with the same word, or adds it; for a board that is derived from another one.
    constexpr void say(const Fact& fact) noexcept {
        for (Fact& each : facts)
            if (each.word == fact.word) {
                each = fact;
                return;
            }
        static_cast<void>(facts.push(fact));
    }
};

/// This user, or every member of this group.
struct BoardPeer {
    bool is_group = false;
    std::uint32_t number = 0;
    constexpr bool operator==(const BoardPeer&) const noexcept = default;
};

/// The peer has at least this role. A gateway has no other role, and only relays requests of users whom it
/// names: none of them has a higher role than this one.
struct BoardRole {
    BoardPeer peer{};
    Role role = Role::observer;
    bool is_gateway = false;
    bool with_panel = false; ///< of a gateway: its users may be at the machine's panel
};

/// The local socket for browsers: its directory and its users. Root and the user that runs the machine are
/// engineers; any other user who may open the socket's file and is not listed is an observer.
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

/// Restart policy of the box's init when the firmware ends without a request: init restarts it, at most
/// `most` times within `within`. A restarted machine stays stopped until an operator at the machine
/// acknowledges.
struct BoardRestarts {
    int most = 3;
    Duration within = std::chrono::minutes{10};
};

/// Contents of the box's image beside the firmware, and the services that its init starts.
struct BoardImage {
    /// Kernel modules, with their parameters after a blank. A module that drives devices is loaded when one
    /// of them is present, any other module always; the modules that they depend on are included.
    Bounded<std::string_view, 48> modules{};
    Bounded<std::string_view, 48> later_modules{}; ///< like `modules`, but loaded after the machine has armed
    Bounded<std::string_view, 4> consoles{}; ///< output of kernel, init and firmware: "tty0", "ttyS0,115200"
    Bounded<BoardNetwork, 4> networks{};     ///< Ethernet interfaces that the box brings up
    int interrupt_priority =
        0; ///< SCHED_FIFO priority of the bound devices' interrupt threads; 0: the kernel's default
    BoardRestarts restarts{};
    /// TCP port on every network of the box: reports the running version, accepts signed updates and orders,
    /// which wait for consent at the machine. 0: no service.
    std::uint16_t service_port = 0;
};

struct Board {
    std::string_view name{};
    std::string_view world = "box"; ///< or "host", "bench"
    /// Limit of all static memory, including the heap's arena and the stacks.
    std::size_t memory_budget_bytes = 4 * 1024 * 1024;
    std::size_t heap_bytes = 0; ///< the arena for allocations during configuration, before arming
    int processors = 1;
    int highest_priority = 80; ///< SCHED_FIFO; interrupt threads stay above it
    int default_processor = 0;
    Bounded<BoardDevice, 16> devices{};
    bool simulated = false; ///< every device that a machine names exists as its twin: no binding is needed
    Bounded<std::string_view, 16>
        only_warned{}; ///< arming checks that this development board downgrades to warnings
    std::string_view kernel_command_line{}; ///< without console=, which follows from the image's consoles
    BoardImage image{};
    std::string_view properties_directory{}; ///< directory of the properties files; "": they are not saved
    BoardBrowsing browsing{};
    std::string_view black_box_directory{}; ///< directory for records of unrequested ends; "": none is kept
    const char* watchdog =
        nullptr; ///< "/dev/watchdog": the guardian kicks it while the machine lives; null: none
    Duration watchdog_within = 10s; ///< time-out after which the watchdog resets the box
    /// Ends the machine when a real-time activity that is due, or in a cycle, makes no progress for this
    /// long: see kernel/machine/worlds/life_watch.hpp. Must be longer than any deadline.
    Duration life_sign_within = 200ms;
    /// A requested stop makes every output safe within this time, whatever a component does: the guardian
    /// does what the machine has not done by then. At least the sum that the table promises: see
    /// check/stop.hpp.
    Duration stop_within = 1s;
    /// Returns the time within which a stop must begin; after it the guardian waits no longer.
    [[nodiscard]] constexpr Duration stop_begins_within() const noexcept { return stop_within / 4; }
    /// How long all activities that are not real-time, together, may delay the stop of the real-time ones:
    /// they may block. An activity that is not stopped by then is waited for after the others have stopped.
    static constexpr Duration stop_grace = 20ms;
};

/// board_device("can0", "can", "can0", bit_rate(500'000)),
/// board_device("io", "gpio", "/dev/gpiochip0", lines(32))
/// The driver's kind.hpp declares the words, for example drivers/can/kind.hpp; four at most.
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
/// The processes of the user of that number.
constexpr BoardPeer user(std::uint32_t number) noexcept { return {false, number}; }
/// The processes of the members of the group of that number.
constexpr BoardPeer group(std::uint32_t number) noexcept { return {true, number}; }
/// The user of that number has this role at least.
constexpr BoardRole user(std::uint32_t number, Role role) noexcept { return {user(number), role}; }
/// Every member of the group of that number has at least this role.
constexpr BoardRole group(std::uint32_t number, Role role) noexcept { return {group(number), role}; }
struct GatewayBound {
    Role role;
};
/// The highest role that a gateway relays.
constexpr GatewayBound up_to(Role role) noexcept { return {role}; }
struct WithPanel {};
/// Marks a gateway whose users may be at the machine's panel.
inline constexpr WithPanel with_panel{};
/// gateway(user(990), up_to(Role::machine_operator)): the processes of this user, or of this group, are
/// gateways between the network and the machine.
constexpr BoardRole gateway(const BoardPeer& peer, GatewayBound bound) noexcept {
    return {peer, bound.role, true};
}
constexpr BoardRole gateway(const BoardPeer& peer, GatewayBound bound, WithPanel) noexcept {
    return {peer, bound.role, true, true};
}
/// The users and groups that may do more than observe, and the gateways; 16 rows at most.
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
/// The Ethernet interfaces of a board, each written with ethernet(); four at most.
template <class... Rows>
constexpr Bounded<BoardNetwork, 4> networks(const Rows&... rows) {
    return detail::list_of<BoardNetwork, 4>(rows...);
}

} // namespace tappet
