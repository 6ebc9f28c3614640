// A plant: the process that a machine controls, simulated at the other end of its wires. One source for
// virtual time, real time and the bench.
#pragma once

#include "drivers/twin/far_end.hpp"
#include "kernel/services/json.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace tappet {

/// Not real-time; one thread.
///     struct Filler final : Plant {
///         can::FarEnd<drive_signals> can{ends, "filler-can"};
///         gpio::FarEnd<lines> io{ends, "filler-io"};
///         explicit Filler(std::uint64_t seed) { can.send_every("drive", 2ms); }
///         Time move(Time now) override { ...; return now + 1ms; }
///     };
class Plant {
public:
    Plant() = default;
    Plant(const Plant&) = delete;
    Plant& operator=(const Plant&) = delete;
    virtual ~Plant() = default;

    /// Moves what it simulates to `now`; the ends have taken what the machine sent, and give afterwards what
    /// was set. The answer: when it wants to move again at the latest; on the bench it is moved every so
    /// often anyway. The clock is the machine's.
    virtual Time move(Time now) = 0;

    /// On the bench, where lines take one edge at a time: when it has the next one, of a contact that
    /// bounces, faster than it is moved anyway.
    [[nodiscard]] virtual Time next_edge() const { return never; }

    /// Under virtual time: nothing comes in and nobody looks before `until`. It may move on by itself as far
    /// as nothing leaves it; the answer is as that of move(). Nothing: it does not know how.
    [[nodiscard]] virtual std::optional<Time> leap(Time /*until*/) { return {}; }

    /// Options of its own, each with a value: a line each, for --help.
    [[nodiscard]] virtual std::string_view usage() const { return {}; }
    /// False: it has no such option. An error says what is wrong with the value.
    virtual bool take_option(std::string_view, std::string_view, Sentence&) { return false; }
    /// True when it has seen enough: the run ends well.
    [[nodiscard]] virtual bool is_done() const { return false; }
    /// How long a run takes when nobody says it and it is not done before.
    [[nodiscard]] virtual Duration usual_time() const { return 10s; }
    /// What was wrong with the run, asked at its end; empty: nothing.
    [[nodiscard]] virtual Sentence fault() const { return {}; }
    /// Of all that happened in it: equal for two runs that were the same.
    [[nodiscard]] virtual std::uint64_t digest() const { return 0; }
    /// What it measured, as more fields of an object that is open.
    virtual void report(JsonText&) const {}
    /// Devices of the machine's own kinds, which the plant simulates itself.
    [[nodiscard]] virtual std::span<const ProvidedDevice> devices() { return {}; }

    /// Somebody outside told it so by the signal USR1: for whoever runs it on the bench.
    virtual void told() {}

    // ---- for the worlds

    [[nodiscard]] Sentence connect(std::span<const ProvidedDevice> wires) {
        for (FarEnd* end : ends)
            if (Sentence fault = end->connect(wires); !fault.empty()) return fault;
        return {};
    }
    /// Takes, moves, gives; when the next time is due.
    Time advance(Time now) {
        if (begun_ == never) begun_ = now_ = now;
        before_ = now_;
        now_ = now;
        for (FarEnd* end : ends) end->take(now);
        Time next = move(now);
        for (FarEnd* end : ends) {
            end->give(now);
            next = std::min(next, end->next());
        }
        return next;
    }
    /// Leaps; when the next time is due, if that has changed.
    std::optional<Time> leap_ahead(Time until) {
        Time of_wires = never;
        for (const FarEnd* end : ends) of_wires = std::min(of_wires, end->next());
        const std::optional<Time> next = leap(std::min(until, of_wires));
        return next ? std::min(*next, of_wires) : next;
    }

protected:
    FarEnds ends; ///< its own are members of it: can::FarEnd<map> can{ends, "device"}

    /// Of this move, since the first one.
    [[nodiscard]] Duration elapsed() const { return now_ - begun_; }
    /// Of this move, since the one before; 0 at the first.
    [[nodiscard]] Duration step() const { return now_ - before_; }

private:
    Time begun_ = never, before_{}, now_{};
};

} // namespace tappet
