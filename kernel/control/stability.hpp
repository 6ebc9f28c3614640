// Stability and overshoot of a sampled loop: an integrator behind a dead time of whole samples, under
// proportional and integral control (Astrom and Wittenmark, Computer-Controlled Systems, 1997, chapter 3;
// Jury 1964).
#pragma once

#include <array>
#include <cstddef>

namespace tappet::control_detail {

/// Maximum dead time of the analysis in samples.
inline constexpr std::size_t max_dead_samples = 32;

/// x(k+1) = x(k) + T v(k-d), v = Kp e + Ki T sum(e): proportional is Kp T, integral Ki T T.
struct SampledLoop {
    double proportional = 0.0;
    double integral = 0.0;
    std::size_t dead_samples = 0;    ///< upper bound
    std::size_t varying_samples = 0; ///< part of them that may change arbitrarily from step to step
};

namespace stability_detail {

struct Complex {
    double re = 0.0, im = 0.0;
    friend constexpr Complex operator*(Complex a, Complex b) noexcept {
        return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
    friend constexpr Complex operator+(Complex a, Complex b) noexcept { return {a.re + b.re, a.im + b.im}; }
    friend constexpr Complex operator*(double a, Complex b) noexcept { return {a * b.re, a * b.im}; }
    [[nodiscard]] constexpr double square() const noexcept { return re * re + im * im; }
};

/// Stability with an integral part: whatever the delay does between d and d + N samples, |T(z)| N |z - 1| < 1
/// on the unit circle keeps the loop stable, where T is the closed loop at d (Kao and Lincoln, Simple
/// stability criteria for systems with time-varying delays, Automatica 40, 2004).
constexpr bool is_stable_at_any_delay(const SampledLoop& loop) noexcept {
    constexpr Complex turn{0.99998117528260111, 0.0061358846491544753}; // a 512th of half a circle
    const auto most = static_cast<double>(loop.varying_samples);
    Complex z{1.0, 0.0};
    for (int i = 0; i < 512; ++i) {
        z = z * turn;
        Complex shift{1.0, 0.0};
        for (std::size_t d = loop.varying_samples; d < loop.dead_samples; ++d) shift = shift * z;
        const Complex moved = z + Complex{-1.0, 0.0};
        const Complex acts = loop.proportional * moved + loop.integral * z;
        const Complex closed = shift * moved * moved + acts;
        if (acts.square() * most * most * moved.square() >= closed.square()) return false;
    }
    return true;
}

} // namespace stability_detail

/// Returns the largest stable proportional gain times period, without an integral part, for a delay that
/// varies between 0 and `dead_samples`: 2, 0.875, 0.556, .. (Erbe, Xia and Yu 1995).
constexpr double most_stable_at_any_delay(std::size_t dead_samples) noexcept {
    const auto n = static_cast<double>(dead_samples + 1);
    return (1.5 + 0.5 / n) / n;
}

/// Applies Jury's test to z^d (z-1) + L, and with an integral part to z^d (z-1)(z-1) + L (z-1) + Li z: all
/// roots inside the unit circle. It proves nothing for a varying delay; the two functions above do.
constexpr bool is_stable(const SampledLoop& loop) noexcept {
    if (loop.dead_samples > max_dead_samples) return false;
    if (loop.varying_samples != 0 && loop.integral == 0.0 &&
        !(loop.proportional < most_stable_at_any_delay(loop.dead_samples)))
        return false;
    if (loop.varying_samples != 0 && loop.integral != 0.0 && !stability_detail::is_stable_at_any_delay(loop))
        return false;
    std::array<double, max_dead_samples + 3> a{}; // coefficient of z to the power of its index
    const std::size_t d = loop.dead_samples;
    std::size_t degree = d + 1;
    if (loop.integral == 0.0) {
        a[d + 1] += 1.0;
        a[d] -= 1.0;
        a[0] += loop.proportional;
    } else {
        degree = d + 2;
        a[d + 2] += 1.0;
        a[d + 1] -= 2.0;
        a[d] += 1.0;
        a[1] += loop.proportional + loop.integral;
        a[0] -= loop.proportional;
    }
    // Each round reduces the degree by one; after the check, the reduced polynomial has all roots inside the
    // unit circle exactly if the previous one has.
    for (; degree > 0; --degree) {
        const double top = a[degree], bottom = a[0];
        if (!(bottom < top && bottom > -top)) return false;
        std::array<double, max_dead_samples + 3> next{};
        for (std::size_t i = 0; i < degree; ++i) next[i] = a[i + 1] - bottom / top * a[degree - 1 - i];
        a = next;
    }
    return true;
}

/// Returns the largest stable proportional gain times period, without an integral part and at this constant
/// delay: 2, 1, 0.618, 0.445, ..
constexpr double most_stable(std::size_t dead_samples) noexcept {
    double low = 0.0, high = 2.0;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (is_stable({middle, 0.0, dead_samples}) ? low : high) = middle;
    }
    return low;
}

/// Returns the largest one without overshoot: d^d / (d+1)^(d+1).
constexpr double most_without_overshoot(std::size_t dead_samples) noexcept {
    double bound = 1.0;
    const auto d = static_cast<double>(dead_samples);
    for (std::size_t i = 0; i < dead_samples; ++i) bound *= d / (d + 1.0);
    return bound / (d + 1.0);
}

} // namespace tappet::control_detail
