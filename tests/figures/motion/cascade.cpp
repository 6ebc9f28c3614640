// A cascade of three levels as a table with its control section, beside the same loop written by hand:
// position commands speed, speed commands torque. Six axes of a robot, and one.
#include "tests/figures/measure/world.hpp"
#include "tests/figures/motion/cascade_laws.hpp"
#include "tests/figures/motion/groups.hpp"

#include "kernel/control/control.hpp"
#include "kernel/machine/accept.hpp"

#include <algorithm>
#include <concepts>
#include <string>
#include <utility>

namespace tappet::figures {

namespace {

using namespace cascade;

/// The end of a driver's wires.
template <int n>
struct Terminals {
    Input<Joints<n>> volts;
    Output<Joints<n>> counts;
    Counters<n> counters;
    void start(const Cycle&) noexcept TAPPET_REALTIME { counts.write(Joints<n>::Zero()); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { counts.write(counters.next()); }
    static constexpr auto interface() {
        return facets(input<&Terminals::volts>("volts", "V", "of the amplifiers"),
                      output<&Terminals::counts>("counts", "", "of the encoders"));
    }
};

/// The Generator of the outermost level: the target of the motion.
template <int n>
struct Way {
    Input<Joints<n>> position;
    Output<Aim<n>> target;
    Output<Speed<n>> speed;
    Travel<n> travel;
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME { stop(cycle); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        Aim<n> next;
        Speed<n> there;
        travel(next, there);
        target.write(next);
        speed.write(there);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        target.write(default_value<Aim<n>>());
        speed.write(default_value<Speed<n>>());
    }
    static constexpr auto interface() {
        return facets(input<&Way::position>("position", "rad", "of the axes"),
                      output<&Way::target>("target", "", "the next place"),
                      output<&Way::speed>("speed", "", "speed of the target"));
    }
};

/// All others: the law of one, two or three inputs.
template <int n, template <int> class Law, std::size_t count, class A = Joints<n>, class B = Joints<n>>
struct Part {
    Input<A> a;
    Input<B> b;
    Input<Joints<n>> c;
    Output<Joints<n>> made;
    Law<n> law;
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME { stop(cycle); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if constexpr (std::invocable<Law<n>&, A, Time>)
            made.write(law(a.get(), cycle.now));
        else if constexpr (count == 1)
            made.write(law(a.get()));
        else if constexpr (count == 2)
            made.write(law(a.get(), b.get()));
        else
            made.write(law(a.get(), b.get(), c.get()));
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { made.write(Joints<n>::Zero()); }
    static constexpr auto interface() {
        constexpr std::array all{
            input<&Part::a>("a", "", "the first"), input<&Part::b>("b", "", "the second"),
            input<&Part::c>("c", "", "the third"), output<&Part::made>("made", "", "by the law")};
        std::array<Facet, count + 1> used{};
        for (std::size_t i = 0; i < count; ++i) used[i] = all[i];
        used[count] = all[3];
        return used;
    }
};

// clang-format off
template <int n>
constexpr auto cascade_table = machine("cascade",
    components(
        component<Terminals<n>>("terminals"),
        component<Part<n, Measure, 1>>("gauge"), component<Part<n, Observe, 1>>("observer"),
        component<Way<n>>("way"),                component<Part<n, Approach, 3, Aim<n>, Speed<n>>>("place"),
        component<Part<n, Ease, 1>>("ramp"),     component<Part<n, Follow, 2>>("pace"),
        component<Part<n, Restrain, 1>>("bound"), component<Part<n, Load, 3>>("load"), component<Part<n, Amplify, 1>>("amplifier")),
    activities(activity("loops", every(period), budget(50us),
                        runs("terminals", "gauge", "observer", "way", "place", "ramp", "pace", "bound", "load", "amplifier"))),
    connections(
        data("terminals.counts", "gauge.a"),                                       data("amplifier.made", "terminals.volts", delayed),
        data("gauge.made", "observer.a"),                                          data("gauge.made", "way.position"),
        data("way.target", "place.a"), data("way.speed", "place.b"),               data("gauge.made", "place.c"),
        data("place.made", "ramp.a"),
        data("ramp.made", "pace.a"),                                               data("observer.made", "pace.b"),
        data("pace.made", "bound.a"),
        data("gauge.made", "load.a"), data("observer.made", "load.b"),             data("bound.made", "load.c"),
        data("load.made", "amplifier.a")),
    reactions(), behaviours(),
    control(
        level("place",  generator("way"), controller("place")),
        level("speed",  generator("ramp"), controller("pace")),
        level("torque", sensor("gauge"), estimator("observer"), generator("bound"), controller("load"), effector("amplifier"))));
// clang-format on

template <int n>
struct Cascade : World {
    std::uint64_t cycles = 0;
    Cascade() : World{os::Clock::Kind::virtual_time, AtRunTime<cascade_table<n>, figures_board>::machine()} {}
    [[nodiscard]] const Joints<n>& volts() {
        return instance.template find<Part<n, Amplify, 1>>("amplifier")->made.last();
    }
    static Cascade& get() {
        static Cascade only;
        return only;
    }
};

/// As an activity does it in virtual time, where no stamps are taken: asks when the engine is due, waits,
/// runs it.
template <int n>
void by_table(std::size_t times) {
    Cascade<n>& machine = Cascade<n>::get();
    Engine& engine = machine.engine();
    const RunsActivity here{engine.plan().activity};
    for (std::size_t i = 0; i < times; ++i, ++machine.cycles) {
        machine.clock.advance_to(engine.next_wake());
        engine.run(false);
    }
}
/// The same parts in real time, each timed in each cycle, woken without waiting for their period.
template <int n>
struct Timed : World {
    os::Clock real{os::Clock::Kind::real};
    Engine timed{};
    // Another table, so that both machines have their own parts.
    static constexpr auto table = [] {
        auto renamed = cascade_table<n>;
        renamed.name = "cascade-timed";
        return renamed;
    }();
    Timed() : World{os::Clock::Kind::virtual_time, AtRunTime<table, figures_board>::machine()} {
        EnginePlan plan = engine().plan();
        plan.periodic = false;
        plan.at_most_per = {};
        plan.budget = {}; // an interruption of the measurement must not break a claim
        timed.place(plan, real);
        timed.start(real.now());
    }
};
template <int n>
void by_table_timed(std::size_t times) {
    static Timed<n> machine;
    const RunsActivity here{machine.timed.plan().activity};
    for (std::size_t i = 0; i < times; ++i) {
        Time next = machine.timed.next_wake();
        keep(next);
        machine.timed.run(true);
    }
}

template <int n>
void by_hand(std::size_t times) {
    static ByHand<n> loop;
    static Time now{};
    for (std::size_t i = 0; i < times; ++i) {
        loop.cycle(now += period);
        keep(loop.volts);
    }
}
/// As an engineer would do it: a reading of the system's clock at either end, and none for its parts.
template <int n>
void by_hand_timed(std::size_t times) {
    static ByHand<n> loop;
    static Duration longest{};
    for (std::size_t i = 0; i < times; ++i) {
        const Time begin = os::Clock::monotonic();
        loop.cycle(begin);
        keep(loop.volts);
        longest = std::max(longest, os::Clock::monotonic() - begin);
        keep(longest);
    }
}

template <int n>
bool is_the_same() {
    Cascade<n>& machine = Cascade<n>::get();
    ByHand<n> loop;
    Time now{};
    for (std::uint64_t i = 0; i < machine.cycles; ++i) loop.cycle(now += period);
    return machine.cycles > 0 && loop.volts == machine.volts();
}

constexpr const char *table_bare = "by the table, time stamps excluded",
                     *table_timed = "by the table, each component timed",
                     *hand_bare = "the same loop by hand", *hand_timed = "the same by hand, timed as a whole";

template <int n>
Group group_of(std::string id, std::string title) {
    return {std::move(id),
            std::move(title),
            "thesis 3.1",
            16,
            {{table_bare, Standing::ours, &by_table<n>},
             {table_timed, Standing::ours, &by_table_timed<n>},
             {hand_bare, Standing::floor, &by_hand<n>},
             {hand_timed, Standing::floor, &by_hand_timed<n>}}};
}

} // namespace

void add_cascades(std::vector<Group>& groups) {
    static_cast<void>(os::prove_processor_counter()); // as when the machine arms
    groups.push_back(group_of<6>(
        "motion.cascade.robot",
        "a cycle of a cascade of three levels in ten components: flange, six axes, their torques"));
    groups.back().goals = {
        {"a cascade of three levels at most 1.2 times the same loop by hand, time stamps excluded",
         table_bare,
         1.2,
         {hand_bare}},
        {"the same with each component timed, by hand the whole", table_timed, 1.2, {hand_timed}}};
    groups.push_back(group_of<1>("motion.cascade.axis",
                                 "the same with laws of one axis: what ten components themselves take"));
}

bool cascades_are_the_same() { return is_the_same<6>() && is_the_same<1>(); }

} // namespace tappet::figures
