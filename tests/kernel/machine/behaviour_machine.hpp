// A small machine for behaviours: an oven that a script drives, a door in its activity, a feeder in another
// one.
#pragma once

#include "kernel/script/compiled.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tappet::bakery {

/// Turns by 10 degrees a millisecond and records its calls.
struct Oven : Clocked {
    Output<double> angle_deg;
    Output<std::int64_t> shown;
    Property<double> target{20.0};
    Event<double, std::int64_t> hot;
    Event<> tick;
    Event<double, double, double, double, double, double, std::int64_t> recipe; ///< too large for a message
    Notes<std::int64_t> told{};
    std::uint64_t steps = 0;
    double from_deg = 0;
    bool trembles = false; ///< jitters around its angle without turning
    Duration takes{};      ///< in each step

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        ++steps;
        if (takes != Duration{}) clock->consume(takes);
        const double goes =
            trembles ? static_cast<double>(steps % 2) * 0.01 : static_cast<double>(steps % 36 * 10);
        angle_deg.write(from_deg + goes);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { angle_deg.write(0); }
    /// Returns false for values beyond an oven's range.
    bool note(std::int64_t what) noexcept TAPPET_REALTIME {
        told.add(what);
        return what >= 0;
    }
    /// Uses so many microseconds.
    void bake(std::int64_t us) noexcept TAPPET_REALTIME { clock->consume(us * 1us); }
    static constexpr auto interface() {
        return facets(output<&Oven::angle_deg>("angle_deg", "deg", "of the turntable"),
                      output<&Oven::shown>("shown", "", "on its display"),
                      property<&Oven::target>("target", "degC", "of the heater", range(0, 300)),
                      event<&Oven::hot>("hot", "it is as hot as it should be"),
                      event<&Oven::tick>("tick", "of the test"),
                      event<&Oven::recipe>("recipe", "six heats, and pieces"),
                      method<&Oven::note>("note", "is written down"),
                      method<&Oven::bake>("bake", "takes its time"));
    }
};

struct Door {
    Property<bool> open{false};
    Event<> moved;
    std::int64_t pushes = 0;
    std::int64_t push(std::int64_t by) noexcept TAPPET_REALTIME { return pushes += by; }
    static constexpr auto interface() {
        return facets(property<&Door::open>("open", "", "the door"), event<&Door::moved>("moved", "it did"),
                      method<&Door::push>("push", "counts"));
    }
};

/// Feeds one piece in each of its steps; it rejects more than ten.
struct Feeder {
    std::int64_t left = 0;
    std::int64_t fed = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (left > 0) --left, ++fed;
    }
    bool feed(std::int64_t pieces) noexcept TAPPET_REALTIME {
        if (pieces > 10) return false;
        left = pieces;
        return true;
    }
    bool fed_all() noexcept TAPPET_REALTIME { return left == 0; }
    static constexpr auto interface() {
        return facets(command<&Feeder::feed, &Feeder::fed_all>("feed", "so many pieces"));
    }
};

template <const auto& table>
struct Rig : RunningRig<table> {
    Oven& oven() { return this->template the<Oven>("oven"); }
    Door& door() { return this->template the<Door>("door"); }
    Feeder& feeder() { return this->template the<Feeder>("feeder"); }
    void tick(Duration then = 2ms) {
        oven().tick.emit();
        this->run(then);
    }
    std::string state(const BehaviourUnit& unit, std::size_t part = 0) {
        std::string path;
        for (const std::string_view each : unit.parts()[part].machine->path())
            path += (path.empty() ? "" : "/") + std::string{each};
        return path;
    }
};

} // namespace tappet::bakery
