// SPDX-License-Identifier: Apache-2.0
// One program, two processes: the machine's, and the guardian's, which is its parent. The guardian sees how
// the other lives and ends, whatever ends it; what it does then is not decided here.
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

/// Memory of both.
struct GuardBlock {
    pthread_mutex_t
        machine_lives; ///< robust: the kernel tells its owner's death long before that of the process
    std::atomic<std::int64_t> back_by_ns{
        0}; ///< the machine's supervisor shows life before; 0: nobody waits for it
    std::atomic<bool> activities_run{false}; ///< from before the first start to the beginning of the stop
    std::atomic<bool> ended_well{false};     ///< what comes is an exit with every output safe
    std::atomic<bool> has_stopped{false};    ///< the machine has done what it can do for its outputs
    std::atomic<bool> is_left{false};        ///< which is not enough: nobody waits for its end
    std::atomic<bool> is_ready{false};       ///< the guardian could act now
    std::atomic<bool> is_spared{false};      ///< the guardian, when the kernel is short of memory
    std::atomic<bool> has_refused{false};    ///< it never can; `refusal` says why
    std::atomic<std::int64_t> looked_ns{0};  ///< when the guardian looked last
    Sentence refusal{};
    Sentence fault{}; ///< that stopped the machine; before ended_well, and before its end
    CrashNote crash{};
    alignas(
        16) std::array<std::byte, 64> machines_own{}; ///< what else the machine keeps there for its guardian
};

/// Of one process, for its whole life. Not real-time; in the machine's process its supervisor's.
class Guard {
public:
    enum class Side : std::uint8_t { guardian, machine };
    /// The guardian counts as gone when it looked at nothing for so long.
    static constexpr Duration guardian_within = 1s;

    Guard() = default;
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;

    /// Forks: from here on this is the one or the other. Before there are threads. A thread that crashes
    /// waits for so long that the guardian ends it; then its signal does. An error names the cure, and then
    /// there is one process only.
    std::expected<Side, Sentence> split(int crash_patience_ms = 1000) noexcept;

    /// In both, after a split.
    [[nodiscard]] std::span<std::byte, 64> machines_own() noexcept { return block_->machines_own; }

    // ---- in the machine's process; without a split() they do nothing, and the guardian is not lost

    [[nodiscard]] bool is_split() const noexcept { return block_ != nullptr; }
    /// Empty once the guardian can act; else why not, after a second at most.
    [[nodiscard]] Sentence wait_for_guardian() noexcept;
    /// When memory is short the kernel ends others than the guardian. Once it can act.
    [[nodiscard]] bool guardian_is_spared() const noexcept {
        return block_->is_spared.load(std::memory_order_acquire);
    }
    /// The supervisor shows life, and will again within `time`; at each call anew.
    void be_back_within(Duration time) noexcept;
    void let_activities_be_watched(bool watched) noexcept;
    /// not_sure: safe as far as is known; the guardian makes sure when the process has ended. unsafe: it ends
    /// the process at once.
    enum class Outputs : std::uint8_t { safe, not_sure, unsafe };
    /// It ends now. `fault`: what stopped the machine, though nobody asked for it; empty: somebody did.
    void end(Outputs outputs, const Sentence& fault) noexcept;
    /// It ended, or looked at nothing for so long in three calls one after the other: after a box was frozen
    /// all begin at once.
    [[nodiscard]] bool guardian_is_lost() noexcept;

    // ---- in the guardian's

    /// Takes no signal but to hand it on, keeps the descriptors in `kept` and no other, stands above every
    /// thread of the box, is no victim when memory is short, and never waits to write. False: it could not be
    /// put above.
    bool become_guardian(std::span<const int> kept) noexcept;
    /// The machine's alone: whole pages in it are given back and read as 0 from here on.
    template <class Object>
    static void forget(Object& object) noexcept {
        give_back(reinterpret_cast<std::uintptr_t>(&object), reinterpret_cast<std::uintptr_t>(&object + 1));
    }
    /// What was touched until now stays in memory, but for what earlier calls left on the stack.
    void stay_in_memory() noexcept;
    void refuse(const Sentence& why) noexcept;
    void be_ready() noexcept { block_->is_ready.store(true, std::memory_order_release); }

    /// dying: its main thread is no more, the rest follows; told once.
    enum class Seen : std::uint8_t { nothing, crash, dying, end };
    /// Waits for something of the machine's process, at most so long.
    [[nodiscard]] Seen look(Duration time) noexcept;
    [[nodiscard]] const GuardBlock& block() const noexcept { return *block_; }
    void kill() const noexcept;
    /// Does it in a process of its own, which stands above nobody: what goes wrong there, or takes longer
    /// than `time`, ends that one alone. False: it did not come to its end.
    template <class Do>
    bool try_apart(Duration time, Do&& act) noexcept {
        return try_apart(time, [](void* context) { (*static_cast<Do*>(context))(); }, &act);
    }
    /// Whether its end is there, or comes within `time`. Then exit_code() is as a shell tells it: 128 and the
    /// number of the signal that ended it.
    [[nodiscard]] bool await_end(Duration time) noexcept;
    [[nodiscard]] int exit_code() const noexcept { return exit_code_; }

private:
    void send(int signal) const noexcept;
    static bool try_apart(Duration time, void (*act)(void*), void* context) noexcept;
    static void give_back(std::uintptr_t begin, std::uintptr_t end) noexcept;

    GuardBlock* block_ = nullptr;
    std::int32_t machine_ = -1;  // its process
    std::int32_t guardian_ = -1; // that of this
    int machine_descriptor_ = -1;
    int signals_ = -1;
    int crash_ = -1;
    int exit_code_ = 128 + 9; // until it is known: of one that was killed and does not end
    bool has_ended_ = false;
    bool is_owned_ = false; // machine_lives
    int stale_looks_ = 0;
};

} // namespace tappet::os
