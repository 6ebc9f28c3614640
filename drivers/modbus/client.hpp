// A Modbus server as a component: its ports come from a constexpr register map.
#pragma once

#include "drivers/modbus/register_map.hpp"
#include "drivers/modbus/session.hpp"
#include "drivers/modbus/transport.hpp"
#include "drivers/modbus/trouble_text.hpp"
#include "kernel/base/array_of.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/nth.hpp"
#include "kernel/component/output_gate.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tappet::modbus {

/// Each register read has an output, stamped with the time of the answer and written only then, so its age
/// shows an outage. Each register written has a required input. The client blocks for the requests that are
/// due, until one gets no answer or a period has passed: it runs in an activity of its own, one server each,
/// that is not_real_time. When it stops, it sends the values written since, then the safe values of its map,
/// as its guardian would, and reports its server as lost.
template <const auto& map> struct Client {
    static constexpr std::string_view device_fault = map.fault.view();
    static constexpr std::size_t count = map.registers.size();
    static constexpr const DeviceKind& device_kind = modbus::device_kind;
    static constexpr SafeWrites device_map = map.safe_writes();

    std::array<Output<double>, count> read{};
    std::array<Input<double>, count> wanted{};
    Output<bool> connected{};
    Output<std::int64_t> outages{};
    Output<std::int64_t> outages_survived{};
    Output<std::int64_t> no_numbers{};
    Output<std::int64_t> out_of_range{};
    Output<Text<200>> reason{};
    Event<> lost{};
    Event<> back{};

    Sentence configure(Setup& setup) {
        transport_ = setup.device<Transport>();
        if (transport_ == nullptr) return setup.no_device();
        session_.emplace(map, *transport_, Backoff{}, unsent_);
        return {};
    }

    /// Starts fresh: opens its own connection and writes the wanted values again unless they became too old.
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("this activity is not real-time",
                      session_.emplace(map, *transport_, Backoff{}, unsent_));
        is_set_ = {};
        was_lost_ = false;
        told_ = {};
        reason.write({});
        tell_counts();
    }

    void work(const Cycle& cycle) {
        exchange(cycle);
        for (std::size_t v = 0; v < count; ++v) {
            const Value value = session_->value(v);
            if (is_written(v) || value.stamp == seen_[v] || value.quality != Quality::good) continue;
            seen_[v] = value.stamp;
            // A slow server's stamp can be further ahead of the cycle than an output allows.
            read[v].write(value.value, std::min(value.stamp, cycle.now + ahead_at_most));
        }
        tell_counts();
        tell_trouble();
        if (was_stopped_ && session_->connected()) {
            was_stopped_ = false;
            return back.emit();
        }
        if (session_->outage() == was_lost_) return;
        was_lost_ = !was_lost_;
        was_stopped_ = false;
        if (was_lost_)
            lost.emit();
        else
            back.emit();
    }

    void stop(const Cycle& cycle) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("this activity is not real-time", write_last(cycle));
        if (!was_lost_) lost.emit();
        was_stopped_ = true;
        gates_.stop(cycle.now);
    }

    [[nodiscard]] bool stopped_safely() const noexcept TAPPET_REALTIME { return stopped_safely_; }

    [[nodiscard]] Counters counters() const noexcept { return session_->counters(); }
    static Unsent unsent(const void* client, std::size_t facet) noexcept {
        return facet < count ? static_cast<const Client*>(client)->unsent_[facet].read() : Unsent{};
    }

    static void gate_output(void* client, std::size_t value, OutputGate& gate) noexcept {
        static_cast<Client*>(client)->gates_.add(value, gate);
    }

    static constexpr auto interface() {
        std::array<Facet, count + 8> list{};
        std::size_t n = 0;
        for (std::size_t v = 0; v < count; ++v) {
            const std::string_view name = ValueNames<map>::all[v].view(), unit = map.registers[v].unit;
            const auto every = comes_every(map.rows[map.row_of[v]].every);
            list[n] = is_written(v)
                          ? nth_input<&Client::wanted>(v, name, unit, "written to the server", every)
                          : nth_output<&Client::read>(v, name, unit, "read from the server", every);
            if (const Register& row = map.registers[v]; is_written(v) && row.says_safe)
                tappet::detail::apply(list[n], drives_output(v, row.safe_value));
            ++n;
        }
        list[n++] = output<&Client::connected>("connected", "", "the server answers", while_stopped(false));
        list[n++] = output<&Client::outages>("outages", "", "times the server was lost, since start");
        list[n++] = output<&Client::outages_survived>("outages_survived", "",
                                                      "outages after which the server came back");
        list[n++] = output<&Client::no_numbers>(
            "no_numbers", "",
            "registers read that are not a number, since start; their outputs become stale");
        list[n++] = output<&Client::out_of_range>(
            "out_of_range", "",
            "values outside their register's range, since the machine's start: its "
            "nearest bound is written; nothing is written when not a number");
        list[n++] = output<&Client::reason>(
            "reason", "", "why it is lost, or which row it refuses, and the cure; written on change");
        list[n++] = event<&Client::lost>("lost", "the server does not answer");
        list[n++] = event<&Client::back>("back", "the server answers again");
        return list;
    }

