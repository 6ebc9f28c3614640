// The identity, the name and the shape of a type, as plain data. Two ends of a row fit when their tags are
// the same object. Code that shows, reads or stores a value needs only its bytes and its tag.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/bounded_text.hpp"
#include "kernel/base/fixed_matrix.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace tappet {

/// The meaning of the bytes of a value.
enum class ValueKind : std::uint8_t {
    opaque,      ///< known only to the component's own code
    boolean,     ///< bool
    integer,     ///< signed integer of `size` bytes, also an enumeration without names
    natural,     ///< unsigned integer of `size` bytes, also an enumeration without names
    real,        ///< float or double
    duration,    ///< Duration, or Time since the machine's epoch: nanoseconds in an int64
    text,        ///< Text<N>
    matrix,      ///< fixed-size Eigen, or std::array: rows * columns elements
    record,      ///< a struct that names its fields
    enumeration, ///< an enum that names its values
    sequence,    ///< Bounded<T, N>
    arguments,   ///< of an event or an operation: `elements`, packed one after the other without gaps
};

struct TypeTag;
using TypeId = const TypeTag*;
struct RegisteredOperator; ///< kernel/program/registered.hpp

inline constexpr std::size_t max_fields = 64;

/// A named member of a record.
struct RecordField {
    std::string_view name{};
    std::string_view unit{};
    TypeId type = nullptr;
    /// Returns the offset from the beginning of the record, in bytes. Real-time.
    std::size_t (*offset)() noexcept TAPPET_REALTIME = nullptr;
};

struct TypeTag {
    std::string_view name{};
    std::size_t size = 0;
    std::size_t align = 0;
    bool arithmetic = false;
    std::span<const TypeId> elements{}; ///< of an argument list
    ValueKind kind = ValueKind::opaque;
    bool row_major = false;       ///< of a matrix; otherwise its columns are one after the other
    TypeId element = nullptr;     ///< of a matrix or a sequence; of an enumeration its integer type
    std::size_t rows = 0;         ///< of a matrix
    std::size_t columns = 0;      ///< of a matrix; of a text or a sequence: its capacity, beginning at byte 0
    std::size_t length_at = 0;    ///< of a text or a sequence: offset of its length,
    std::size_t length_bytes = 0; ///< and the size of that length: 4 or 8 bytes
    std::span<const RecordField> fields{};         ///< of a record, in its own order
    std::span<const std::string_view> names{};     ///< of an enumeration: the value is the index
    const RegisteredOperator* operators = nullptr; ///< operators for scripts, operator_count of them
    std::size_t operator_count = 0;
};

/// The argument list of an event or an operation, as a type.
template <class... Types>
struct Arguments {};

/// Names the fields of a struct; a struct without names is opaque:
///     template <> inline constexpr auto tappet::fields_of<Pose> =
///         fields(field<&Pose::x>("x", "mm"), field<&Pose::turn>("turn", "deg"));
template <class T>
inline constexpr std::array<RecordField, 0> fields_of{};

/// The default for a type without operators.
struct NoOperators {
    static constexpr const RegisteredOperator* list = nullptr;
    static constexpr std::size_t count = 0;
};

/// Operators and functions that scripts may apply to a type, see kernel/program/registered.hpp.
template <class T>
inline constexpr NoOperators operators_of{};

/// Names the values of an enum, from 0 on; a value without a name is shown as a number:
///     template <> inline constexpr auto tappet::names_of<Cause> =
///         std::array<std::string_view, 2>{"none", "weft"};
template <class E>
inline constexpr std::array<std::string_view, 0> names_of{};

