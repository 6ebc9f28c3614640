// For any inputs in any order, at any time, pieces return only numbers, respect their limits, and recover
// after some samples.
#include "kernel/pieces/integrator.hpp"
#include "kernel/pieces/lead.hpp"
#include "kernel/pieces/ramp.hpp"
#include "kernel/pieces/timers.hpp"
#include "tests/kernel/base/hostile.hpp"

namespace tappet {
namespace {

constexpr int sequences = 300, long_one = 200;
constexpr Duration usual = 1ms;

struct Pieces : test::Hostile {
    bool flip() { return random.one_in(2); }
};

TEST_F(Pieces, of_a_ramp_respect_their_rate_and_reach_their_target) {
    for (int n = 0; n < sequences; ++n) {
        const double up = flip() ? value() : 10.0, down = flip() ? value() : 10.0;
        Ramp ramp{up, down, value()};
        double before = ramp.value();
        for (int k = 0; k < long_one; ++k) {
            const double target = value();
            const Duration time = step();
            const double s = std::max(to_seconds(time), 0.0);
            const double now = ramp(target, time);
            ASSERT_TRUE(is_number(now)) << k << ": " << up << " " << down << " " << time.count() << " ns";
            const double rate = now > before ? up : down, most = rate * s;
            if (now != before) {
                ASSERT_TRUE(rate > 0.0);
                ASSERT_TRUE(!is_number(rate) ||
                            std::fabs(now - before) / 2.0 <=
                                most / 2.0 + (std::fabs(before) + std::fabs(now)) * 1e-15 + 1e-300);
                ASSERT_TRUE(now > before ? now <= target : now >= target) << "it passes " << target;
            }
            if (random.one_in(9)) ramp.reset(value());
            before = ramp.value();
            ASSERT_TRUE(is_number(before));
        }
        if (up > 1e-3 && down > 1e-3 && std::fabs(before) < 1e6) {
            EXPECT_EQ(ramp(1.0, 4'000'000'000s), 1.0);
        }
    }
}

TEST_F(Pieces, of_an_integral_stay_in_limits_and_integrate_again) {
    for (int n = 0; n < sequences; ++n) {
        const double low = flip() ? -std::numeric_limits<double>::infinity() : 10.0 * random.unit() - 5.0;
        const double high = flip() ? std::numeric_limits<double>::infinity() : std::max(low, -10.0) + 100.0;
        Integrator sum{low, high};
        const auto is_within = [&](double value) {
            return is_number(value) && value >= low && value <= high;
        };
        ASSERT_TRUE(is_within(sum.value())) << sum.value() << " of " << low << " .. " << high;
        Time at{};
        for (int k = 0; k < long_one; ++k) {
            ASSERT_TRUE(is_within(sum(value(), at = stamp(at))));
            if (random.one_in(9)) sum.pause();
            if (random.one_in(9)) sum.reset(value());
            ASSERT_TRUE(is_within(sum.value())) << sum.value() << " of " << low << " .. " << high;
        }
        sum.reset(std::max(low, 0.0));
        const double begun = sum.value();
        at = Time{1h};
        for (int k = 0; k < 1001; ++k) static_cast<void>(sum(2.0, at += usual));
        EXPECT_NEAR(sum.value(), begun + 2.0, 1e-9) << "it has forgotten the value before and its time";
    }
}

TEST_F(Pieces, of_dead_time_compensation_stay_finite_and_recover) {
    for (int n = 0; n < sequences; ++n) {
        const Duration farthest = flip() ? Duration{100ms} : std::max(step(), Duration{0});
        Lead lead{farthest};
        Time at{};
        const auto expect_numbers = [&] {
            for (const Time when : {at, at + usual, at + farthest, stamp(at), Time::min(), never}) {
                ASSERT_TRUE(is_number(lead.at(when)));
                if (when >= at && lead.good(when)) {
                    ASSERT_LE(when - at, farthest);
                }
            }
            ASSERT_TRUE(is_number(lead.per_s()));
            static_cast<void>(lead.drive_at(value(), step()));
        };
        for (int k = 0; k < long_one; ++k) {
            if (random.one_in(50)) lead.reset();
            lead.sample(value(), at = stamp(at));
            ASSERT_NO_FATAL_FAILURE(expect_numbers()) << k;
        }
        at = Time{random.between(0, 1000) * 1s};
        double place = 10.0;
        // Closely spaced samples are accepted after their distance has doubled to that before: at most 64
        // times.
        for (int k = 0; k < 66; ++k) lead.sample(place += 0.05, at += usual);
        ASSERT_TRUE(lead.good(at));
        EXPECT_NEAR(lead.per_s(), 50.0, 1e-6);
        if (farthest >= 2ms) {
            EXPECT_NEAR(lead.at(at + 2ms), place + 0.1, 1e-9);
            EXPECT_NEAR(to_seconds(lead.drive_at(place + 0.1, 0ms) - at), 2e-3, 1e-8);
        }
    }
}

/// In a constant expression, to exclude undefined behaviour.
constexpr Lead after_all_time(Time first) {
    Lead lead{Duration::max()};
    lead.sample(0.0, first);
    lead.sample(1.0, first + 1s);
    if (first == Time::min()) lead.sample(2.0, never);
    return lead;
}
static_assert(after_all_time(Time::min()).per_s() > 0.0);
static_assert(after_all_time(Time{}).drive_at(1.0 + to_seconds(Duration::max()), 0ns) == never);

/// Time advances, stands still or jumps far ahead; it never decreases. Delays are arbitrary.
TEST_F(Pieces, that_delay_use_the_configured_time_in_any_time_course) {
    for (int n = 0; n < sequences; ++n) {
        OnDelay on;
        OffDelay off;
        Pulse pulse;
        Debounced contact;
        const Duration delay = flip() ? Duration{5ms} : step();
        Time now = stamp(Time{}), changed = now;
        bool input = false, believed = contact(input, delay, now), has_been = false;
        static_cast<void>(on(false, delay, now));
        static_cast<void>(off(false, delay, now));
        static_cast<void>(pulse(false, delay, now));
        for (int k = 0; k < long_one && now < never; ++k) {
            now = std::max(now, random.one_in(30) ? now + step() : now + random.between(0, 2) * 1ms);
            if (random.one_in(5)) {
                input = !input;
                changed = now;
                has_been = true;
            }
            const bool lasted = now - changed >= delay;
            ASSERT_EQ(on(input, delay, now), input && lasted);
            ASSERT_EQ(off(input, delay, now), input || (has_been && !lasted));
            const bool is_short = pulse(input, delay, now);
            ASSERT_TRUE(!is_short || (has_been && delay > 0ns));
            const bool said = contact(input, delay, now);
            ASSERT_TRUE(said == believed || lasted);
            ASSERT_TRUE(said == input || !lasted);
            believed = said;
            ASSERT_EQ(on.elapsed(now), input ? now - changed : 0ns);
        }
    }
}

TEST_F(Pieces, that_count_saturate_at_the_ends_of_their_range) {
    using Whole = std::numeric_limits<std::int64_t>;
    for (int n = 0; n < sequences; ++n) {
        const auto preset = flip() ? static_cast<std::int64_t>(random.next()) : random.between(-3, 3);
        const std::int64_t begin = one_of(std::array{Whole::min(), Whole::max(), std::int64_t{0}, preset});
        UpCounter up{preset};
        DownCounter down{preset};
        UpDownCounter both{preset};
        both.load(begin);
        std::int64_t before = begin;
        for (int k = 0; k < long_one; ++k) {
            const bool is_up = up(flip()), is_down = down(flip());
            ASSERT_EQ(is_up, up.value() >= preset);
            ASSERT_EQ(is_down, down.value() <= 0);
            ASSERT_TRUE(down.value() >= std::min(preset, std::int64_t{0}) && down.value() <= preset);
            both(begin == Whole::max() || flip(), begin == Whole::min() || flip());
            const std::int64_t now = both.value();
            ASSERT_TRUE(now == before || (now > before ? now - 1 == before : now + 1 == before)) << before;
            before = now;
        }
        up.reset();
        EXPECT_EQ(up.value(), 0);
    }
}

} // namespace
} // namespace tappet
