// The press' controllers, each alone: after any initial values and any inputs they recover as soon as their
// inputs are numbers again.
#include "apps/bearing_press/loops.hpp"
#include "tests/kernel/base/hostile.hpp"

#include <array>
#include <initializer_list>
#include <memory>
#include <utility>

namespace bearing_press {
namespace {

template <class Loop>
using Inputs = std::initializer_list<Input<double> Loop::*>;
template <class Loop>
using Outputs = std::initializer_list<Output<double> Loop::*>;

struct Loops : test::Hostile {
    /// Two steps after the inputs are numbers again, all outputs are numbers, and each speed is at most
    /// `most`.
    template <class Loop>
    void recover(Inputs<Loop> inputs, Outputs<Loop> outputs, double most) {
        for (int n = 0; n < 2000; ++n) {
            const auto loop = std::make_unique<Loop>();
            std::array<Output<double>, 4> told;
            Cycle cycle{.period = 1ms};
            const auto tell = [&](auto draw) {
                for (std::size_t i = 0; i < inputs.size(); ++i) told[i].write(draw());
                cycle.release = cycle.now = cycle.now + 1ms;
            };
            for (std::size_t i = 0; i < inputs.size(); ++i)
                PortAccess::data<double>.link_local(&((*loop).*(inputs.begin()[i])), &told[i], nullptr);
            tell([&] { return value(); });
            loop->start(cycle);
            for (auto k = random.below(4); k > 0; --k) {
                tell([&] { return value(); });
                loop->step(cycle);
            }
            for (int k = 0; k < 2; ++k) {
                tell([] { return 0.01; });
                loop->step(cycle);
            }
            for (std::size_t i = 0; i < outputs.size(); ++i) {
                const double said = ((*loop).*(outputs.begin()[i])).last();
                ASSERT_TRUE(is_number(said)) << "output " << i << " says " << said;
                ASSERT_LE(std::abs(said), most) << "output " << i;
            }
        }
    }
};

constexpr double any = std::numeric_limits<double>::max();

TEST_F(Loops, recover_from_any_initial_values) {
    recover<Speed>({&Speed::position}, {&Speed::velocity}, any);
    recover<Idle>({&Idle::position}, {&Idle::target, &Idle::speed}, 0.01);
    recover<Standing>({&Standing::position, &Standing::sent}, {&Standing::target, &Standing::speed}, any);
    recover<Jogging>({&Jogging::position, &Jogging::sent}, {&Jogging::target, &Jogging::speed}, any);
    recover<Path>({&Path::position}, {&Path::target, &Path::speed}, any);
    recover<Place>({&Place::target, &Place::speed, &Place::position, &Place::sent}, {&Place::velocity}, any);
    recover<Press>({&Press::target, &Press::force, &Press::sent}, {&Press::velocity}, slide.velocity);
    recover<bearing_press::Ramp>({&bearing_press::Ramp::command, &bearing_press::Ramp::sent},
                                 {&bearing_press::Ramp::target}, any);
    recover<Trim>({&Trim::target, &Trim::velocity, &Trim::sent}, {&Trim::wanted}, 0.03);
}

void link(Input<double>& input, Output<double>& output) {
    PortAccess::data<double>.link_local(&input, &output, nullptr);
}
struct ToldPlace : Place {
    Output<double> told_target, told_speed, told_position, told_sent;
    ToldPlace() {
        link(target, told_target);
        link(speed, told_speed);
        link(position, told_position);
        link(sent, told_sent);
    }
};
struct ToldRamp : bearing_press::Ramp {
    Output<double> told_sent, told_command;
    ToldRamp() {
        link(sent, told_sent);
        link(command, told_command);
    }
};

TEST_F(Loops, command_a_finite_speed_at_any_position) {
    ToldPlace place;
    for (int n = 0; n < 2000; ++n) {
        for (Output<double>* each :
             {&place.told_target, &place.told_speed, &place.told_position, &place.told_sent})
            each->write(number());
        if (n % 9 == 0) place.start({});
        place.step({.period = 1ms});
        ASSERT_TRUE(is_number(place.velocity.last()));
    }
}

TEST_F(Loops, begin_at_rest_when_the_sent_value_is_not_finite) {
    for (const double none :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        ToldRamp ramp;
        ramp.told_sent.write(0.15);
        ramp.start({});
        EXPECT_EQ(ramp.target.last(), 0.15);
        ramp.told_sent.write(none);
        ramp.start({});
        EXPECT_EQ(ramp.target.last(), 0.0) << "and not where it was when it ran before";
    }
}

/// A slide that stands at 0.1 m; its drive keeps its limits.
struct PlacedSlide : ToldPlace {
    double at = 0.1, worst = 0.0, drives = 0.0;
    PlacedSlide() { tell(); }
    void tell() {
        told_position.write(at);
        told_sent.write(drives);
    }
    void go(double wanted) {
        drives = std::clamp(wanted, -fastest, fastest);
        at += drives * 1e-3;
        worst = std::max(worst, std::abs(at - 0.1));
        tell();
    }
};

TEST_F(Loops, hold_their_position_after_a_distant_target) {
    for (const double far : {10.0, -10.0, 1e3, 1e300, -1e300, 0.2}) {
        PlacedSlide place;
        place.told_target.write(far);
        place.told_speed.write(0.0);
        place.start({});
        place.told_target.write(0.1); // it is to stay where it is
        for (int ms = 0; ms < 3000; ++ms) {
            place.step({.period = 1ms});
            place.go(place.velocity.last());
        }
        EXPECT_LT(place.worst, 1e-6) << far;
    }
}

TEST_F(Loops, begin_at_the_speed_of_the_slide) {
    for (const double target_now : {0.1, 0.3, -5.0, 1e300}) {
        ToldPlace place;
        place.told_target.write(target_now), place.told_speed.write(0.0);
        place.told_position.write(0.1), place.told_sent.write(0.15);
        place.start({});
        EXPECT_EQ(place.velocity.last(), 0.15);
        double before = 0.15;
        for (int ms = 0; ms < 500; ++ms) {
            place.step({.period = 1ms});
            ASSERT_LE(std::abs(place.velocity.last()), fastest);
            ASSERT_LT(std::abs(place.velocity.last() - before), 0.01) << "it jumps";
            before = place.velocity.last();
        }
        const double wanted = 20.0 * (target_now - 0.1);
        EXPECT_NEAR(before, std::clamp(wanted, -fastest, fastest), 1e-4);
    }
}

TEST_F(Loops, recover_from_a_command_beyond_the_speed_of_the_drive) {
    ToldRamp ramp;
    ramp.told_sent.write(0.0);
    ramp.told_command.write(1e300);
    ramp.start({});
    for (int ms = 0; ms < 5000; ++ms) ramp.step({.period = 1ms});
    ramp.told_command.write(0.0);
    for (int ms = 0; ms < 64; ++ms) ramp.step({.period = 1ms}); // 0.25 m/s at 4 m/s2 take 63
    EXPECT_EQ(ramp.target.last(), 0.0);
}

TEST_F(Loops, begin_within_the_speed_of_the_drive_whatever_was_sent) {
    for (const double far : {1e300, -1e300, 50.0}) {
        Output<double> sent, position, target, command;
        sent.write(far), position.write(0.1), target.write(0.1), command.write(0.0);
        const auto begin = [&](auto& loop) {
            link(loop.sent, sent);
            if constexpr (requires { loop.position; }) link(loop.position, position);
            loop.start({});
            for (int ms = 1; ms <= 300; ++ms) loop.step({Time{ms * 1ms}, Time{ms * 1ms}, 1ms});
        };
        Jogging jogging;
        begin(jogging);
        EXPECT_EQ(jogging.speed.last(), 0.0) << far;
        EXPECT_NEAR(jogging.target.last(), 0.1, 0.05) << far;
        Standing standing;
        begin(standing);
        EXPECT_NEAR(standing.target.last(), 0.1, 0.05) << far;
        Place place;
        link(place.target, target);
        begin(place);
        EXPECT_LE(std::abs(place.velocity.last()), fastest) << far;
        bearing_press::Ramp ramp;
        link(ramp.command, command);
        begin(ramp);
        EXPECT_EQ(ramp.target.last(), 0.0) << far;
    }
}

struct Seat {
    int times = 0;
    void once_more() noexcept TAPPET_REALTIME { ++times; }
};

TEST_F(Loops, seat_no_bearing_when_the_force_is_not_a_number) {
    Output<double> target, force;
    Press press;
    Seat seated;
    std::array<Subscriber<>, 1> reactions;
    GatedComponent gate{&seated, ComponentState::running};
    PortAccess::event<>.give_storage(&press.seated, reactions.data());
    EventHandle{
        PortAccess::event<>.subscribe(&press.seated, detail::operation_of<&Seat::once_more>.enter, &gate), 1,
        nullptr}
        .connect();
    link(press.target, target);
    link(press.force, force);
    const auto press_for_a_second = [&](double with) {
        target.write(2000.0);
        force.write(with);
        press.start({});
        for (Time now{}; now < Time{1s}; now += 1ms) press.step({now, now, 1ms});
        return std::exchange(seated.times, 0);
    };
    EXPECT_GT(press_for_a_second(1990.0), 0);
    EXPECT_EQ(press_for_a_second(std::numeric_limits<double>::quiet_NaN()), 0);
}

} // namespace
} // namespace bearing_press
