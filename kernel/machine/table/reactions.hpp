// Reaction rows: the operation that runs upon an event, and the activity that runs it.
#pragma once

#include "kernel/base/row_option.hpp"

#include <cstdint>
#include <string_view>

namespace tappet {

struct ReactionTarget {
    std::string_view operation{};
    bool synchronous = false;
    std::uint32_t quota = 8;
    bool keeps_latest = false;
};
struct Queue {
    std::uint32_t n;
    bool latest = false;
};
/// How many unserved emissions of this row may wait; a further one is lost and counted. Default: 8.
constexpr Queue queue(std::uint32_t n) noexcept { return {n}; }
/// Only the latest unserved emission of this row waits; the emissions it replaced are counted as lost.
inline constexpr Queue keep_latest{1, true};

/// Asynchronous: runs in the receiver's engine, with the arguments of the emission. The target is an
/// operation or an EventWait.
constexpr ReactionTarget tell(std::string_view operation, Queue waiting = {8}) noexcept {
    return {operation, false, waiting.n, waiting.latest};
}
/// Synchronous: runs at once, in the emitter.
constexpr ReactionTarget call(std::string_view operation) noexcept { return {operation, true, 0, false}; }

/// The kinds of rows in the section reactions.
enum class ReactionKind : std::uint8_t {
    when, ///< an operation runs upon an event
    uses  ///< a requester of one component reaches a method or a command of another
};
struct ReactionRow {
    std::string_view event{}; ///< of a uses row: the requester
    ReactionTarget target;    ///< of a uses row: its operation is the method or command
    ReactionKind kind = ReactionKind::when;
    std::string_view sent_by{}; ///< of a uses row: the component that sends the command; empty: the requester
    std::string_view handle{};  ///< of a when row: the EventHandle that connects and disconnects it
    bool is_connected = true;   ///< of a when row: from the start
};

struct SentBy {
    std::string_view component{};
};
/// The command object is handed on to this component, which sends it, in that component's activity.
constexpr SentBy sent_by(std::string_view component) noexcept { return {component}; }

/// A requester (a MethodCall or a CommandCall) of one component reaches a method or a command of another.
constexpr ReactionRow uses(std::string_view requester, std::string_view operation, SentBy by = {}) noexcept {
    ReactionRow row;
    row.event = requester;
    row.kind = ReactionKind::uses;
    row.sent_by = by.component;
    row.target.operation = operation;
    row.target.quota = 0;
    return row;
}

/// The EventHandle, as component.handle, that connects and disconnects the row while the machine runs.
constexpr RowOption<ReactionRow, std::string_view> handled_by(std::string_view handle) noexcept {
    return {&ReactionRow::handle, handle};
}
/// The row stays disconnected until its handle connects it.
inline constexpr RowOption disconnected{&ReactionRow::is_connected, false};

/// Runs at each emission of the event, given as component.event: tell(...) or call(...).
template <class... Options>
constexpr ReactionRow when(std::string_view event, ReactionTarget target, Options... options) noexcept {
    ReactionRow row;
    row.event = event;
    row.target = target;
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
