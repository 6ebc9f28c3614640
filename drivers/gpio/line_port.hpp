// The lines of one GPIO chip as a component: its ports, events and operations come from a constexpr line map.
#pragma once

#include "drivers/gpio/device.hpp"
#include "drivers/gpio/line_map.hpp"
#include "kernel/base/array_of.hpp"
#include "kernel/component/cause.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/facet_name.hpp"
#include "kernel/component/nth.hpp"
#include "kernel/component/output_gate.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>
#include <utility>

namespace tappet::gpio {

/// The names of a map's facets: "line", "line.rises", "line.falls", "line.set", "line.clear".
template <const auto& map> struct LineNames {
    static constexpr auto with(std::string_view ending) {
        return array_of<map.rows.size()>(
            [ending](std::size_t i) { return FacetName{map.rows[i].line.name, ending}; });
    }
    static constexpr auto rises = with(".rises");
    static constexpr auto falls = with(".falls");
    static constexpr auto set = with(".set");
    static constexpr auto clear = with(".clear");
    static constexpr auto plain =
        array_of<map.rows.size()>([](std::size_t i) { return map.rows[i].line.name; });
};

/// Each sensor has an output with its level and the edge's time, and the events rises and falls with that
/// time. Each lamp has a required input, whose row should wake this activity. Each actuator has the required
/// operations set and clear. Runs in an activity that is on_device. All real-time.
///
/// A line that is already active when the machine starts has no edge: its output shows it, `rises` is silent.
/// Lost edges are counted and reported before the edges after them. When the kernel's buffer is empty after a
/// loss, the levels are read again. A level that differs from the edges' is reported as an edge at that
/// moment; if the true edge arrives later, it is not reported again.
///
/// When the chip refuses a write or a read, that is a fault: `faulted` and `line_fault` report it. The last
/// value requested of an output is written as soon as the chip accepts it; a faulted port polls for that and
/// rests in between.
///
/// At the start and after stop() every output has its safe value; after stop() it keeps it.
template <const auto& map> struct LinePort {
    static constexpr std::string_view device_fault = map.fault.view();
    static constexpr std::size_t count = map.rows.size();
    static constexpr const DeviceKind& device_kind = gpio::device_kind;
    static constexpr bool woken_by_device = true;
    static constexpr std::span<const LineRow> device_map{map.rows};
    static constexpr std::span<const std::string_view> device_lines() { return LineNames<map>::plain; }
    static constexpr std::size_t edges_per_cycle = 64;
    static constexpr std::size_t most_batches_before_start = 32; ///< twice the size of the kernel's buffer
    static constexpr Duration look_while_faulted = 20ms;

    std::array<Output<bool>, count> level{};
    std::array<Event<Time>, count> rises{};
    std::array<Event<Time>, count> falls{};
    std::array<Input<bool>, count> wanted{};
    Output<std::int64_t> edges_lost{};
    Event<> edges_were_lost{};
    Output<bool> is_faulted{};
    Event<> line_fault{};
    Timer next_look{};

    Sentence configure(Setup& setup) {
        device_ = setup.device<Device>();
        waiter_ = setup.waiter;
        clock_ = setup.clock;
        return device_ == nullptr ? setup.no_device() : setup.woken_by(*device_);
    }

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        stopped_ = known_ = doubtful_ = faulted_ = false;
        levels_ = from_reading_ = 0;
        lost_ = 0;
        failures_ = device_->counters().failures;
        edges_lost.write(0);
        is_faulted.write(false);
        asked_ = safe_values;
        drive(outputs, safe_values);
        // The levels report what happened before the start; edges would carry an older time.
        for (std::size_t n = 0; n < most_batches_before_start; ++n)
            if (device_->read_edges(edges_).count < edges_.size()) break;
        read_levels(cycle.now);
        judge(cycle.now);
        waiter_->wake(); // for edges that arrive in between
    }

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const EdgeBatch batch = device_->read_edges(edges_);
        const std::size_t n = batch.count < edges_.size() ? batch.count : edges_.size();
        bool loss_told = batch.gap.missed == 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (!loss_told && edges_[i].missed != 0) {
                loss_told = true;
                tell_loss(batch.gap.missed);
            }
            take(edges_[i]);
        }
        if (!loss_told) tell_loss(batch.gap.missed);
        doubtful_ |= faulted_; // check whether the chip answers again
        if (n == edges_.size())
            waiter_->wake();
        else if (doubtful_)
            read_levels(cycle.now);
        write_outputs(cycle.now);
        judge(cycle.now);
    }

    void stop(const Cycle& cycle) noexcept TAPPET_REALTIME {
        stopped_ = true;
        gates_.stop(cycle.now);
        drive(outputs, safe_values);
        if (refused_ != 0) drive(outputs, safe_values); // there is no further retry once it is stopped
        // Lines without a driver cannot be relied on, even if the chip is healthy.
        if (!faulted_) line_fault.emit();
    }

    [[nodiscard]] bool stopped_safely() const noexcept TAPPET_REALTIME { return !stopped_ || refused_ == 0; }

    template <std::size_t line> void set() noexcept TAPPET_REALTIME { actuate(line, true); }
    template <std::size_t line> void clear() noexcept TAPPET_REALTIME { actuate(line, false); }
    static void gate_output(void* port, std::size_t line, OutputGate& gate) noexcept {
        static_cast<LinePort*>(port)->gates_.add(line, gate);
    }

    [[nodiscard]] Counters counters() const noexcept { return device_->counters(); }

    static constexpr auto interface() { return list(std::make_index_sequence<count>{}); }

