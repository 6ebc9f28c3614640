// Reaction rows: which operation runs upon which event, and in whose activity.
#pragma once

#include <cstdint>
#include <string_view>

namespace tappet {

struct ReactionTarget {
    std::string_view operation{};
    bool synchronous = false;
    std::uint32_t quota = 8;
};
struct Queue {
    std::uint32_t n;
};
/// How many unserved emissions of this row may wait; one more is lost and counted. Eight unless stated.
constexpr Queue queue(std::uint32_t n) noexcept { return {n}; }

/// Asynchronous: in the receiver's engine, with the arguments of the emission.
constexpr ReactionTarget tell(std::string_view operation, Queue waiting = {8}) noexcept {
    return {operation, false, waiting.n};
}
/// Synchronous: in the emitter, here and now.
constexpr ReactionTarget call(std::string_view operation) noexcept { return {operation, true, 0}; }

/// What a row of the section reactions says.
enum class ReactionKind : std::uint8_t {
    when, ///< an operation runs upon an event
    uses  ///< a requester of one component reaches a method or a command of another
};
struct ReactionRow {
    std::string_view event{}; ///< of a uses row: the requester
    ReactionTarget target;    ///< of a uses row: its operation is the method or command
    ReactionKind kind = ReactionKind::when;
    std::string_view sent_by{}; ///< of a uses row: the component that sends the command; empty: the requester
};
constexpr ReactionRow when(std::string_view event, ReactionTarget target) noexcept {
    return {event, target, ReactionKind::when, {}};
}

struct SentBy {
    std::string_view component{};
};
/// The command object is sent by this component, to which it is handed on, in that component's activity.
constexpr SentBy sent_by(std::string_view component) noexcept { return {component}; }

/// A requester (a MethodCall or a CommandCall) of one component reaches a method or a command of another.
constexpr ReactionRow uses(std::string_view requester, std::string_view operation, SentBy by = {}) noexcept {
    return {requester, {operation, false, 0}, ReactionKind::uses, by.component};
}

} // namespace tappet
