// Starting and stopping parts of a running machine (thesis 3.1.3, 4.2.2).
#pragma once

#include "kernel/machine/instance/placed.hpp"

#include <array>

namespace tappet {

/// How a world lets the engine of an activity start and stop. Called by the supervisor's thread.
struct ActivityControl {
    void* world = nullptr;
    bool (*start)(void* world, std::size_t activity) = nullptr; ///< false: its thread did not come up
    /// False: its thread hangs; the engine's stop was run in its place.
    bool (*stop)(void* world, std::size_t activity) = nullptr;
    /// Before each change that somebody asked for: initialise and finalise may take their time.
    void (*begins)(void* world) = nullptr;
};

/// The life of components and activities. Asking is real-time, on any thread.
class MachineLife {
public:
    MachineLife(PlacedMachine& placed, os::Waiter& supervisor) noexcept
        : placed_{placed}, machine_{placed.machine()}, supervisor_{supervisor} {}

    /// Starts, stops or restarts one component while the rest goes on: its engine does it between two steps,
    /// and answers.
    LifeTicket ask_component(std::size_t index, LifeChange change) noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer answer_of_component(std::size_t index, LifeTicket ticket) noexcept
        TAPPET_REALTIME;
    [[nodiscard]] ComponentState state_of(std::size_t component) noexcept TAPPET_REALTIME;
    /// The same for a whole activity, with initialise and finalise of its components: the supervisor does it.
    LifeTicket ask_activity(std::size_t index, LifeChange change) noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer answer_of_activity(std::size_t index, LifeTicket ticket) const noexcept
        TAPPET_REALTIME;
    /// What a refusal says, with its cure; empty when nothing was refused. Not real-time.
    [[nodiscard]] Sentence describe(std::size_t activity, LifeAnswer answer) const;

    // ---- for worlds, on the supervisor's thread; not real-time

    /// In the table's order; the first refusal ends it.
    [[nodiscard]] Sentence start_activities(const ActivityControl& control);
    /// Empty: done. To start, what its components read from other activities must be valid.
    [[nodiscard]] Sentence change_activity(std::size_t index, LifeChange change,
                                           const ActivityControl& control) {
        LifeAnswer answer;
        return change_activity(index, change, control, answer);
    }
    void serve_activity_requests(const ActivityControl& control);
    /// No activity runs, and no thread of one was given up while it hung.
    [[nodiscard]] bool stands() const noexcept;

private:
    [[nodiscard]] Sentence change_activity(std::size_t index, LifeChange change,
                                           const ActivityControl& control, LifeAnswer& answer);
    [[nodiscard]] Sentence initialise_and_start(std::size_t index, const ActivityControl& control,
                                                LifeAnswer& answer);

    PlacedMachine& placed_;
    const AcceptedMachine& machine_;
    os::Waiter& supervisor_;
    std::array<LifeRequests, max_activities> activity_requests_{};
    std::array<bool, max_activities> thread_lost_{};
};

} // namespace tappet
