// Requests that wait for an answer: one table, and one rule for all of them. The service checks each one in
// every cycle until it is over. A client that has waited too long is told that nothing was done, or that it
// may still happen.
#pragma once

#include "kernel/machine/instance/line_functions.hpp"
#include "kernel/services/browsing/access.hpp"
#include "kernel/services/browsing/behaviour_order.hpp"
#include "kernel/services/browsing/why_order.hpp"
#include "kernel/services/configuration/property_saving.hpp"
#include "kernel/services/engine_call.hpp"

#include <array>
#include <cstdint>
#include <variant>

namespace tappet {

class BrowserService;

namespace browsing {

/// The client that asked, and receives the answer.
struct Asker {
    std::uint64_t client = 0; ///< serial
    std::uint32_t number = 0; ///< of the request
    Time since{};
    Role role = Role::engineer;
    UserName user{}; ///< for whom it asked, if not for itself
};

/// A port to force or release, or an operation or a method to call.
struct FacetCall {
    static constexpr std::size_t max_value_bytes = 512;

    MachineInstance* machine = nullptr;
    End end{};
    const Facet* facet = nullptr;
    void* place = nullptr;      ///< of the port, or the component
    bool refused = false;       ///< set by the engine: the component had stopped by then
    bool drives = false;        ///< the port of a driver that controls what it sends
    bool never_written = false; ///< set by the engine: an unwritten output or sent value is not forced
    alignas(
        16) std::array<std::byte, max_value_bytes> value{}; ///< of a method: the result after the arguments
};

/// A command, followed to its end.
struct FollowedCommand {
    End command{};
    CommandState told = CommandState::sent;
    CommandSlot slot{};
    alignas(16) std::array<std::byte, 256> values{};
};

/// A component, or a whole activity, that is to start or to stop.
struct FollowedLife {
    std::size_t component = nowhere;
    std::size_t activity = nowhere;
    LifeTicket ticket{};
    LifeChange change{};
};

/// A line of the script language that its interpreter executes.
struct FollowedLine {
    const LineFunctions* functions = nullptr;
    void* interpreter = nullptr;
};

struct Pending {
    Asker asker{};
    /// Checks the request. True: it is over, and its client was answered. Null: the place is free.
    bool (BrowserService::*look)(Pending&) = nullptr;
    bool is_told = false; ///< its client was told that no answer comes, or no client waits for one
    EngineCall call{};    ///< the part that one engine does
    std::variant<std::monostate, FacetCall, BehaviourOrder, PropertyTransaction, FollowedCommand,
                 FollowedLife, FollowedLine, PropertySaving, WhyOrder>
        work{};
};

} // namespace browsing
} // namespace tappet