namespace detail {

// Both compilers print the template argument after "T = "; the text around it is cut off here.
template <class T>
consteval std::string_view printed_name() {
    constexpr std::string_view whole = __PRETTY_FUNCTION__;
    constexpr std::size_t begin = whole.find("T = ") + 4;
    constexpr std::size_t end = whole.find_first_of(";]", begin);
    return whole.substr(begin, end - begin);
}

template <class... T>
consteval std::string_view printed_list() {
    constexpr std::string_view whole = __PRETTY_FUNCTION__;
    constexpr std::size_t begin = whole.find("T = ") + 5;
#if defined(__clang__)
    constexpr std::size_t end = whole.rfind('>'); // "<double, int>"
#else
    constexpr std::size_t end = whole.find('}', begin); // "{double, int}"
#endif
    return whole.substr(begin, end - begin);
}

template <class T>
struct TagOf;

template <class T>
struct ShapeOf {
    static constexpr void put(TypeTag& tag) noexcept {
        if constexpr (std::same_as<T, bool>)
            tag.kind = ValueKind::boolean;
        else if constexpr (std::integral<T> && sizeof(T) <= sizeof(std::int64_t))
            tag.kind = std::signed_integral<T> ? ValueKind::integer : ValueKind::natural;
        else if constexpr (std::same_as<T, float> || std::same_as<T, double>)
            tag.kind = ValueKind::real;
        else if constexpr (std::same_as<T, Duration> || std::same_as<T, Time>)
            tag.kind = ValueKind::duration;
        else if constexpr (std::is_enum_v<T>)
            put_enumeration(tag);
        else if constexpr (!fields_of<T>.empty())
            tag.kind = ValueKind::record, tag.fields = fields_of<T>;
        else if constexpr (FixedSizeEigen<T>)
            put_matrix<typename T::Scalar>(tag, T::RowsAtCompileTime, T::ColsAtCompileTime, T::IsRowMajor);
    }
    static constexpr void put_enumeration(TypeTag& tag) noexcept {
        using Integer = std::underlying_type_t<T>;
        tag.kind = !names_of<T>.empty()            ? ValueKind::enumeration
                   : std::signed_integral<Integer> ? ValueKind::integer
                                                   : ValueKind::natural;
        tag.element = &TagOf<Integer>::tag;
        tag.names = names_of<T>;
    }
    template <class Element>
    static constexpr void put_matrix(TypeTag& tag, std::size_t rows, std::size_t columns,
                                     bool row_major) noexcept {
        tag.kind = ValueKind::matrix;
        tag.element = &TagOf<Element>::tag;
        tag.rows = rows, tag.columns = columns, tag.row_major = row_major;
    }
};
template <class T, std::size_t N>
    requires(N > 0)
struct ShapeOf<std::array<T, N>> {
    static constexpr void put(TypeTag& tag) noexcept { ShapeOf<T>::template put_matrix<T>(tag, N, 1, false); }
};
template <std::size_t N>
struct ShapeOf<Text<N>> {
    static constexpr void put(TypeTag& tag) noexcept {
        tag.kind = ValueKind::text;
        tag.columns = N;
        tag.length_bytes = sizeof(Text<N>::length);
        tag.length_at = (N + tag.length_bytes - 1) / tag.length_bytes * tag.length_bytes;
        static_assert(sizeof(Text<N>) == (N + 3) / 4 * 4 + 4, "the characters, then their number");
    }
};
template <class T, std::size_t N>
struct ShapeOf<Bounded<T, N>> {
    static constexpr void put(TypeTag& tag) noexcept {
        tag.kind = ValueKind::sequence;
        tag.element = &TagOf<T>::tag;
        tag.columns = N;
        tag.length_bytes = sizeof(std::size_t);
        tag.length_at = (sizeof(std::array<T, N>) + alignof(std::size_t) - 1) / alignof(std::size_t) *
                        alignof(std::size_t);
    }
};

template <class T>
struct TagOf {
    static constexpr TypeTag tag = [] {
        TypeTag made{printed_name<T>(), sizeof(T), alignof(T), std::is_arithmetic_v<T>};
        ShapeOf<T>::put(made);
        using Operators = std::remove_cvref_t<decltype(operators_of<T>)>;
        made.operators = Operators::list, made.operator_count = Operators::count;
        return made;
    }();
};
template <class... T>
struct TagOf<Arguments<T...>> {
    static constexpr std::array<TypeId, sizeof...(T)> elements{&TagOf<T>::tag...};
    static constexpr TypeTag tag{printed_list<T...>(), (std::size_t{0} + ... + sizeof(T)), 1, false, elements,
                                 ValueKind::arguments};
};
template <>
struct TagOf<Arguments<>> {
    static constexpr TypeTag tag{"", 0, 1, false, {}, ValueKind::arguments};
};

template <auto Member>
struct FieldOf;
template <class Record, class T, T Record::* Member>
struct FieldOf<Member> {
    using Type = T;
    // Found by a comparison of addresses, which is allowed in a constant expression and which the compiler
    // folds.
    static constexpr std::size_t offset() noexcept TAPPET_REALTIME {
        union Place {
            char bytes[sizeof(Record)];
            Record record;
            constexpr Place() noexcept : bytes{} {}
            constexpr ~Place() {}
        };
        Place place;
        for (std::size_t i = 0; i < sizeof(Record); ++i)
            if (static_cast<const void*>(&place.bytes[i]) ==
                static_cast<const void*>(&(place.record.*Member)))
                return i;
        return sizeof(Record);
    }
};

} // namespace detail

template <class T>
inline constexpr TypeId type_id = &detail::TagOf<T>::tag;

/// Makes a field for fields_of.
template <auto Member>
constexpr RecordField field(std::string_view name, std::string_view unit = {}) noexcept {
    using Field = detail::FieldOf<Member>;
    return {name, unit, type_id<typename Field::Type>, &Field::offset};
}
template <class... Fields>
constexpr std::array<RecordField, sizeof...(Fields)> fields(const Fields&... each) noexcept {
    static_assert(sizeof...(Fields) <= max_fields, "a record of more fields is made of smaller records");
    return {each...};
}

} // namespace tappet
