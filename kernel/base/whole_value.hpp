// Whether bytes that came from outside are a value of their type: the lengths in it lie within its room.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/type_tag.hpp"

#include <cstring>

namespace tappet {

/// The number of characters or elements that a text or a sequence says it has.
inline std::uint64_t length_in(const TypeTag& type, const std::byte* value) noexcept TAPPET_REALTIME {
    std::uint64_t length = 0;
    std::memcpy(&length, value + type.length_at,
                type.length_bytes); // little-endian, as both architectures are
    return length;
}

/// False when a text or a sequence in the value is longer than its type. Looks into records and lists; not
/// into a struct without named fields. Bounded by the type. Real-time.
inline bool is_whole(const TypeTag& type, const std::byte* value) noexcept TAPPET_REALTIME {
    std::uint64_t elements = 0;
    switch (type.kind) {
    case ValueKind::text: return length_in(type, value) <= type.columns;
    case ValueKind::sequence:
        elements = length_in(type, value);
        if (elements > type.columns) return false;
        break;
    case ValueKind::matrix: elements = type.rows * type.columns; break;
    case ValueKind::record:
        for (const RecordField& field : type.fields)
            if (!is_whole(*field.type, value + field.offset())) return false;
        return true;
    case ValueKind::arguments:
        for (const TypeId each : type.elements) {
            if (!is_whole(*each, value)) return false;
            value += each->size;
        }
        return true;
    default: return true;
    }
    if (type.element->kind < ValueKind::text) return true;
    for (std::uint64_t i = 0; i < elements; ++i)
        if (!is_whole(*type.element, value + i * type.element->size)) return false;
    return true;
}

} // namespace tappet
