// SPDX-License-Identifier: Apache-2.0
// Random control structures, judged as the compiler judges a table, and then run: accepted ones never grow,
// whatever time their cycles take, and most of those that do not grow are accepted.
#include "kernel/base/random.hpp"
#include "kernel/control/control.hpp"
#include "kernel/machine/firmware.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <vector>

namespace tappet {
namespace {

/// Moves at the velocity it was commanded a delay ago, evaluated at any time between two steps.
struct Slide {
    struct Order {
        Time from;
        double velocity;
    };
    double place = 1.0, velocity = 0.0, farthest = 1.0;
    Time at{};
    std::deque<Order> under_way{};

    void go_to(Time now) {
        while (!under_way.empty() && under_way.front().from <= now) {
            const Order next = under_way.front();
            under_way.pop_front();
            go_on(next.from);
            velocity = next.velocity;
        }
        go_on(now);
    }

private:
    void go_on(Time now) {
        place += velocity * to_seconds(now - at);
        at = now;
        farthest = std::max(farthest, std::abs(place));
    }
};
Slide* slide = nullptr;
Duration transport_time{};

struct Scale {
    Output<double> place;
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME { step(cycle); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("the plant of a test", slide->go_to(cycle.now));
        place.write(slide->place);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { place.write(0); }
    static constexpr auto interface() { return facets(output<&Scale::place>("place", "m", "of the slide")); }
};
/// Holds zero, or passes its command on.
struct Path {
    Input<double> measured;
    Output<double> target;
    void start(const Cycle&) noexcept TAPPET_REALTIME { target.write(0); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { target.write(0); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { target.write(0); }
    static constexpr auto interface() {
        return facets(input<&Path::measured>("measured", "m", "looked at"),
                      output<&Path::target>("target", "m", "the place"));
    }
};
struct Axis {
    Input<double> target, measured;
    Output<double> velocity;
    Property<double> kp{1.0}, ki{0.0};
    double sum = 0.0;
    void start(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(0); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const double error = target.get() - measured.get();
        sum += error * to_seconds(cycle.period);
        velocity.write(kp.get() * error + ki.get() * sum);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(0); }
    static constexpr auto interface() {
        return facets(input<&Axis::target>("target", "m", "the place"),
                      input<&Axis::measured>("measured", "m", "where it is"),
                      output<&Axis::velocity>("velocity", "m/s", "wanted"),
                      property<&Axis::kp>("kp", "1/s", "of the error", range(0.0, 1.0)),
                      property<&Axis::ki>("ki", "1/s2", "of its sum", range(0.0, 1.0)));
    }
};
struct Valve {
    Input<double> velocity;
    Output<double> sent;
    void start(const Cycle&) noexcept TAPPET_REALTIME { sent.write(0); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        sent.write(velocity.get());
        TAPPET_ESCAPE("the plant of a test",
                      slide->under_way.push_back({cycle.now + transport_time, velocity.get()}));
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { sent.write(0); }
    static constexpr auto interface() {
        return facets(input<&Valve::velocity>("velocity", "m/s", "wanted"),
                      output<&Valve::sent>("sent", "m/s", "to the drive"));
    }
};
/// Uses the time of the other components.
struct Work {
    Input<double> seen;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(input<&Work::seen>("seen", "m/s", "what is sent")); }
};

struct Structure {
    Duration period{}, sensing{}, phase{}, transport{};
    Duration others_period{}, others_budget{};
    bool is_late_in = false, is_late_out = false; ///< rows that wait for the next cycle
    double kp = 0.0, ki = 0.0;
};

Structure drawn(Random& random, bool is_cascade) {
    constexpr std::array periods{1ms, 2ms, 4ms, 5ms, 10ms};
    Structure made;
    made.period = periods[random.below(periods.size())];
    made.sensing = is_cascade ? made.period * random.between(1, 10) : made.period;
    made.phase = is_cascade ? made.period * random.between(0, 9) / 10 : Duration{};
    made.transport = random.one_in(2) ? Duration{} : made.period * random.between(1, 40) / 10;
    made.others_period = made.period * random.between(1, 4);
    made.others_budget = made.others_period * random.between(1, 25) / 100;
    made.is_late_in = !is_cascade && random.one_in(3);
    made.is_late_out = random.one_in(3);
    made.kp = std::pow(10.0, 3.5 * random.unit()); // for any other parameters
    made.ki = random.one_in(2) ? 0.0 : made.kp * made.kp * random.unit() * 0.4;
    return made;
}

constexpr Board box{.name = "box", .memory_budget_bytes = 1 << 20};

/// The type of Axis, with ranges that allow only its present gains.
struct TunedType {
    std::vector<Facet> facets{component_type<Axis>.facets.begin(), component_type<Axis>.facets.end()};
    ComponentType type = component_type<Axis>;
    TunedType(double kp, double ki) {
        for (Facet& each : facets)
            if (each.kind == FacetKind::property)
                each.range = each.name == "kp" ? range(kp, kp) : range(ki, ki);
        type.facets = facets;
    }
    TunedType(const TunedType&) = delete;
    TunedType& operator=(const TunedType&) = delete;
};

constexpr ConnectionRow late_if(bool is_late, std::string_view from, std::string_view to) {
    return is_late ? data(from, to, delayed) : data(from, to);
}

auto single(const Structure& s, const ComponentRow& axis) {
    return machine(
        "single",
        components(component<Scale>("scale"), component<Path>("path"), axis, component<Valve>("valve"),
                   component<Work>("work")),
        activities(
            activity("others", every(s.others_period), budget(s.others_budget), runs("work")),
            activity("axis", every(s.period), budget(s.period / 8), runs("scale", "path", "axis", "valve"))),
        connections(late_if(s.is_late_in, "scale.place", "path.measured"), data("path.target", "axis.target"),
                    late_if(s.is_late_in, "scale.place", "axis.measured"),
                    late_if(s.is_late_out, "axis.velocity", "valve.velocity"),
                    data("valve.sent", "work.seen", stale_after(1s), hold)),
        reactions(), behaviours(),
        control(level("axis", sensor("scale"), generator("path"), controller("axis"), effector("valve")),
                process("work"),
                loop("place", gain("axis.kp"), integral("axis.ki"), transport(s.transport), may_overshoot)));
}

/// The Sensor is in a slower level, whose command is not connected.
auto cascade(const Structure& s, const ComponentRow& axis) {
    return machine(
        "cascade",
        components(component<Scale>("scale"), component<Path>("route"), component<Axis>("outer"),
                   component<Path>("path"), axis, component<Valve>("valve"), component<Work>("work")),
        activities(activity("others", every(s.others_period), budget(s.others_budget), runs("work")),
                   activity("outer", every(s.sensing), budget(s.period / 8), runs("scale", "route", "outer")),
                   activity("axis", every(s.period, phase(s.phase)), budget(s.period / 8),
                            runs("path", "axis", "valve"))),
        connections(
            data("scale.place", "route.measured"), data("route.target", "outer.target"),
            data("scale.place", "outer.measured"),
            s.sensing == s.period
                ? data("outer.velocity", "path.measured", scaled(1.0), stale_after(10s), hold)
                : data("outer.velocity", "path.measured", scaled(1.0), in_steps, stale_after(10s), hold),
            data("path.target", "axis.target"), data("scale.place", "axis.measured", stale_after(10s), hold),
            late_if(s.is_late_out, "axis.velocity", "valve.velocity"),
            data("valve.sent", "work.seen", stale_after(1s), hold)),
        reactions(), behaviours(),
        control(level("slow", sensor("scale"), generator("route"), controller("outer")),
                level("axis", generator("path"), controller("axis"), effector("valve")), process("work"),
                loop("place", gain("axis.kp"), integral("axis.ki"), transport(s.transport), may_overshoot)));
}

struct Count {
    int accepted = 0, refused_loops = 0, refused_well = 0, others = 0;
};

/// It grows when the last third goes farther out than the first.
template <class Table>
bool grows(const Table& table, const auto& index, const Structure& s, std::uint64_t seed) {
    auto plan = plan_for<0>(table, box, unbound, index, 0);
    auto kept = index;
    std::vector<std::byte> memory(plan.bytes + 4096);
    const auto begin = reinterpret_cast<std::uintptr_t>(memory.data());
    std::byte* const aligned = memory.data() + (4096 - begin % 4096) % 4096;
    os::Clock clock{os::Clock::Kind::virtual_time};
    Slide own;
    slide = &own;
    transport_time = s.transport;
    MachineInstance instance{
        AcceptedMachine{table.view(), &box, &unbound, kept.view(), plan.view(), {aligned, plan.bytes}},
        clock};
    VirtualWorld world{instance};
    EXPECT_TRUE(instance.configure({}));
    world.take_times(seed);
    EXPECT_EQ(world.start().view(), "");
    constexpr int samples = 1200;
    const Duration step = std::max(s.period, s.sensing);
    constexpr int parts = 12;
    double first = 0.0;
    bool is_far = false;
    for (int part = 0; part < parts && !is_far; ++part) {
        own.farthest = 0.0;
        static_cast<void>(world.run_until(clock.now() + samples / parts * step));
        if (part < parts / 3) first = std::max(first, own.farthest);
        is_far = !(own.farthest < (part < parts * 2 / 3 ? 1e6 : first)); // or not a number any more
    }
    world.stop();
    return is_far;
}

template <class Make>
void judge_and_run(const Make& make, const Structure& s, std::uint64_t seed, Count& count) {
    const TunedType tuned{s.kp, s.ki};
    ComponentRow axis = component<Axis>("axis", set("kp", s.kp), set("ki", s.ki));
    axis.type = &tuned.type;
    const auto table = make(s, axis);
    const auto verdict = judge(table, box, unbound);
    if (!verdict.refusal.empty() && !verdict.refusal.view().contains("loop \"place\"")) {
        if (count.others++ == 0)
            std::printf("refused: %.*s\n", static_cast<int>(verdict.refusal.size()),
                        verdict.refusal.view().data());
        return;
    }
    const bool is_bad = grows(table, verdict.index, s, seed);
    if (verdict.refusal.empty()) {
        ++count.accepted;
        EXPECT_FALSE(is_bad) << "seed " << seed << ": kp " << s.kp << ", ki " << s.ki << ", every "
                             << s.period << ", sensing every " << s.sensing << ", phase " << s.phase
                             << ", transport " << s.transport << ", late " << s.is_late_in << s.is_late_out;
    } else {
        ++count.refused_loops;
        count.refused_well += is_bad;
    }
}

TEST(Structures, never_grow_when_accepted_and_mostly_grow_when_refused) {
    const char* const wanted = std::getenv("TAPPET_STRUCTURES");
    const int structures = wanted == nullptr ? 10'000 : std::atoi(wanted);
    Count count;
    for (int i = 0; i < structures; ++i) {
        Random random{static_cast<std::uint64_t>(i) + 1};
        const bool is_cascade = random.one_in(2);
        const Structure s = drawn(random, is_cascade);
        const auto seed = static_cast<std::uint64_t>(i) + 1;
        if (is_cascade)
            judge_and_run([](const auto&... of) { return cascade(of...); }, s, seed, count);
        else
            judge_and_run([](const auto&... of) { return single(of...); }, s, seed, count);
    }
    const int well = count.accepted + count.refused_loops - count.refused_well;
    std::printf(
        "%d structures: %d accepted, %d refused, of which %d grew; %.1f %% of those that did not grow "
        "were refused\n",
        structures, count.accepted, count.refused_loops, count.refused_well,
        100.0 * (count.refused_loops - count.refused_well) / well);
    EXPECT_EQ(count.others, 0);
    EXPECT_LT((count.refused_loops - count.refused_well) * 5, well);
}

} // namespace
} // namespace tappet
