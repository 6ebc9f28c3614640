// Exact angles of a shaft: integers of 2^-32 turn, so that a turn wraps by itself and nothing drifts. Angle
// is a position within one turn, ShaftPosition a position on the unwound shaft, Rotation the distance between
// two positions.
#pragma once

#include "kernel/base/realtime.hpp"

#include <compare>
#include <cstdint>

namespace tappet {

/// A signed amount of rotation in 2^-32 turn (84 nano-degrees); positive is forward.
class Rotation {
public:
    static constexpr std::int64_t units_per_turn = std::int64_t{1} << 32;

    constexpr Rotation() noexcept = default;
    [[nodiscard]] static constexpr Rotation units(std::int64_t units) noexcept TAPPET_REALTIME {
        return Rotation{units};
    }
    [[nodiscard]] static constexpr Rotation turns(std::int64_t turns) noexcept TAPPET_REALTIME {
        return Rotation{turns * units_per_turn};
    }
    /// Rounds to the nearest unit; NaN and values beyond 2^30 turns are clamped to that range.
    [[nodiscard]] static constexpr Rotation degrees(double degrees) noexcept TAPPET_REALTIME {
        const double units = degrees * units_per_degree;
        constexpr double limit = 0x1p62;
        if (!(units > -limit)) return Rotation{-(std::int64_t{1} << 62)};
        if (!(units < limit)) return Rotation{std::int64_t{1} << 62};
        return Rotation{static_cast<std::int64_t>(units + (units < 0 ? -0.5 : 0.5))};
    }
    [[nodiscard]] constexpr std::int64_t in_units() const noexcept TAPPET_REALTIME { return units_; }
    [[nodiscard]] constexpr double in_degrees() const noexcept TAPPET_REALTIME {
        return static_cast<double>(units_) * (1.0 / units_per_degree);
    }
    constexpr auto operator<=>(const Rotation&) const noexcept = default;
    constexpr Rotation operator-() const noexcept TAPPET_REALTIME { return Rotation{wrap(0, units_, -1)}; }
    friend constexpr Rotation operator+(Rotation a, Rotation b) noexcept TAPPET_REALTIME {
        return Rotation{wrap(a.units_, b.units_, 1)};
    }
    friend constexpr Rotation operator-(Rotation a, Rotation b) noexcept TAPPET_REALTIME {
        return Rotation{wrap(a.units_, b.units_, -1)};
    }

private:
    friend class ShaftPosition;
    static constexpr double units_per_degree = 0x1p32 / 360.0;
    explicit constexpr Rotation(std::int64_t units) noexcept : units_(units) {}
    // Modulo 2^64, so that a shaft may turn forever: only distances between near positions are compared.
    static constexpr std::int64_t wrap(std::int64_t a, std::int64_t b, int sign) noexcept TAPPET_REALTIME {
        const auto x = static_cast<std::uint64_t>(a);
        const auto y = static_cast<std::uint64_t>(b);
        return static_cast<std::int64_t>(sign > 0 ? x + y : x - y);
    }
    std::int64_t units_ = 0;
};

/// A position within one turn, in [0, 360) degrees.
class Angle {
public:
    constexpr Angle() noexcept = default;
    /// The position that a rotation from zero leads to. Implicit: `Angle stop = 310_deg;`
    constexpr Angle(Rotation from_zero) noexcept // NOLINT(google-explicit-constructor)
        : units_(static_cast<std::uint32_t>(from_zero.in_units())) {}
    [[nodiscard]] static constexpr Angle degrees(double degrees) noexcept TAPPET_REALTIME {
        return Angle{Rotation::degrees(degrees)};
    }
    /// Returns units of 2^-32 turn.
    [[nodiscard]] constexpr std::uint32_t in_units() const noexcept TAPPET_REALTIME { return units_; }
    [[nodiscard]] constexpr double in_degrees() const noexcept TAPPET_REALTIME {
        return Rotation::units(units_).in_degrees();
    }
    /// Returns the shortest rotation from b to a, in [-180, 180) degrees.
    friend constexpr Rotation operator-(Angle a, Angle b) noexcept TAPPET_REALTIME {
        return Rotation::units(static_cast<std::int32_t>(a.units_ - b.units_));
    }
    friend constexpr Angle operator+(Angle a, Rotation b) noexcept TAPPET_REALTIME {
        return Angle{Rotation::units(a.units_) + b};
    }
    friend constexpr Angle operator-(Angle a, Rotation b) noexcept TAPPET_REALTIME {
        return Angle{Rotation::units(a.units_) - b};
    }
    constexpr bool operator==(const Angle&) const noexcept = default;

private:
    std::uint32_t units_ = 0;
};

/// Returns the forward rotation from `from` to `to`, in [0, 360) degrees.
constexpr Rotation forward_way(Angle from, Angle to) noexcept TAPPET_REALTIME {
    return Rotation::units(static_cast<std::uint32_t>(to.in_units() - from.in_units()));
}

/// A position on the unwound shaft: whole turns and the angle. It wraps after 2^31 turns (two years at 2000
/// rpm); differences stay right. There is therefore no `<`: compare `a - b` with a Rotation.
class ShaftPosition {
public:
    constexpr ShaftPosition() noexcept = default;
    constexpr ShaftPosition(std::int64_t turns, Angle angle) noexcept TAPPET_REALTIME
        : from_zero_(Rotation::turns(turns) + Rotation::units(angle.in_units())) {}
    [[nodiscard]] constexpr Angle angle() const noexcept TAPPET_REALTIME { return Angle{from_zero_}; }
    [[nodiscard]] constexpr std::int64_t turns() const noexcept TAPPET_REALTIME {
        return from_zero_.in_units() >> 32;
    }
    [[nodiscard]] constexpr double in_degrees() const noexcept TAPPET_REALTIME {
        return from_zero_.in_degrees();
    }
    friend constexpr Rotation operator-(ShaftPosition a, ShaftPosition b) noexcept TAPPET_REALTIME {
        return a.from_zero_ - b.from_zero_;
    }
    friend constexpr ShaftPosition operator+(ShaftPosition a, Rotation b) noexcept TAPPET_REALTIME {
        a.from_zero_ = a.from_zero_ + b;
        return a;
    }
    friend constexpr ShaftPosition operator-(ShaftPosition a, Rotation b) noexcept TAPPET_REALTIME {
        a.from_zero_ = a.from_zero_ - b;
        return a;
    }
    constexpr bool operator==(const ShaftPosition&) const noexcept = default;

private:
    Rotation from_zero_;
};

/// A speed of rotation; positive is forward.
class Speed {
public:
    constexpr Speed() noexcept = default;
    [[nodiscard]] static constexpr Speed deg_s(double value) noexcept TAPPET_REALTIME { return Speed{value}; }
    [[nodiscard]] static constexpr Speed rpm(double value) noexcept TAPPET_REALTIME {
        return Speed{value * 6.0};
    }
    [[nodiscard]] constexpr double in_deg_s() const noexcept TAPPET_REALTIME { return deg_s_; }
    [[nodiscard]] constexpr double in_rpm() const noexcept TAPPET_REALTIME { return deg_s_ / 6.0; }
    constexpr auto operator<=>(const Speed&) const noexcept = default;

private:
    explicit constexpr Speed(double deg_s) noexcept : deg_s_(deg_s) {}
    double deg_s_ = 0.0;
};

inline namespace literals {
// A rotation, not an angle: 400_deg keeps its whole turn, so that a table's check can reject it.
constexpr Rotation operator""_deg(unsigned long long value) noexcept {
    return Rotation::degrees(static_cast<double>(value));
}
constexpr Rotation operator""_deg(long double value) noexcept {
    return Rotation::degrees(static_cast<double>(value));
}
constexpr Speed operator""_rpm(unsigned long long value) noexcept {
    return Speed::rpm(static_cast<double>(value));
}
constexpr Speed operator""_rpm(long double value) noexcept { return Speed::rpm(static_cast<double>(value)); }
} // namespace literals

} // namespace tappet
