// Extreme sensor values and clock times, drawn at random, for code that must survive them.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/time.hpp"
#include "tests/kernel/base/seeded.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace tappet::test {

struct Hostile : Seeded {

    template <class T, std::size_t n>
    T one_of(const std::array<T, n>& of) {
        return of[random.below(n)];
    }
    /// Infinite, not a number, extremely large or small, random bits, and occasionally a usual value.
    double value() {
        using Real = std::numeric_limits<double>;
        static constexpr std::array worst{
            Real::quiet_NaN(), Real::infinity(), Real::max(),        1e306, 3.4e38,
            Real::min(),       1e-310,           Real::denorm_min(), 0.0,   1.0};
        const double size = random.one_in(3) ? any_size() : one_of(worst);
        return random.one_in(2) ? size : -size;
    }
    double number() {
        for (;;)
            if (const double drawn = value(); is_number(drawn)) return drawn;
    }
    /// A value that may be allowed as a limit, a gain or a width.
    double positive() { return std::fabs(number()); }
    /// Over the whole range of double, or the usual range of machines.
    double any_size() {
        if (random.one_in(3)) return std::bit_cast<double>(random.next());
        return usual_size();
    }
    double usual_size() { return std::pow(10.0, 8.0 * random.unit() - 4.0); }
    Duration step() {
        constexpr auto worst = std::to_array<Duration>({0ns, 1ns, 1ms, 1h, 9'223'372'036s, Duration::max()});
        const Duration size =
            random.one_in(4) ? Duration{random.between(0, to_ns(never) - 1)} : one_of(worst);
        return random.one_in(3) ? -size : size;
    }
    /// After `before`, equal to it, far from it in either direction, or the earliest or latest time.
    Time stamp(Time before) {
        if (random.one_in(2)) return before + 1ms;
        return random.one_in(8) ? one_of(std::array{Time::min(), Time{}, never}) : before + step();
    }
};

} // namespace tappet::test
