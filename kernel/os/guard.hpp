// SPDX-License-Identifier: Apache-2.0
// One program, two processes: the machine's, and its parent, the guardian's. The guardian observes the life
// and the end of the other one, whatever ends it. Its reaction is not decided here.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"
#include "kernel/os/crash.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>

#include <pthread.h>

namespace tappet::os {

/// Memory shared by both processes.
struct GuardBlock {
    pthread_mutex_t
        machine_lives; ///< robust: the kernel reports its owner's death long before that of the process
    std::atomic<std::int64_t> back_by_ns{
        0}; ///< time before which the machine's supervisor shows life; 0: it is not awaited
    std::atomic<bool> activities_run{false}; ///< from before the first start to the beginning of the stop
    std::atomic<bool> ended_well{false};     ///< set before an exit with every output safe
    std::atomic<bool> has_stopped{false};    ///< the machine has done for its outputs what it can
    std::atomic<bool> is_left{false};        ///< but that was not enough: do not wait for its end
    std::atomic<bool> is_ready{false};       ///< the guardian can act now
    std::atomic<bool> is_spared{false};      ///< the kernel does not kill the guardian when memory is short
    std::atomic<bool> has_refused{false};    ///< the guardian can never act; `refusal` says why
    std::atomic<std::int64_t> looked_ns{0};  ///< time of the guardian's last look
    Sentence refusal{};
    Sentence fault{}; ///< reason of the machine's stop; set before ended_well, and before its end
    CrashNote crash{};
    alignas(
        16) std::array<std::byte, 64> machines_own{}; ///< other data that the machine keeps for its guardian
};

/// One per process, for its whole life. Not real-time; in the machine's process only its supervisor uses it.
class Guard {
public:
    enum class Side : std::uint8_t { guardian, machine };
    /// The guardian counts as lost when it has not looked for this time.
    static constexpr Duration guardian_within = 1s;

    Guard() = default;
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;

    /// Forks: returns in both processes, with its side in each. Call it before there are threads. A thread
    /// that crashes waits for `crash_patience_ms` for the guardian to end it; then its signal does. An error
    /// names the cure, and then there is one process only.
    std::expected<Side, Sentence> split(int crash_patience_ms = 1000) noexcept;

    /// Usable in both processes, after a split.
    [[nodiscard]] std::span<std::byte, 64> machines_own() noexcept { return block_->machines_own; }

    // ---- in the machine's process; without a split() they do nothing, and the guardian is not lost

    [[nodiscard]] bool is_split() const noexcept { return block_ != nullptr; }
    /// Waits until the guardian can act, for a second at most. Returns why it cannot; empty: it can.
    [[nodiscard]] Sentence wait_for_guardian() noexcept;
    /// Returns whether the kernel ends other processes than the guardian when memory is short. Valid once it
    /// can act.
    [[nodiscard]] bool guardian_is_spared() const noexcept {
        return block_->is_spared.load(std::memory_order_acquire);
    }
    /// Shows that the supervisor lives, and will do so again within `time`. Each call renews the promise.
    void be_back_within(Duration time) noexcept;
    void let_activities_be_watched(bool watched) noexcept;
    /// not_sure: safe as far as is known; the guardian makes sure after the end of the process. unsafe: the
    /// guardian ends the process at once.
    enum class Outputs : std::uint8_t { safe, not_sure, unsafe };
    /// Announces the end. `fault`: the fault that stopped the machine; empty: the stop was requested.
    void end(Outputs outputs, const Sentence& fault) noexcept;
    /// Returns whether the guardian ended, or had not looked for guardian_within at three calls in a row:
    /// after a box was frozen all processes resume at once.
    [[nodiscard]] bool guardian_is_lost() noexcept;

    // ---- in the guardian's process

    /// Prepares the guardian: it passes on every signal, keeps only the descriptors in `kept`, runs above
    /// every thread of the box, is not killed when memory is short, and never waits to write. Returns false
    /// when its priority could not be raised.
    bool become_guardian(std::span<const int> kept) noexcept;
    /// Forgets an object that only the machine needs: its whole pages are given back and read as 0 from now
    /// on.
    template <class Object>
    static void forget(Object& object) noexcept {
        give_back(reinterpret_cast<std::uintptr_t>(&object), reinterpret_cast<std::uintptr_t>(&object + 1));
    }
    /// Locks the memory touched so far, except what earlier calls left on the stack.
    void stay_in_memory() noexcept;
    void refuse(const Sentence& why) noexcept;
    void be_ready() noexcept { block_->is_ready.store(true, std::memory_order_release); }

    /// dying: its main thread has ended, the rest follows; reported once.
    enum class Seen : std::uint8_t { nothing, crash, dying, end };
    /// Waits for an event of the machine's process, for `time` at most.
    [[nodiscard]] Seen look(Duration time) noexcept;
    [[nodiscard]] const GuardBlock& block() const noexcept { return *block_; }
    void kill() const noexcept;
    /// Runs `act` in a process of its own, without a real-time priority: a fault there, or a run longer than
    /// `time`, ends only that process. Returns false when it did not finish.
    template <class Do>
    bool try_apart(Duration time, Do&& act) noexcept {
        return try_apart(time, [](void* context) { (*static_cast<Do*>(context))(); }, &act);
    }
    /// Returns whether the process has ended, or ends within `time`. Then exit_code() is that of a shell: 128
    /// plus the number of a signal that ended it.
    [[nodiscard]] bool await_end(Duration time) noexcept;
    [[nodiscard]] int exit_code() const noexcept { return exit_code_; }

private:
    void send(int signal) const noexcept;
    static bool try_apart(Duration time, void (*act)(void*), void* context) noexcept;
    static void give_back(std::uintptr_t begin, std::uintptr_t end) noexcept;

    GuardBlock* block_ = nullptr;
    std::int32_t machine_ = -1;  // process of the machine
    std::int32_t guardian_ = -1; // process of the guardian
    int machine_descriptor_ = -1;
    int signals_ = -1;
    int crash_ = -1;
    int exit_code_ = 128 + 9; // until it is known: the code of a killed process that does not end
    bool has_ended_ = false;
    bool is_owned_ = false; // machine_lives was locked
    int stale_looks_ = 0;
};

} // namespace tappet::os
