// Requests of a component that sees the machine (thesis 4.2.3): each runs in its target engine between two
// steps, and a flood of them blocks no other sender.
#include "kernel/machine/plan/operations.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <cstring>

namespace tappet {
namespace {

/// Counts its steps and the requests executed between them.
struct Machinist {
    std::uint64_t steps = 0;
    std::uint64_t asked = 0;
    std::uint64_t asked_inside_a_step = 0;
    std::int64_t sum = 0;
    bool stepping = false;
    Event<> done;
    void on_done() noexcept TAPPET_REALTIME {}
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        stepping = true;
        ++steps;
        stepping = false;
    }
    static void ask(void* self, const std::byte* packed) noexcept TAPPET_REALTIME {
        auto& at = *static_cast<Machinist*>(self);
        std::int64_t value = 0;
        std::memcpy(&value, packed, sizeof value);
        ++at.asked;
        at.asked_inside_a_step += at.stepping ? 1u : 0u;
        at.sum += value;
    }
    static constexpr auto interface() {
        return facets(event<&Machinist::done>("done", "it asks the other"),
                      operation<&Machinist::on_done>("on_done", "takes over"));
    }
};

struct Blind {
    bool saw = false;
    Sentence configure(Setup& setup) {
        saw = setup.machine != nullptr;
        return {};
    }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

// clang-format off
constexpr auto table = machine("watched-by-one",
    components(component<Machinist>("left"), component<Machinist>("right"), component<Onlooker>("watcher"), component<Blind>("blind")),
    activities(
        activity("motion", every(1ms), budget(50us), runs("left")),
        activity("logic",  on_work(), at_most(4, 1ms), deadline(1ms), budget(50us), runs("right")),
        activity("office", every(100ms), not_real_time, runs("watcher", "blind"))),
    connections(), reactions(when("left.done", tell("right.on_done"))), behaviours());
// clang-format on

struct Requests : testing::Test, RunningRig<table> {
    Machinist& machinist(std::string_view name) { return the<Machinist>(name); }
    bool ask(std::size_t activity, std::string_view name, std::int64_t value) {
        Message message;
        message.run = &Machinist::ask;
        message.object = &machinist(name);
        std::memcpy(message.arguments.data(), &value, sizeof value);
        return instance.requests().post(activity, message);
    }
};

TEST_F(Requests, reach_only_the_component_that_declares_it_sees_the_machine) {
    EXPECT_EQ(the<Onlooker>("watcher").machine, &instance);
    EXPECT_FALSE(the<Blind>("blind").saw);
}

TEST_F(Requests, run_between_two_steps_of_the_addressed_engine) {
    ASSERT_TRUE(ask(0, "left", 5));
    ASSERT_TRUE(ask(0, "left", 7));
    EXPECT_EQ(machinist("left").asked, 0u); // never in the caller
    EXPECT_TRUE(world.run_until(at_ns(0) + 3ms));
    EXPECT_EQ(machinist("left").asked, 2u);
    EXPECT_EQ(machinist("left").sum, 12);
    EXPECT_EQ(machinist("left").asked_inside_a_step, 0u);
    EXPECT_EQ(machinist("right").asked, 0u);
}

TEST_F(Requests, wake_a_sleeping_activity) {
    EXPECT_TRUE(world.run_until(at_ns(0) + 10ms));
    ASSERT_TRUE(ask(1, "right", 1));
    EXPECT_TRUE(world.run_until(at_ns(0) + 10ms));
    EXPECT_EQ(machinist("right").asked, 1u);
}

TEST_F(Requests, are_refused_when_more_than_sixteen_are_pending) {
    std::size_t taken = 0;
    for (std::int64_t i = 0; i < 100; ++i) taken += ask(0, "left", i) ? 1u : 0u;
    EXPECT_EQ(taken, std::size_t{requests_waiting});
    EXPECT_TRUE(world.run_until(at_ns(0) + 2ms));
    EXPECT_EQ(machinist("left").asked, taken);
    EXPECT_TRUE(ask(0, "left", 1)); // there is room again
}

} // namespace
} // namespace tappet
