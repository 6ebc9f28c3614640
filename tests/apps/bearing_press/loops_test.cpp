// The press' controllers, each alone: whatever they began with or were told, they are what they were as soon
// as their inputs are numbers again.
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
    /// Two steps after the inputs are numbers again, all outputs are, and what is a speed is at most `most`.
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

TEST_F(Loops, recover_from_whatever_they_began_with) {
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

TEST_F(Loops, of_places_ask_for_a_number_however_far_the_place_is) {
    Output<double> target, speed, position, sent;
    Place place;
    PortAccess::data<double>.link_local(&place.target, &target, nullptr);
    PortAccess::data<double>.link_local(&place.speed, &speed, nullptr);
    PortAccess::data<double>.link_local(&place.position, &position, nullptr);
    PortAccess::data<double>.link_local(&place.sent, &sent, nullptr);
    for (int n = 0; n < 2000; ++n) {
        for (Output<double>* each : {&target, &speed, &position, &sent}) each->write(number());
        if (n % 9 == 0) place.start({});
        place.step({.period = 1ms});
        ASSERT_TRUE(is_number(place.velocity.last()));
    }
}

TEST_F(Loops, begin_from_rest_when_they_were_sent_what_is_no_number) {
    for (const double none :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Output<double> sent, command;
        bearing_press::Ramp ramp;
        PortAccess::data<double>.link_local(&ramp.sent, &sent, nullptr);
        PortAccess::data<double>.link_local(&ramp.command, &command, nullptr);
        sent.write(0.15);
        ramp.start({});
        EXPECT_EQ(ramp.target.last(), 0.15);
        sent.write(none);
        ramp.start({});
        EXPECT_EQ(ramp.target.last(), 0.0) << "and not where it was when it ran before";
    }
}

struct Seat {
    int times = 0;
    void once_more() noexcept TAPPET_REALTIME { ++times; }
};

TEST_F(Loops, seat_no_bearing_with_a_force_that_is_no_number) {
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
    PortAccess::data<double>.link_local(&press.target, &target, nullptr);
    PortAccess::data<double>.link_local(&press.force, &force, nullptr);
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
