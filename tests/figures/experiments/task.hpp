// The one kind of task of all experiments (thesis A.2.2): a load, and its exchange with the activities above
// and below. A property selects one of the five settings.
#pragma once

#include "kernel/activity/timing.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/component/component.hpp"
#include "kernel/exchange/mailbox.hpp"
#include "tests/figures/experiments/load.hpp"
#include "tests/figures/experiments/locked.hpp"
#include "tests/figures/measure/ticks.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

namespace experiments {
/// How the activities of an application communicate.
enum class Setting : std::uint8_t { none, locked, data, commands, events };
inline constexpr std::array<std::string_view, 5> setting_names{"none", "locked", "data", "commands",
                                                               "events"};
} // namespace experiments

template <>
inline constexpr auto names_of<experiments::Setting> = experiments::setting_names;

namespace experiments {

/// 160 bytes: enough to steer 20 degrees of freedom.
using Packet = std::array<double, 20>;
static_assert(sizeof(Packet) == 160);

/// The record of one execution of a task. Times in ticks of the time stamp counter, without the stamps' own
/// cost.
struct Execution {
    std::uint64_t begin = 0;        ///< as read
    std::uint32_t busy = 0;         ///< from begin to the end of the step
    std::uint32_t exchange = 0;     ///< part of busy, around data flow
    std::uint32_t sent = 0;         ///< part of busy, around sending commands or emitting events
    std::uint32_t copies = 0;       ///< as many bare copies of packets as data ports are connected
    std::uint32_t one_message = 0;  ///< a message stored in place, and announced by an atomic OR
    std::uint32_t two_messages = 0; ///< two of them, in two places
    std::uint32_t served = 0;       ///< commands or events between this execution and the next
    std::uint64_t serving = 0;      ///< ns: their total, each from the end of the step or of the one before
};

/// The ports of a task as channels behind mutexes; null: the row is not in the table. Filled from the rows of
/// the machine.
struct LockedPorts {
    LockedData<Packet>* to_higher = nullptr;
    LockedData<Packet>* to_lower = nullptr;
    LockedData<Packet>* from_higher = nullptr;
    LockedData<Packet>* from_lower = nullptr;
    LockedBuffer<Packet>* fill = nullptr;
    LockedBuffer<Packet>* drain = nullptr;
};

/// Given to a task before its machine is armed.
struct Assignment {
    LockedPorts ports{};
    std::size_t fill_at_most = 0;  ///< packets that one execution pushes: the whole buffer, or one
    std::size_t drain_at_most = 0; ///< and pops
    double turns_per_ns = 0;
    std::uint64_t ticks_of_stamps = 0;         ///< between two stamps with nothing in between
    const FunctionTiming* reactions = nullptr; ///< of this task, as its own engine keeps it
    std::span<Execution> record{};
};

struct Task {
    Property<Duration> load{};
    Property<Setting> setting{Setting::none};
    Output<Packet> to_higher, to_lower;
    Input<Packet> from_higher, from_lower;
    BufferOutput<Packet> fill;
    BufferInput<Packet> drain;
    CommandCall<> ask_higher, ask_lower;
    Event<std::uint64_t> pulse;

    /// Call before the machine is armed.
    void assign(const Assignment& assignment);

    void start(const Cycle&) noexcept TAPPET_REALTIME;
    void step(const Cycle&) noexcept TAPPET_REALTIME;

    bool serve_higher() noexcept TAPPET_REALTIME;
    bool serve_lower() noexcept TAPPET_REALTIME;
    void hear_higher(std::uint64_t) noexcept TAPPET_REALTIME;
    void hear_lower(std::uint64_t) noexcept TAPPET_REALTIME;

    /// When the machine has stopped.
    [[nodiscard]] std::span<const Execution> executions() const noexcept {
        return assignment_.record.first(executed_);
    }
    [[nodiscard]] std::uint64_t waited_for_locks() const noexcept { return waited_for_locks_; }
    /// The thread of its activity; 0 before it started. Any thread may call it.
    [[nodiscard]] int thread() const noexcept { return thread_.load(std::memory_order_acquire); }

    static constexpr auto interface() {
        return facets(
            property<&Task::load>("load", "", "of each execution", range(0, 1)),
            property<&Task::setting>("setting", "", "how it communicates"),
            output<&Task::to_higher>("to_higher", "", "packet for the activity above"),
            output<&Task::to_lower>("to_lower", "", "packet for those below"),
            input<&Task::from_higher>("from_higher", "", "packet of the activity above", optional),
            input<&Task::from_lower>("from_lower", "", "packet of the activity below", optional),
            output<&Task::fill>("fill", "", "packets for the activity above"),
            input<&Task::drain>("drain", "", "packets of the activity below", optional),
            sends<&Task::ask_higher>("ask_higher", "work for the activity above", optional),
            sends<&Task::ask_lower>("ask_lower", "work for the activity below", optional),
            command<&Task::serve_higher>("serve_higher", "works for the activity above"),
            command<&Task::serve_lower>("serve_lower", "works for the activity below"),
            event<&Task::pulse>("pulse", "an execution that was answered"),
            operation<&Task::hear_higher>("hear_higher", "works upon the pulse of the activity above"),
            operation<&Task::hear_lower>("hear_lower", "works upon the pulse of the activity below"));
    }

private:
    [[nodiscard]] std::uint32_t since(std::uint64_t first) const noexcept TAPPET_REALTIME;
    void account_for_serving() noexcept TAPPET_REALTIME;
    void read_all() noexcept TAPPET_REALTIME;
    void write_all() noexcept TAPPET_REALTIME;
    void lock_and_read_all() noexcept;
    void lock_and_write_all() noexcept;
    void send(Execution& now) noexcept TAPPET_REALTIME;
    void emit(Execution& now) noexcept TAPPET_REALTIME;
    [[nodiscard]] std::uint32_t copy_bare() noexcept TAPPET_REALTIME;
    [[nodiscard]] std::uint32_t post_bare(std::size_t messages) noexcept TAPPET_REALTIME;
    void serve() noexcept TAPPET_REALTIME { turn(turns_of_service_); }

    Assignment assignment_{};
    std::size_t executed_ = 0;
    std::uint64_t turns_of_load_ = 0;
    std::uint64_t turns_of_service_ = 0;
    std::uint64_t passes_ = 0;
    Duration total_{};
    std::uint64_t waited_for_locks_ = 0;
    bool higher_answered_ = true;
    bool lower_answered_ = true;
    Packet own_{};
    Packet seen_{};
    std::array<Packet, 4> bare_{};
    std::array<Message, 2> messages_{};
    std::array<std::atomic<std::uint64_t>, 2> announced_{};
    std::atomic<int> thread_{0};
};

} // namespace experiments

} // namespace tappet
