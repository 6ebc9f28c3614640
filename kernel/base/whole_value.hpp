// A check that bytes from outside are a value of their type: the lengths in it are within its capacity.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/type_tag.hpp"

#include <array>
#include <cstring>

namespace tappet {

/// Returns the number of characters or elements that a text or a sequence claims to have.
inline std::uint64_t length_in(const TypeTag& type, const std::byte* value) noexcept TAPPET_REALTIME {
    std::uint64_t length = 0;
    std::memcpy(&length, value + type.length_at,
                type.length_bytes); // little-endian, as both architectures are
    return length;
}

/// Returns false when a text or a sequence in the value is longer than its type. Checks records and lists
/// too, up to eight levels deep, but no struct without named fields. Bounded by the type, without recursion.
/// Real-time.
inline bool is_whole(const TypeTag& type, const std::byte* value) noexcept TAPPET_REALTIME {
    struct Visit {
        const TypeTag* of; ///< its parts are checked one after the other
        const std::byte* at;
        std::uint64_t parts;
        std::uint64_t seen = 0;
    };
    std::array<Visit, 8> open;
    std::size_t depth = 0;
    // Checks a value, and stores its parts. Returns false when it is too long, or too deep.
    const auto enter = [&](const TypeTag& of, const std::byte* at) noexcept TAPPET_REALTIME {
        std::uint64_t parts = 0;
        switch (of.kind) {
        case ValueKind::text: return length_in(of, at) <= of.columns;
        case ValueKind::sequence:
            parts = length_in(of, at);
            if (parts > of.columns) return false;
            break;
        case ValueKind::matrix: parts = of.rows * of.columns; break;
        case ValueKind::record: parts = of.fields.size(); break;
        case ValueKind::arguments: parts = of.elements.size(); break;
        default: return true;
        }
        if (parts == 0 || (of.element != nullptr && of.element->kind < ValueKind::text)) return true;
        if (depth == open.size()) return false;
        open[depth++] = {&of, at, parts};
        return true;
    };
    if (!enter(type, value)) return false;
    while (depth != 0) {
        Visit& now = open[depth - 1];
        if (now.seen == now.parts) {
            --depth;
            continue;
        }
        const std::uint64_t part = now.seen++;
        const TypeTag* of = now.of->element;
        const std::byte* at = now.at;
        if (now.of->kind == ValueKind::record) {
            of = now.of->fields[part].type;
            at += now.of->fields[part].offset();
        } else if (now.of->kind == ValueKind::arguments) { // packed one after the other
            of = now.of->elements[part];
            now.at += of->size;
        } else {
            at += part * of->size;
        }
        if (!enter(*of, at)) return false;
    }
    return true;
}

} // namespace tappet