private:
    static constexpr Mask outputs = [] {
        Mask mask = 0;
        for (std::size_t i = 0; i < count; ++i)
            if (map.rows[i].line.role == Role::output) mask |= Mask{1} << i;
        return mask;
    }();
    static constexpr Mask safe_values = [] {
        Mask mask = 0;
        for (std::size_t i = 0; i < count; ++i)
            if (map.rows[i].line.safe_value) mask |= outputs & Mask{1} << i;
        return mask;
    }();
    static constexpr std::size_t facets_of(std::size_t i) noexcept {
        return map.rows[i].line.role == Role::input ? 3 : map.rows[i].driven == Driven::by_port ? 1 : 2;
    }
    static constexpr std::size_t facet_count = [] {
        std::size_t n = 5;
        for (std::size_t i = 0; i < count; ++i) n += facets_of(i);
        return n;
    }();

    template <std::size_t... i> static constexpr auto list(std::index_sequence<i...>) {
        std::array<Facet, facet_count> all{};
        std::size_t n = 0;
        (add_line<i>(all, n), ...);
        all[n++] = tappet::output<&LinePort::edges_lost>(
            "edges_lost", "", "edges that the kernel could not deliver, since start");
        all[n++] = tappet::event<&LinePort::edges_were_lost>("edges_were_lost",
                                                             "edges were lost; the levels were read anew");
        all[n++] = tappet::output<&LinePort::is_faulted>(
            "faulted", "", "the chip refuses requests; written on change", while_stopped(true));
        all[n++] = tappet::event<&LinePort::line_fault>("line_fault", "the lines can no longer be relied on");
        all[n++] =
            timer<&LinePort::next_look, &LinePort::step>("next_look", "whether a faulted chip answers again");
        return all;
    }

    template <std::size_t i>
    static constexpr void add_line(std::array<Facet, facet_count>& all, std::size_t& n) {
        using Names = LineNames<map>;
        constexpr std::string_view name = Names::plain[i];
        [[maybe_unused]] constexpr DrivesOutput drives =
            drives_output(i, map.rows[i].line.safe_value ? 1 : 0);
        if constexpr (map.rows[i].line.role == Role::input) {
            all[n++] = nth_output<&LinePort::level>(i, name, "", "the line's level", as_it_was, stamps_cause);
            all[n++] = nth_event<&LinePort::rises>(i, Names::rises[i].view(),
                                                   "the line became active, at that time");
            all[n++] = nth_event<&LinePort::falls>(i, Names::falls[i].view(),
                                                   "the line became inactive, at that time");
        } else if constexpr (map.rows[i].driven == Driven::by_port) {
            all[n++] = nth_input<&LinePort::wanted>(i, name, "", "the level wanted", needs_wake, drives);
        } else {
            all[n++] = operation<&LinePort::template set<i>>(Names::set[i].view(), "makes the line active",
                                                             required, drives);
            all[n++] = operation<&LinePort::template clear<i>>(Names::clear[i].view(),
                                                               "makes the line inactive", required, drives);
        }
    }

    static constexpr bool bit(Mask mask, std::size_t i) noexcept TAPPET_REALTIME {
        return (mask >> i & 1u) != 0;
    }
    static constexpr Mask with_bit(Mask mask, std::size_t i, bool value) noexcept TAPPET_REALTIME {
        return value ? mask | Mask{1} << i : mask & ~(Mask{1} << i);
    }

    void take(const Edge& edge) noexcept TAPPET_REALTIME {
        if (edge.line >= count) return;
        const Mask line = Mask{1} << edge.line;
        const bool told_already =
            (from_reading_ & line) != 0 && edge.stamp <= read_at_ && bit(levels_, edge.line) == edge.rising;
        from_reading_ &= ~line;
        if (!told_already) tell(edge.line, edge.rising, edge.stamp);
    }

    void tell(std::size_t line, bool rising, Time stamp) noexcept TAPPET_REALTIME {
        levels_ = with_bit(levels_, line, rising);
        const CausedBy edge{stamp};
        level[line].write(rising, stamp);
        if (rising)
            rises[line].emit(stamp);
        else
            falls[line].emit(stamp);
    }

    void tell_loss(std::uint32_t missed) noexcept TAPPET_REALTIME {
        doubtful_ = true;
        lost_ += missed;
        edges_lost.write(lost_);
        edges_were_lost.emit();
    }

    // The levels already include an edge that is still queued in the kernel.
    void read_levels(Time now) noexcept TAPPET_REALTIME {
        const Levels read = device_->levels();
        read_at_ = clock_->now();
        doubtful_ = !read.known;
        if (!read.known) return;
        for (std::size_t i = 0; i < count; ++i) {
            if (map.rows[i].line.role != Role::input) continue;
            const bool active = bit(read.mask, i);
            if (!known_) {
                levels_ = with_bit(levels_, i, active);
                level[i].write(active, now);
            } else if (active != bit(levels_, i)) {
                tell(i, active, now);
            } else {
                continue;
            }
            from_reading_ |= Mask{1} << i;
        }
        known_ = true;
    }

    void write_outputs(Time now) noexcept TAPPET_REALTIME {
        Mask mask = 0;
        Mask values = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const LineRow& row = map.rows[i];
            if (row.line.role != Role::output) continue;
            bool value = bit(asked_, i);
            if (row.driven == Driven::by_port) {
                // Stale: the row decides, by the last value or its substitute.
                if (wanted[i].read(value) == Flow::never_written) continue;
                if (wanted[i].is_abandoned()) value = row.line.safe_value;
            } else if (!gates_.has(i)) {
                continue;
            }
            const bool safe = row.line.safe_value;
            if (gates_.hold(i, value == safe, now)) value = safe;
            if (bit(driven_, i) == value) continue;
            mask |= Mask{1} << i;
            values = with_bit(values, i, value);
        }
        drive(mask, values);
    }

    void actuate(std::size_t line, bool active) noexcept TAPPET_REALTIME {
        if (stopped_) return;
        const Time now = clock_->now();
        asked_ = with_bit(asked_, line, active);
        const bool safe = map.rows[line].line.safe_value;
        if (gates_.hold(line, active == safe, now)) active = safe;
        drive(Mask{1} << line, with_bit(0, line, active));
        judge(now);
    }

    /// Writes these outputs, and with them all that were refused before.
    void drive(Mask mask, Mask values) noexcept TAPPET_REALTIME {
        refused_ |= mask;
        driven_ = (driven_ & ~mask) | (values & mask);
        if (refused_ != 0 && device_->write(refused_, driven_)) refused_ = 0;
    }

    /// Called after calls of the device: a fault lasts until the device refuses nothing and the outputs and
    /// levels are known.
    void judge(Time now) noexcept TAPPET_REALTIME {
        const std::uint64_t failures = device_->counters().failures;
        const bool bad = failures != failures_ || (faulted_ && (doubtful_ || refused_ != 0));
        failures_ = failures;
        next_look.arm(bad ? now + look_while_faulted : never);
        if (bad == faulted_) return;
        faulted_ = bad;
        is_faulted.write(bad);
        if (bad) line_fault.emit();
    }

    std::array<Edge, edges_per_cycle> edges_{};
    Device* device_ = nullptr;
    os::Waiter* waiter_ = nullptr;
    os::Clock* clock_ = nullptr;
    Time read_at_{};        // when the levels were last read
    Mask levels_ = 0;       // as reported
    Mask from_reading_ = 0; // reported from a reading, with no edge since
    Mask asked_ = 0;        // the values that operations asked for last
    Mask driven_ = 0;       // the values requested of the outputs
    Mask refused_ = 0;      // the outputs whose value the chip refused
    bool known_ = false;    // the levels were read at least once
    bool doubtful_ = false; // edges were lost since, or the levels could not be read
    bool faulted_ = false;
    bool stopped_ = false;
    std::int64_t lost_ = 0;
    std::uint64_t failures_ = 0; // the device's count at the last check
    OutputGates<count> gates_{};
};

} // namespace tappet::gpio
