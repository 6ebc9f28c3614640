// State of a running machine for observers: its map, its events, its counters.
#pragma once

#include "kernel/machine/instance/placed.hpp"
#include "kernel/os/shared_memory.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// Answers a browser's request: writes the answer to `into` and returns its length; 0: none.
struct BrowsingAnswerer {
    std::size_t (*answer)(void* self, std::string_view request, std::span<char> into) = nullptr;
    void* self = nullptr;
};

/// Any thread, not real-time except where stated.
class MachineObservation {
public:
    explicit MachineObservation(PlacedMachine& placed) noexcept
        : placed_{placed}, machine_{placed.machine()} {}

    /// Returns the memory that other processes may map, read-only: the machine's map and its values, see
    /// map/layout.hpp. Empty when no component sees the machine. The stacks lie outside.
    [[nodiscard]] std::span<const std::byte> shared_memory() const noexcept {
        return machine_.map.empty() ? std::span<const std::byte>{}
                                    : machine_.memory.first(machine_.plan.shared_bytes);
    }
    /// Returns the descriptor of that memory, to pass on; -1: none.
    [[nodiscard]] int shared_descriptor() const noexcept { return shared_.descriptor(); }
    /// Records in its memory that the machine continues in this process (after a fork).
    void be_this_process() noexcept;
    /// Returns how many of its ports are forced now; requires a component that sees the machine. Real-time.
    [[nodiscard]] std::atomic<std::uint32_t>& forced_ports() const noexcept TAPPET_REALTIME {
        return placed_.at<Observed>(machine_.plan.observed_at)->forced;
    }

    /// Sets the observer that is called at each emission of the events connected by observe_event(), in the
    /// activity of the component that sees the machine. Call it during configuration.
    void show_events_to(const EventObserver& observer) noexcept { event_observer_ = observer; }
    /// Sets the answers of the component that serves browsers. Call it during configuration.
    void answer_by(const BrowsingAnswerer& answerer) noexcept { answerer_ = answerer; }
    /// Sets the place in the machine's memory where a reader of recorded values begins, for the section that
    /// records them. Call it during configuration.
    void records_at(const void* directory) noexcept { records_ = directory; }
    /// Returns the answer of a machine that no longer runs to a read-only request, see
    /// kernel/services/browsing/protocol.hpp; empty: none. Data of an interrupted cycle may be half written,
    /// and damaged data may crash the caller.
    [[nodiscard]] std::string_view ask(std::string_view request, std::span<char> into) const {
        if (answerer_.answer == nullptr) return {};
        return {into.data(), answerer_.answer(answerer_.self, request, into)};
    }

    /// Returns a handle that connects and disconnects the observer and one event; the event's number there is
    /// observed_index(). The handle is invalid when nothing sees the machine, or the event's arguments exceed
    /// most_observed_bytes. The handle is real-time, finding it is not.
    [[nodiscard]] EventHandle observe_event(std::size_t component, std::size_t facet) noexcept;
    /// Returns the index in plan().subscriptions; nowhere: the event cannot be observed.
    [[nodiscard]] std::size_t observed_index(End event) const noexcept;
    /// Returns the counts of one of the plan's subscriptions; none for a synchronous one. Real-time.
    [[nodiscard]] SubscriptionCounts counts_of(std::size_t subscription) const noexcept TAPPET_REALTIME;

    /// Returns the latencies of a reaction row that tells, or a connection row that wakes, measured when an
    /// edge or a frame triggered it; null for other rows. Consistent only between two cycles of the receiver.
    /// Rows by their number in the table.
    [[nodiscard]] const ReactionTimes* times_of_reaction(std::size_t row) const noexcept;
    [[nodiscard]] const ReactionTimes* times_of_connection(std::size_t row) const noexcept;

    /// Returns the count of a row of a section outside of kernel/machine, such as limits; row by row, section
    /// by section.
    [[nodiscard]] SectionCount counted(std::size_t section, std::size_t row) const noexcept;

    /// Returns the deepest stack use of an activity's thread so far, in bytes; takes time in proportion to
    /// the unused part. 0: the thread has no stack of its own in this world.
    [[nodiscard]] std::size_t stack_high_water_bytes(std::size_t activity) const noexcept;

    /// Reports that an activity used more of its processor than its row claims, with the cure; empty: it did
    /// not. The analysis of the table relies on the claim.
    [[nodiscard]] Sentence describe_budget(std::size_t activity) const;
    /// Reports that behaviours of a stopped activity did not reach their final states within
    /// Engine::end_limit, with the cure; empty: all did, or the activity runs.
    [[nodiscard]] Sentence describe_end(std::size_t activity) const;
    /// Returns a digest over every engine, in order: equal for two runs that did the same.
    [[nodiscard]] std::uint64_t event_log_digest() const noexcept;
    /// Returns the emissions that found their queue full, over the rows that keep each one: keep_latest drops
    /// older ones by design, and an observer is told itself what it missed.
    [[nodiscard]] std::uint64_t lost_emissions() const noexcept;
    /// Returns the messages and synchronous reactions that met a component that did not run, over all rows.
    [[nodiscard]] std::uint64_t dropped_messages() const noexcept;

private:
    friend class MachineBuilder;

    PlacedMachine& placed_;
    const AcceptedMachine& machine_;
    os::SharedMemory shared_{};
    EventObserver event_observer_{};
    BrowsingAnswerer answerer_{};
    const void* records_ = nullptr;
};

} // namespace tappet
