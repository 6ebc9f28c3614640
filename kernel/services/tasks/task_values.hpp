// The types of a script that a task can have as properties, and as arguments of its command.
#pragma once

#include "kernel/component/property_interface.hpp"
#include "kernel/program/operator_kinds.hpp"

#include <cstring>
#include <type_traits>

namespace tappet::detail {

/// The C++ type of a script's variable that a command can pass; void: a command cannot pass it.
template <TypeId id>
using TaskValue = std::conditional_t<
    id == script_bool, bool,
    std::conditional_t<
        id == script_int, ScriptInt,
        std::conditional_t<id == script_double, double,
                           std::conditional_t<id == script_duration, Duration,
                                              std::conditional_t<id == script_text, ScriptText, void>>>>>;

/// Property operations for a type that is known only by its tag: an enumeration, a vector or a matrix of
/// doubles.
template <TypeId id> struct TaggedProperty {
    static constexpr bool is_list = id->kind == ValueKind::matrix;
    static constexpr TypeId element = is_list ? id->element : id;
    static constexpr std::size_t count = is_list ? id->rows * id->columns : 1;

    static std::size_t size(const std::byte*) noexcept TAPPET_REALTIME { return count; }
    static bool resize(std::byte*, std::size_t wanted) noexcept TAPPET_REALTIME { return wanted == count; }
    static std::byte* at(std::byte* value, std::size_t i) noexcept TAPPET_REALTIME {
        return value + i * element->size;
    }
    static double number(const std::byte* value, std::size_t i) noexcept TAPPET_REALTIME {
        if constexpr (is_list) return load_value<double>(value + i * element->size);
        std::uint64_t named = 0; // little endian
        std::memcpy(&named, value, element->size);
        return static_cast<double>(named);
    }
    static void set(std::byte* value, const PropertySetting& setting) noexcept {
        if constexpr (is_list)
            for (std::size_t i = 0; i < count; ++i) {
                const PropertySetting each = setting.list->at(i);
                store_value(value + i * element->size, each.kind == PropertySetting::Kind::real
                                                           ? each.real
                                                           : static_cast<double>(each.integer));
            }
        else
            std::memcpy(value, &setting.integer, element->size);
    }
    static constexpr PropertyOperations operations{.kind = is_list ? PropertySetting::Kind::real
                                                                   : PropertySetting::Kind::enumeration,
                                                   .is_list = is_list,
                                                   .element = element,
                                                   .least_size = count,
                                                   .most_size = count,
                                                   .set = &set,
                                                   .size = &size,
                                                   .resize = &resize,
                                                   .at = &at,
                                                   .number = &number};
};

/// Returns the operations of a property of that type; null: it cannot be one (a record, an opaque type, a
/// sequence).
template <TypeId id>
inline constexpr const PropertyOperations* task_property = [] {
    if constexpr (!std::is_void_v<TaskValue<id>>)
        return &PropertyAccess<TaskValue<id>>::operations;
    else if constexpr ((id->kind == ValueKind::enumeration && id->size <= sizeof(std::int64_t)) ||
                       (id->kind == ValueKind::matrix && id->element == script_double))
        return &TaggedProperty<id>::operations;
    else
        return static_cast<const PropertyOperations*>(nullptr);
}();

} // namespace tappet::detail