private:
    static constexpr bool is_written(std::size_t v) noexcept { return map.rows[map.row_of[v]].write; }

    void tell_counts() noexcept TAPPET_REALTIME {
        const Counters& seen = session_->counters();
        connected.write(session_->connected());
        outages.write(static_cast<std::int64_t>(seen.outages));
        outages_survived.write(static_cast<std::int64_t>(seen.outages_survived));
        no_numbers.write(static_cast<std::int64_t>(seen.no_numbers));
        std::uint64_t beyond = 0;
        for (std::size_t v = 0; v < count; ++v)
            if (is_written(v)) beyond += unsent_[v].clamped + unsent_[v].no_number;
        out_of_range.write(static_cast<std::int64_t>(beyond));
    }
    void tell_trouble() noexcept {
        const Trouble trouble = session_->trouble();
        if (trouble == told_) return;
        told_ = trouble;
        Text<200> text;
        if (trouble.outcome != Outcome::ok) text.append(to_text(map.rows[trouble.row].name, trouble).view());
        reason.write(text);
    }

    void write_last(const Cycle& cycle) noexcept {
        take_wanted(cycle.now);
        for (std::size_t v = 0; v < count; ++v)
            if (is_written(v) && map.registers[v].says_safe)
                static_cast<void>(session_->set(v, map.registers[v].safe_value, cycle.now)); // it is in range
        const bool was_asked = session_->counters().requests != 0;
        const bool is_safe = session_->finish(cycle.now);
        stopped_safely_ = is_safe || (!was_asked && stopped_safely_); // one never asked was not driven
    }
    void take_wanted(Time now) noexcept {
        for (std::size_t v = 0; v < count; ++v) {
            if (!is_written(v)) continue;
            double value = 0;
            const Flow flow = wanted[v].read(value);
            if (flow == Flow::never_written) continue;
            const double safe = map.registers[v].safe_value;
            const bool is_held = gates_.hold(v, value == safe, now);
            if (is_held) value = safe;
            // A forced value, a row's substitute for a stale one and a held value are current in each cycle.
            const bool is_given = is_held || (flow == Flow::stale && wanted[v].has_substitute());
            const Time stamp = is_given ? now : wanted[v].stamp();
            const bool is_left = stamp == before_all && session_->value(v).stamp != before_all;
            const bool is_newer = stamp > session_->value(v).stamp || is_left;
            const bool is_other = !is_set_[v] || value != taken_[v]; // it changed behind a force
            if (flow != Flow::fresh && !is_newer && !is_other) continue;
            taken_[v] = value;
            is_set_[v] = session_->set(v, value, stamp);
        }
    }
    void exchange(const Cycle& cycle) noexcept {
        take_wanted(cycle.now);
        // The session returns the end of a request; the next request starts then.
        Time at = cycle.now;
        for (std::size_t n = 0; n <= map.rows.size(); ++n) {
            const std::uint64_t before = tried();
            const Time next = session_->step(at);
            if (tried() == before && next > at) return; // nothing is due
            if (session_->outage() || next > cycle.now + cycle.period) return;
            at = next;
        }
    }
    [[nodiscard]] std::uint64_t tried() const noexcept {
        const Counters count_now = session_->counters();
        return count_now.requests + count_now.connects + count_now.refused;
    }

    Transport* transport_ = nullptr;
    std::optional<Session<map.rows.size(), map.registers.size()>> session_{};
    std::array<Time, count> seen_ = array_of<count>([](std::size_t) { return Time::min(); });
    std::array<Unsent, count> unsent_{};
    std::array<bool, count> is_set_{}; ///< in the session, since start()
    OutputGates<count> gates_{};
    std::array<double, count> taken_{}; ///< the last values set there
    bool was_lost_ = false, was_stopped_ = false, stopped_safely_ = true;
    Trouble told_{};
};

} // namespace tappet::modbus
