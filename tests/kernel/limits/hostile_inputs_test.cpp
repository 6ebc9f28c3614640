// Whatever a component writes, at any time and in any order, from its start on, each output is a number
// within its limits. Bounds that do not fit the port are refused.
#include "kernel/limits/limits.hpp"

#include "tests/kernel/base/hostile.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

namespace tappet {
namespace {

/// Writes the test's value with a stamp of the test's choice.
struct Drive {
    double speed_wanted = 0.0, force_wanted = 0.0;
    std::int64_t place_wanted = 0;
    Time stamp{};
    Output<double> speed;
    Output<float> force;
    Output<std::int8_t> notch;
    Output<std::uint16_t> place;
    void start(const Cycle&) noexcept TAPPET_REALTIME { write(); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { write(); }
    static constexpr auto interface() {
        return facets(output<&Drive::speed>("speed", "rpm", "of the drive"),
                      output<&Drive::force>("force", "N", "of the ram"),
                      output<&Drive::notch>("notch", "", "of the lever"),
                      output<&Drive::place>("place", "mm", "of the ram"));
    }

private:
    void write() noexcept TAPPET_REALTIME {
        constexpr double most = std::numeric_limits<float>::max();
        speed.write(speed_wanted, stamp);
        // A double beyond this is not a finite float.
        force.write(is_number(force_wanted) ? static_cast<float>(std::clamp(force_wanted, -most, most))
                                            : std::numeric_limits<float>::quiet_NaN(),
                    stamp);
        notch.write(static_cast<std::int8_t>(place_wanted), stamp);
        place.write(static_cast<std::uint16_t>(place_wanted), stamp);
    }
};

using test::infinite, test::no_number;

template <class... Rows>
constexpr auto machine_with(const Rows&... rows) {
    return machine("press", components(component<Drive>("drive")),
                   activities(activity("motion", every(1ms), budget(50us), runs("drive"))), connections(),
                   reactions(), behaviours(), limits(rows...));
}

constexpr double per_second = 700.0;
constexpr double lowest_force = 0.1F, highest_force = 2.7F;
constexpr auto held = machine_with(limit("drive.speed", 5.0, 40.0), rate("drive.speed", per_second),
                                   limit("drive.force", lowest_force, highest_force),
                                   limit("drive.notch", -3.0, 5.0), rate("drive.place", per_second));

struct Drives : test::Hostile, VirtualRig {
    Drive* drive = instance.find<Drive>("drive");

    Drives() : VirtualRig{AtRunTime<held, test_board>::machine()} {}
    void want() {
        drive->speed_wanted = value();
        drive->force_wanted = value();
        drive->place_wanted = static_cast<std::int64_t>(random.next());
        drive->stamp = stamp(drive->stamp);
    }
    void expect_held() const {
        const double speed = drive->speed.last(), force = static_cast<double>(drive->force.last());
        ASSERT_TRUE(speed >= 5.0 && speed <= 40.0) << speed;
        ASSERT_TRUE(force >= lowest_force && force <= highest_force) << force;
        ASSERT_TRUE(drive->notch.last() >= -3 && drive->notch.last() <= 5) << int{drive->notch.last()};
    }
};

TEST_F(Drives, never_leave_their_limits) {
    start([this] { want(); });
    ASSERT_NO_FATAL_FAILURE(expect_held()) << "at the start";
    for (int n = 0; n < 2000; ++n) {
        const double speed = drive->speed.last(), place = drive->place.last();
        const auto judged = [this](Time stamp) {
            return std::min(judged_stamp(stamp, clock.now()), clock.now());
        };
        const Time before = judged(drive->stamp);
        want();
        ASSERT_TRUE(run(1ms));
        ASSERT_NO_FATAL_FAILURE(expect_held()) << n;
        const double most = per_second * std::max(to_seconds(judged(drive->stamp) - before), 0.0);
        ASSERT_LE(std::fabs(drive->speed.last() - speed), most + 1e-9) << n;
        ASSERT_LE(std::fabs(drive->place.last() - place), most + 1.0) << n << ", to the next whole number";
    }
    drive->speed_wanted = 7.0;
    drive->place_wanted = 8;
    for (int n = 0; n < 200'000 && drive->place.last() != 8; ++n) {
        drive->stamp = clock.now();
        ASSERT_TRUE(run(1ms));
    }
    for (std::size_t row = 0; row < 5; ++row)
        EXPECT_GT(instance.observation().counted(0, row).times, 100u) << row;
    EXPECT_EQ(drive->speed.last(), 7.0);
    EXPECT_EQ(drive->place.last(), 8);
}

// ---- rows with an empty range

template <class... Rows>
Sentence refusal(const Rows&... rows) {
    const auto table = machine_with(rows...);
    return Accepted{table.view(), test_board}.refusal();
}

TEST(Rows, are_refused_when_a_bound_does_not_fit_the_port) {
    for (const LimitRow& row :
         {limit("drive.speed", no_number, 1.0), limit("drive.speed", 0.0, no_number),
          limit("drive.speed", infinite, infinite), limit("drive.speed", -infinite, -infinite),
          limit("drive.speed", -0.0, 0.0), rate("drive.speed", no_number), rate("drive.speed", -1.0),
          rate("drive.speed", infinite), limit("drive.force", 1e39, 1e40), limit("drive.force", 0.0, 2.7),
          limit("drive.notch", -129.0, 5.0), limit("drive.place", 0.0, 1e300),
          limit("drive.place", -1.0, 5.0)})
        EXPECT_FALSE(refusal(row).empty()) << row.output << " " << row.low << " " << row.high;
    EXPECT_TRUE(refusal(limit("drive.speed", -std::numeric_limits<double>::max(), 1e306),
                        rate("drive.speed", 1e306), limit("drive.force", 0.0, infinite))
                    .empty());
}

} // namespace
} // namespace tappet
