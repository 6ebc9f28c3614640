// Stamps from the processor's counter agree with the clock: none is before the previous one, none is ahead.
#include "kernel/os/stamps.hpp"

#include "tests/kernel/os/folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace tappet::os {
namespace {

/// A simulated kernel that uses another clock source.
bool prove_with_source(std::string_view name) {
    const test::Folder root;
    const std::string folder = root.path + "/sys/devices/system/clocksource/clocksource0";
    std::filesystem::create_directories(folder);
    std::ofstream{folder + "/current_clocksource"} << name << '\n';
    return prove_processor_counter(root.path);
}

void expect_stamps_of_the_clock(int count, Duration late_at_most) {
    const Clock clock{Clock::Kind::real};
    Stamps stamps;
    stamps.place(clock);
    Time last{};
    for (int i = 0; i < count; ++i) {
        const Time before = Clock::monotonic();
        const Time stamp = stamps.now();
        const Time after = Clock::monotonic();
        ASSERT_GE(stamp, last) << i;
        ASSERT_LE(stamp, after) << i;
        ASSERT_GE(stamp + late_at_most, before) << i;
        last = stamp;
    }
}

TEST(Stamps, increase_and_stay_close_behind_the_clock) {
    static_cast<void>(prove_processor_counter());
    expect_stamps_of_the_clock(300'000, Stamps::most_behind);
}

TEST(Stamps, are_clock_readings_where_the_counter_is_unproven) {
    EXPECT_FALSE(prove_with_source("hpet")) << "the kernel found the counter wanting";
    EXPECT_FALSE(prove_processor_counter("/nowhere")) << "nobody says what the kernel takes";
    expect_stamps_of_the_clock(1000, Duration::zero());
}

TEST(Stamps, reach_the_current_time_once_renewed) {
    static_cast<void>(prove_processor_counter());
    const Clock clock{Clock::Kind::real};
    Stamps stamps;
    stamps.place(clock);
    for (int i = 0; i < 10'000; ++i) {
        static_cast<void>(stamps.now());
        const Time come = Clock::monotonic();
        stamps.renew();
        ASSERT_GE(stamps.now(), come) << i;
    }
}

TEST(Stamps, stand_still_in_virtual_time) {
    static_cast<void>(prove_processor_counter());
    Clock clock{Clock::Kind::virtual_time};
    Stamps stamps;
    stamps.place(clock);
    EXPECT_EQ(stamps.now(), Time{});
    clock.advance_to(at_ns(5));
    EXPECT_EQ(stamps.now(), at_ns(5));
    EXPECT_EQ(stamps.now(), at_ns(5));
}

} // namespace
} // namespace tappet::os
