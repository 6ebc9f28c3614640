// A check that all numbers of a value are finite, for any type, by its tag.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/type_tag.hpp"

#include <algorithm>

namespace tappet {

/// Returns false when a float or double in the value is infinite or NaN. An opaque value is not examined.
inline bool has_only_numbers(const TypeTag& type, const std::byte* value) noexcept {
    const auto has_them = [&](std::size_t count) {
        for (std::size_t i = 0; i < count; ++i)
            if (!has_only_numbers(*type.element, value + i * type.element->size)) return false;
        return true;
    };
    switch (type.kind) {
    case ValueKind::real: return is_number(real_at(value, type.size));
    case ValueKind::matrix: return has_them(type.rows * type.columns);
    case ValueKind::sequence: {
        std::uint64_t used = 0; // little-endian, in its own width
        std::memcpy(&used, value + type.length_at, type.length_bytes);
        return has_them(std::min<std::size_t>(used, type.columns));
    }
    case ValueKind::record:
        return std::ranges::all_of(type.fields, [&](const RecordField& field) {
            return has_only_numbers(*field.type, value + field.offset());
        });
    default: return true;
    }
}

} // namespace tappet
