// A plant: the simulated process that a machine controls, at the other end of its wires. One source for
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

    /// Advances the simulation to `now`. The far ends have received what the machine sent, and send
    /// afterwards what was set. Returns the latest time of the next move(); on the bench it is also called
    /// periodically. `now` is of the machine's clock.
    virtual Time move(Time now) = 0;

    /// Returns when the plant has its next edge, for a contact that bounces faster than move() is called. On
    /// the bench only, where lines take one edge at a time.
    [[nodiscard]] virtual Time next_edge() const { return never; }

    /// Virtual time only: nothing arrives, and the plant is not observed, before `until`. The plant may skip
    /// ahead until it next sends something; returns the same as move(). Empty: not supported.
    [[nodiscard]] virtual std::optional<Time> leap(Time /*until*/) { return {}; }

    /// Returns the plant's own options, each with a value, one line each, for --help.
    [[nodiscard]] virtual std::string_view usage() const { return {}; }
    /// Takes an option; returns false when it does not exist. An error states what is wrong with the value.
    virtual bool take_option(std::string_view, std::string_view, Sentence&) { return false; }
    /// Returns true when the plant has seen enough: the run ends successfully.
    [[nodiscard]] virtual bool is_done() const { return false; }
    /// Returns the length of a run when it is not stated and the plant is not done before.
    [[nodiscard]] virtual Duration usual_time() const { return 10s; }
    /// Returns what was wrong with the run, at its end; empty: nothing.
    [[nodiscard]] virtual Sentence fault() const { return {}; }
    /// Returns a digest of everything that happened: equal for two identical runs.
    [[nodiscard]] virtual std::uint64_t digest() const { return 0; }
    /// Adds its measurements as fields of the open object.
    virtual void report(JsonText&) const {}
    /// Returns devices of the machine's own kinds, which the plant simulates itself.
    [[nodiscard]] virtual std::span<const ProvidedDevice> devices() { return {}; }

    /// Called on the signal USR1, which a person at the bench can send.
    virtual void told() {}

    // ---- called by the worlds

    [[nodiscard]] Sentence connect(std::span<const ProvidedDevice> wires) {
        for (FarEnd* end : ends)
            if (Sentence fault = end->connect(wires); !fault.empty()) return fault;
        return {};
    }
    /// Receives, moves and sends; returns when the next call is due.
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
    /// Skips ahead; returns when the next call is due, if that has changed.
    std::optional<Time> leap_ahead(Time until) {
        Time of_wires = never;
        for (const FarEnd* end : ends) of_wires = std::min(of_wires, end->next());
        const std::optional<Time> next = leap(std::min(until, of_wires));
        return next ? std::min(*next, of_wires) : next;
    }

protected:
    FarEnds ends; ///< a plant's far ends are its members: can::FarEnd<map> can{ends, "device"}

    /// Returns the time from the first move() to this one.
    [[nodiscard]] Duration elapsed() const { return now_ - begun_; }
    /// Returns the time from the previous move() to this one; 0 at the first.
    [[nodiscard]] Duration step() const { return now_ - before_; }

private:
    Time begun_ = never, before_{}, now_{};
};

} // namespace tappet
