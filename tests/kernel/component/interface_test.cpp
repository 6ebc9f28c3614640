// A component's interface as data: facets, calls through packed arguments, timers; and the component
// functions that its type finds.
#include "kernel/component/component.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace tappet;

struct Probe {
    Input<double> measured;
    Input<int> extra;
    Output<double> speed;
    BufferInput<int> samples;
    BufferOutput<int> arrivals;
    Event<double, int> reached;
    Event<> lost;
    Property<double> gain{1.5};
    Property<std::int64_t> steps{3};
    Property<bool> reversed{true};
    Property<Duration> filter{2ms};
    Timer silence;

    void move(double by, int mode) noexcept TAPPET_REALTIME { by_ = by, mode_ = mode; }
    void mixed(std::uint8_t a, double b, std::int16_t c) noexcept TAPPET_REALTIME { mixed_ = a + b + c; }
    void home() noexcept TAPPET_REALTIME { homed_ = true; }
    void hush(const Cycle& cycle) noexcept TAPPET_REALTIME { hushed_ = cycle.release; }
    void step(const Cycle&) noexcept TAPPET_REALTIME { ++steps_taken_; }

    double by_ = 0, mixed_ = 0;
    int mode_ = 0, steps_taken_ = 0;
    bool homed_ = false;
    Time hushed_{};

    static constexpr auto interface() {
        return facets(
            input<&Probe::measured>("measured", "deg", "by the encoder"),
            input<&Probe::extra>("extra", "", "if there is one", optional),
            output<&Probe::speed>("speed", "rpm", "filtered"), input<&Probe::samples>("samples", "", "raw"),
            output<&Probe::arrivals>("arrivals", "", "of the weft"),
            event<&Probe::reached>("reached", "it is there"), event<&Probe::lost>("lost", "it is not"),
            operation<&Probe::move>("move", "shifts it", required),
            operation<&Probe::mixed>("mixed", "of three sizes"),
            operation<&Probe::home>("home", "to the origin", any_thread),
            property<&Probe::gain>("gain", "", "of the loop", range(0, 10)),
            property<&Probe::steps>("steps", "", "per turn"),
            property<&Probe::reversed>("reversed", "", "mounted so"),
            property<&Probe::filter>("filter", "s", "time constant"),
            timer<&Probe::silence, &Probe::hush>("silence", "ends the horn"));
    }
};

const Facet& facet(std::string_view name) {
    for (const Facet& each : component_type<Probe>.facets)
        if (each.name == name) return each;
    throw std::string{"no facet of that name"};
}

TEST(Interface, describes_the_kind_and_the_type_of_each_facet) {
    EXPECT_EQ(facet("measured").kind, FacetKind::input);
    EXPECT_EQ(facet("samples").kind, FacetKind::buffer_input);
    EXPECT_EQ(facet("speed").kind, FacetKind::output);
    EXPECT_EQ(facet("arrivals").kind, FacetKind::buffer_output);
    EXPECT_EQ(facet("reached").kind, FacetKind::event);
    EXPECT_EQ(facet("move").kind, FacetKind::operation);
    EXPECT_EQ(facet("gain").kind, FacetKind::property);
    EXPECT_EQ(facet("silence").kind, FacetKind::timer);
    EXPECT_EQ(facet("measured").type, facet("speed").type);
    EXPECT_NE(facet("measured").type, facet("extra").type);
    EXPECT_EQ(facet("reached").type, facet("move").type) << "both are (double, int)";
    EXPECT_EQ(facet("lost").type, facet("home").type) << "both are ()";
    EXPECT_NE(facet("lost").type, facet("move").type);
    EXPECT_EQ(facet("speed").unit, "rpm");
}

TEST(Interface, requires_inputs_unless_optional_and_operations_only_when_stated) {
    EXPECT_TRUE(facet("measured").required);
    EXPECT_TRUE(facet("samples").required);
    EXPECT_FALSE(facet("extra").required);
    EXPECT_TRUE(facet("move").required);
    EXPECT_FALSE(facet("home").required);
    EXPECT_TRUE(facet("home").any_thread);
    EXPECT_FALSE(facet("move").any_thread);
}

