// Properties (thesis 4.7): configuration of a component, with its default in the component and its value in
// the table.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <concepts>
#include <cstdint>
#include <limits>

namespace tappet {

/// The value types a property may have.
template <class T>
concept PropertyValue = std::same_as<T, double> || std::same_as<T, std::int64_t> || std::same_as<T, bool> ||
                        std::same_as<T, Duration>;

template <PropertyValue T>
class Property {
public:
    using Value = T;
    constexpr explicit Property(T initial = T{}) noexcept : value_{initial} {}
    [[nodiscard]] constexpr const T& get() const noexcept TAPPET_REALTIME { return value_; }
    constexpr operator const T&() const noexcept TAPPET_REALTIME {
        return value_;
    } // NOLINT: reads like the value
    constexpr void set(const T& value) noexcept TAPPET_REALTIME { value_ = value; }

private:
    T value_;
};

/// A property's value in a table row: one of the value types, as plain data.
struct PropertySetting {
    enum class Kind : std::uint8_t { real, whole, truth, duration };
    Kind kind = Kind::real;
    double real = 0;
    std::int64_t whole = 0; ///< whole number, truth (0 or 1), or nanoseconds
};

/// The range a property's value lies in, both ends included.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

} // namespace tappet
