// Properties (thesis 4.7): configuration of a component, with a default in the component, a value in the
// table, and the commissioning engineer's changes in a file.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/bounded_text.hpp"
#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/component/facet_member.hpp"
#include "kernel/exchange/words.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <type_traits>

namespace tappet {

/// Up to N values of one kind, in place: for a property whose length may change.
template <class T, std::size_t N>
using Sequence = Bounded<T, N>;

namespace detail {

template <class T>
inline constexpr bool is_text = false;
template <std::size_t N>
inline constexpr bool is_text<Text<N>> = true;
template <class T>
inline constexpr bool is_sequence = false;
template <class T, std::size_t N>
inline constexpr bool is_sequence<Bounded<T, N>> = true;

template <class T>
concept PropertyScalar =
    std::same_as<T, bool> || std::same_as<T, double> || std::same_as<T, float> || std::same_as<T, Duration> ||
    (std::integral<T> && !std::same_as<T, char>) || std::is_enum_v<T> || is_text<T>;

template <class T>
struct ListElement {
    using Type = void;
};
template <class T, std::size_t N>
struct ListElement<Bounded<T, N>> {
    using Type = T;
};
template <FixedSizeEigen T>
struct ListElement<T> {
    using Type = typename T::Scalar;
};

} // namespace detail

/// The value types a property may have: boolean, numbers, Duration, Text<N>, enumerations, and lists of
/// these: Sequence<T, N> and vectors and matrices of Eigen of fixed size (column by column).
template <class T>
concept PropertyValue =
    detail::PropertyScalar<T> || detail::PropertyScalar<typename detail::ListElement<T>::Type>;

/// A property. Read by its own component, from its own activity. Once the machine runs, only a
/// PropertyTransaction changes it, between two steps.
template <PropertyValue T>
class Property : FacetMember<member::property> {
public:
    using Value = T;
    constexpr Property() noexcept = default;
    constexpr explicit Property(const T& initial) noexcept : value_{initial} {}
    [[nodiscard]] constexpr const T& get() const noexcept TAPPET_REALTIME { return value_; }
    constexpr operator const T&() const noexcept TAPPET_REALTIME {
        return value_;
    } // NOLINT: reads like the value
    constexpr void set(const T& value) noexcept TAPPET_REALTIME { value_ = value; }

private:
    T value_{};
};

struct ListSetting;

/// A property's value in a table row, as plain data.
struct PropertySetting {
    enum class Kind : std::uint8_t { real, integer, boolean, duration, text, enumeration, list };
    Kind kind = Kind::real;
    double real = 0;
    std::int64_t integer = 0; ///< whole number, boolean (0 or 1), nanoseconds, or an enumeration's value
    std::string_view text{};
    TypeId type = nullptr; ///< of an enumeration
    const ListSetting* list = nullptr;
};

/// The elements of a list, which is a constant of the program.
struct ListSetting {
    std::size_t size = 0;
    PropertySetting (*at)(std::size_t i) = nullptr;
};

/// The range of a property's value, both ends included: of a time in seconds, of a list for each element.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();

    /// Returns whether a property may have this value. Every change of a property is checked here; even an
    /// unbounded range holds finite numbers only.
    [[nodiscard]] constexpr bool holds(double value) const noexcept TAPPET_REALTIME {
        return is_number(value) && value >= low && value <= high;
    }
};

/// Functions for a property's value of one type, for start-up, transactions and files. A property has the
/// address of its value: the functions take the value's bytes, in place or as a copy.
struct PropertyOperations {
    PropertySetting::Kind kind = PropertySetting::Kind::real; ///< of the value, or of a list's elements
    bool is_list = false;
    TypeId element = nullptr; ///< type of a list's elements; else the value's own
    std::size_t least_size = 1;
    std::size_t most_size = 1;
    std::int64_t least = 0; ///< least whole number that this type can hold
    std::int64_t most = 0;
    std::size_t most_characters = 0; ///< of a text
    /// Sets the value from a table's row. The setting was checked to fit.
    void (*set)(std::byte* value, const PropertySetting&) noexcept = nullptr;
    std::size_t (*size)(const std::byte* value) noexcept TAPPET_REALTIME = nullptr;
    /// Returns false when the type has no room for so many elements, or has another fixed number of them.
    bool (*resize)(std::byte* value, std::size_t size) noexcept TAPPET_REALTIME = nullptr;
    std::byte* (*at)(std::byte* value, std::size_t i) noexcept TAPPET_REALTIME = nullptr;
    /// Returns element i as a number in the range's unit; 0 for a type without numbers.
    double (*number)(const std::byte* value, std::size_t i) noexcept TAPPET_REALTIME = nullptr;
};

} // namespace tappet
