// What a machine tells about itself while it runs: its map, its events, its counters.
#pragma once

#include "kernel/machine/instance/placed.hpp"
#include "kernel/os/shared_memory.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// Answers what a browser may ask, and writes the answer to `into`; returns its length, 0 for none.
struct BrowsingAnswerer {
    std::size_t (*answer)(void* self, std::string_view request, std::span<char> into) = nullptr;
    void* self = nullptr;
};

/// Any thread, not real-time but for what says so.
class MachineObservation {
public:
    explicit MachineObservation(PlacedMachine& placed) noexcept
        : placed_{placed}, machine_{placed.machine()} {}

    /// What others may map, read-only, of a machine that a component sees: its map and its values, see
    /// map/layout.hpp; empty otherwise. The stacks lie outside.
    [[nodiscard]] std::span<const std::byte> shared_memory() const noexcept {
        return machine_.map.empty() ? std::span<const std::byte>{}
                                    : machine_.memory.first(machine_.plan.shared_bytes);
    }
    /// The same as a descriptor to give away; -1 when there is none.
    [[nodiscard]] int shared_descriptor() const noexcept { return shared_.descriptor(); }
    /// The machine went on in another process (a fork): its memory says which.
    void be_this_process() noexcept;
    /// How many ports of it are forced now, of a machine that a component sees. Real-time.
    [[nodiscard]] std::atomic<std::uint32_t>& forced_ports() const noexcept TAPPET_REALTIME {
        return placed_.at<Observed>(machine_.plan.observed_at)->forced;
    }

    /// Who is called, in the activity of what sees the machine, with each emission that observe_event()
    /// connected. While the machine is configured.
    void show_events_to(const EventObserver& observer) noexcept { event_observer_ = observer; }
    /// The component that browsers ask says how it answers. While the machine is configured.
    void answer_by(const BrowsingAnswerer& answerer) noexcept { answerer_ = answerer; }
    /// The section that records values says where, in the machine's memory, a reader begins. While the
    /// machine is configured.
    void records_at(const void* directory) noexcept { records_ = directory; }
    /// The answer of a machine that runs no more to a request that only reads, see
    /// kernel/services/browsing/protocol.hpp; empty: it has none. What stood in the middle of a cycle may be
    /// half written, and what is damaged may end who asks.
    [[nodiscard]] std::string_view ask(std::string_view request, std::span<char> into) const {
        if (answerer_.answer == nullptr) return {};
        return {into.data(), answerer_.answer(answerer_.self, request, into)};
    }

    /// Connects and disconnects the observer and one event; the event's number there is observed_index(). Not
    /// valid when nothing sees the machine, or the event's arguments exceed most_observed_bytes. The
    /// handle is real-time, finding it is not.
    [[nodiscard]] EventHandle observe_event(std::size_t component, std::size_t facet) noexcept;
    /// In plan().subscriptions; nowhere: it cannot be observed.
    [[nodiscard]] std::size_t observed_index(End event) const noexcept;
    /// Of one of the plan's subscriptions; nothing for a synchronous one. Real-time.
    [[nodiscard]] SubscriptionCounts counts_of(std::size_t subscription) const noexcept TAPPET_REALTIME;

    /// How long a reaction row that tells, or a connection row that wakes, took each time an edge or a frame
    /// set it off; null for other rows. Consistent between two cycles of the receiver only. Rows by their
    /// number in the table.
    [[nodiscard]] const ReactionTimes* times_of_reaction(std::size_t row) const noexcept;
    [[nodiscard]] const ReactionTimes* times_of_connection(std::size_t row) const noexcept;

    /// What a row of a section outside of kernel/machine, such as limits, has counted so far; row by row,
    /// section by section.
    [[nodiscard]] SectionCount counted(std::size_t section, std::size_t row) const noexcept;

    /// The deepest that an activity's thread has used its stack so far, in bytes; it takes time in proportion
    /// to what it did not use. 0: it has no stack of its own in this world.
    [[nodiscard]] std::size_t stack_high_water_bytes(std::size_t activity) const noexcept;

    /// That an activity used more of its processor than its row claims, and the cure; empty: it did not. The
    /// analysis of the table believed the claim.
    [[nodiscard]] Sentence describe_budget(std::size_t activity) const;
    /// That behaviours of an activity that was stopped had not come to their final states within
    /// Engine::end_limit, and the cure; empty: all had, or it goes on.
    [[nodiscard]] Sentence describe_end(std::size_t activity) const;
    /// Of every engine, in order: equal for two runs that did the same.
    [[nodiscard]] std::uint64_t event_log_digest() const noexcept;
    /// Emissions that found their queue full, over the rows that keep each one: keep_latest lets older ones
    /// go, and who only observes is told itself what it missed.
    [[nodiscard]] std::uint64_t lost_emissions() const noexcept;
    /// Messages and synchronous reactions that met a component that did not run, over all rows.
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
