// Digital lines of the host world: the machine uses them as a Device, the plant drives the other ends.
#pragma once

#include "drivers/gpio/far_end.hpp"
#include "drivers/gpio/line_plan.hpp"
#include "drivers/twin/ring.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/base/random.hpp"

#include <atomic>

namespace tappet::gpio {

/// Injected faults of one input.
struct LineFaults {
    std::uint32_t lose_next = 0;     ///< the next edges are lost: counted by the kernel, never delivered
    std::uint32_t lose_one_in = 0;   ///< and one in this many of the others; 0: none
    std::uint32_t bounces = 0;       ///< extra pairs of edges after each change ...
    Duration bounce_spacing = 200us; ///< ... this far apart
    Duration delay{};                ///< edges are delivered this much later, with correct stamps
};

/// The Device's calls belong to the machine's thread; drive(), deliver_until() and the faults belong to the
/// plant's. They share only a ring and two words. Levels are logical on both sides.
class Twin final : public PlannedLines, public Wires {
public:
    static constexpr std::size_t event_buffer = 1024; // the largest that Linux grants

    explicit Twin(std::uint64_t seed = 1) noexcept : random_{seed} {}

    /// Opens the twin. Not real-time, before either thread runs.
    std::expected<void, Sentence> open(const Settings& settings);

    EdgeBatch read_edges(std::span<Edge> edges) noexcept TAPPET_REALTIME override;
    Levels levels() noexcept TAPPET_REALTIME override;
    bool write(Mask mask, Mask values) noexcept TAPPET_REALTIME override;
    [[nodiscard]] int wait_handle() const noexcept TAPPET_REALTIME override { return -1; }
    /// `ready` is called in the plant's thread.
    void set_listener(Listener ready, void* context) noexcept override;

    // The plant's side; real-time.
    /// Changes an input at `at`, which is not before the last deliver_until. Returns false when 64 changes
    /// are already queued.
    bool drive(std::size_t line, bool active, Time at) noexcept TAPPET_REALTIME override;
    /// Processes the changes due by `now`: bounce, debounce, edges, then the listener.
    void deliver_until(Time now) noexcept TAPPET_REALTIME;
    /// Returns the outputs as the machine wrote them, one bit per line.
    [[nodiscard]] Mask outputs() const noexcept TAPPET_REALTIME override {
        return driven_.load(std::memory_order_acquire);
    }
    /// Fault: removes the chip. Writes are refused and change no output, levels are unknown, reads fail, and
    /// the listener is called, as a descriptor hangs up. `false` brings it back unchanged, without a call.
    void set_removed(bool removed) noexcept TAPPET_REALTIME {
        removed_.store(removed, std::memory_order_release);
        arrived_ |= removed;
    }
    /// Fault: the chip refuses this many of the machine's next calls.
    void refuse(std::uint32_t calls) noexcept TAPPET_REALTIME {
        refusals_.store(calls, std::memory_order_release);
    }
    /// Returns true when no change or edge is pending.
    [[nodiscard]] bool is_still() const noexcept TAPPET_REALTIME {
        return changes_.empty() && late_.empty() && raw_ == inputs_.load(std::memory_order_relaxed);
    }
    LineFaults& faults(std::size_t line) noexcept TAPPET_REALTIME { return faults_[line]; }
    /// Holds the input at this level, whatever drives it, until release(); then it takes the driven level.
    void stick(std::size_t line, bool active, Time at) noexcept TAPPET_REALTIME;
    void release(std::size_t line, Time at) noexcept TAPPET_REALTIME;

private:
    struct Change {
        Time at{};
        std::uint32_t order = 0; // keeps the order of changes at the same time
        std::uint32_t line = 0;
        bool active = false;
        bool operator==(const Change&) const = default;
    };
    struct Late {
        Edge edge{};
        Time due{};
        bool operator==(const Late&) const = default;
    };
    /// Returns true, and counts it, when the chip refuses the machine's call.
    [[nodiscard]] bool refuses() noexcept TAPPET_REALTIME {
        const std::uint32_t left = refusals_.load(std::memory_order_acquire);
        if (left != 0) refusals_.store(left - 1, std::memory_order_release);
        const bool refused = left != 0 || removed_.load(std::memory_order_acquire);
        count_.failures += refused ? 1u : 0u;
        return refused;
    }
    void change_raw(std::size_t line, bool active, Time at) noexcept TAPPET_REALTIME;
    bool schedule(std::size_t line, bool active, Time at) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool next_change(Time now, Change& change) noexcept TAPPET_REALTIME;
    void settle(Time now) noexcept TAPPET_REALTIME;
    void commit(std::uint32_t line, bool active, Time at) noexcept TAPPET_REALTIME;
    void deliver_late(Time now) noexcept TAPPET_REALTIME;
    void deliver(const Edge& edge) noexcept TAPPET_REALTIME;

    std::span<const Line> lines_{};
    twin::Ring<Edge, event_buffer> edges_{};
    std::atomic<Mask> inputs_{0};
    std::atomic<Mask> driven_{0};
    std::atomic<std::uint32_t> refusals_{0};
    std::atomic<bool> removed_{false};
    // Used by the plant's thread only.
    Random random_;
    std::array<LineFaults, most_lines> faults_{};
    std::array<Time, most_lines> raw_since_{}; // when the undebounced level last changed
    Mask raw_ = 0;
    Mask driven_to_ = 0; // the level that a stuck line is driven to
    Mask stuck_ = 0;
    Bounded<Change, 64> changes_{};
    Bounded<Late, 64> late_{};
    std::uint32_t order_ = 0;
    std::uint32_t seqno_ = 0;
    bool arrived_ = false;
    Listener ready_ = nullptr;
    void* context_ = nullptr;
};

} // namespace tappet::gpio
