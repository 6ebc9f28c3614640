// SPDX-License-Identifier: Apache-2.0
// The duration of the orderly stop, as the table claims it, against the limit of the board.
#pragma once

#include "kernel/machine/check/components.hpp"
#include "kernel/machine/table/board.hpp"

namespace tappet::checks {

/// The parts of a stop, from the request to safe outputs.
struct StopPromise {
    Duration begins{};     ///< the supervisor's, which is not real-time
    Duration may_block{};  ///< for all activities that are not real-time, together
    Duration responses{};  ///< two for each real-time activity: the running cycle, and its stop
    Duration behaviours{}; ///< reaching final states, for each activity that has behaviours
    [[nodiscard]] constexpr Duration sum() const noexcept {
        return begins + may_block + responses + behaviours;
    }
};

/// Computes the promise of an accepted table. `worst_response_ns`: of each activity.
constexpr StopPromise promised_stop(const MachineView& m, const Board& board,
                                    std::span<const std::size_t> activity_of,
                                    std::span<const std::int64_t> worst_response_ns) {
    StopPromise promise{.begins = board.stop_begins_within()};
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        if (!m.activities[a].real_time) {
            promise.may_block = Board::stop_grace;
            continue;
        }
        promise.responses += 2 * Duration{worst_response_ns[a]} + 1ms; // how often the supervisor looks
        for (const BehaviourRow& each : m.behaviours) {
            const std::size_t c = find_component(m, each.component);
            if (c == nowhere || activity_of[c] != a) continue;
            promise.behaviours += Engine::end_limit;
            break;
        }
    }
    return promise;
}

/// Checks the promise against stop_within; needs the response times.
constexpr Sentence check_stop(const MachineView& m, const Board& board, const TableIndexView& r) {
    const StopPromise promise = promised_stop(m, board, r.activity, r.worst_response_ns);
    if (promise.sum() <= board.stop_within) return {};
    const auto in_ms = [](Duration time) { return Sentence{(time + 999'999ns) / 1ms, " ms"}; };
    // A quarter of stop_within is for the beginning.
    const Duration enough = (promise.sum() - promise.begins) / 3 * 4;
    return Sentence{"board \"",
                    board.name,
                    "\": stop_within is ",
                    in_ms(board.stop_within),
                    ", but a stop may take ",
                    in_ms(promise.sum()),
                    ": ",
                    in_ms(promise.begins),
                    " until it begins, ",
                    in_ms(promise.responses),
                    " for two responses of each real-time activity, ",
                    in_ms(promise.behaviours),
                    " for the ends of behaviours, ",
                    in_ms(promise.may_block),
                    " for what may block; write stop_within = ",
                    (enough + 999'999ns) / 1ms + 1,
                    "ms into the board, or shorten deadlines"};
}

} // namespace tappet::checks