TEST(Interface, finds_each_member_in_a_component) {
    Probe probe;
    EXPECT_EQ(facet("measured").at(&probe, 0), &probe.measured);
    EXPECT_EQ(facet("reached").at(&probe, 0), &probe.reached);
    EXPECT_EQ(facet("gain").at(&probe, 0), &probe.gain);
}

TEST(Interface, finds_exactly_the_functions_that_a_component_has) {
    const ComponentType& type = component_type<Probe>;
    EXPECT_EQ(type.size, sizeof(Probe));
    EXPECT_NE(type.step, nullptr);
    EXPECT_EQ(type.start, nullptr);
    EXPECT_EQ(type.stop, nullptr);
    EXPECT_EQ(type.work, nullptr);
    EXPECT_EQ(type.configure, nullptr);
    Probe probe;
    type.step(&probe, Cycle{});
    EXPECT_EQ(probe.steps_taken_, 1);
}

struct Siren {
    Timer pause;
    bool update_ = false;
    Sentence configure(Setup&) const { return {}; }
    void start(int) noexcept TAPPET_REALTIME {}
    void start(const Cycle&) noexcept TAPPET_REALTIME {}
    void step(const Cycle&) const noexcept TAPPET_REALTIME {}
    void update(const Cycle&) noexcept TAPPET_REALTIME { update_ = true; } // its step may call it
    void halt(const Cycle&) noexcept TAPPET_REALTIME {}
    void stopped() noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(timer<&Siren::pause, &Siren::halt>("pause", "ends the sound"),
                      operation<&Siren::stopped>("stopped", "the machine stands"));
    }
};

TEST(Interface, accepts_callable_life_cycle_functions_and_ignores_others) {
    const ComponentType& type = component_type<Siren>;
    EXPECT_EQ(type.never_run.member, "");
    EXPECT_NE(type.configure, nullptr);
    EXPECT_NE(type.start, nullptr);
    EXPECT_NE(type.step, nullptr);
    EXPECT_EQ(type.stop, nullptr);
}

TEST(Operation, runs_on_packed_arguments_of_any_sizes) {
    Probe probe;
    GatedComponent gate{&probe, ComponentState::running};
    const auto run = [&](std::string_view name, const std::byte* arguments) {
        return facet(name).operation->run(gate, Entry::at_once, arguments);
    };
    std::array<std::byte, 48> packed{};
    detail::pack(packed.data(), 2.5, -7);
    EXPECT_TRUE(run("move", packed.data()));
    EXPECT_EQ(probe.by_, 2.5);
    EXPECT_EQ(probe.mode_, -7);
    detail::pack(packed.data(), std::uint8_t{200}, 0.25, std::int16_t{-1000});
    EXPECT_TRUE(run("mixed", packed.data()));
    EXPECT_EQ(probe.mixed_, 200 + 0.25 - 1000);
    EXPECT_TRUE(run("home", packed.data()));
    EXPECT_TRUE(probe.homed_);
}

TEST(Timer, is_idle_until_armed_and_moves_when_armed_again) {
    Timer timer;
    timer.serve();
    EXPECT_EQ(timer.when(), never);
    timer.arm(at_ns(10));
    timer.arm(at_ns(5));
    EXPECT_EQ(timer.when(), at_ns(5));
    timer.cancel();
    EXPECT_EQ(timer.when(), never);
}

TEST(Timer, breaks_a_contract_when_it_is_armed_without_an_engine) {
    Timer timer;
    EXPECT_DEATH(timer.arm(at_ns(42)), "contract 106 timer-unserved: .* armed for 42 ns .* timer<");
}

TEST(Timer, runs_the_function_that_the_interface_names) {
    Probe probe;
    Cycle cycle;
    cycle.release = at_ns(42);
    facet("silence").timer->fire(&probe, cycle);
    EXPECT_EQ(probe.hushed_, at_ns(42));
}

} // namespace
