// Primitives on values of any type: copies, parts of values, texts, and flow within a node.
#pragma once

#include "kernel/program/value_access.hpp"

namespace tappet::primitive {

/// Copies `size` bytes.
constexpr ActionResult copy(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                            const std::byte*) noexcept TAPPET_REALTIME {
    copy_bytes(to, a, in.size);
    return ActionResult::done;
}
constexpr ActionResult fail(ProgramContext&, const Instruction&, std::byte*, const std::byte*,
                            const std::byte*) noexcept TAPPET_REALTIME {
    return ActionResult::failed;
}

/// Skips the next `size` instructions when `a` is false, or true.
constexpr ActionResult skip_unless(ProgramContext&, const Instruction&, std::byte*, const std::byte* a,
                                   const std::byte*) noexcept TAPPET_REALTIME {
    return load_value<bool>(a) ? ActionResult::done : ActionResult::skip;
}
constexpr ActionResult skip_if(ProgramContext&, const Instruction&, std::byte*, const std::byte* a,
                               const std::byte*) noexcept TAPPET_REALTIME {
    return load_value<bool>(a) ? ActionResult::skip : ActionResult::done;
}

// ---- equality of enumerations: compares their bytes

constexpr bool same_bytes(const Instruction& in, const std::byte* a, const std::byte* b) noexcept
    TAPPET_REALTIME {
    for (std::size_t i = 0; i < in.size; ++i)
        if (a[i] != b[i]) return false;
    return true;
}
/// `to`: whether `a` and `b` are equal, or are not.
template <bool wanted, bool (*same)(const Instruction& in, const std::byte* a, const std::byte* b) noexcept
          TAPPET_REALTIME>
constexpr ActionResult compare(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                               const std::byte* b) noexcept TAPPET_REALTIME {
    store_value(to, same(in, a, b) == wanted);
    return ActionResult::done;
}
inline constexpr Primitive bytes_equal = &compare<true, &same_bytes>;
inline constexpr Primitive bytes_unequal = &compare<false, &same_bytes>;

// ---- texts: characters from the first byte on, followed by their number as in Text<N>

constexpr std::size_t text_length(const std::byte* text, std::size_t length_at) noexcept TAPPET_REALTIME {
    const std::size_t length = load_value<std::uint32_t>(text + length_at);
    return length < length_at ? length : length_at;
}
/// `size`: capacity of `to` in characters; count(): offset of the length of `a`. A text that is too long
/// fails.
constexpr ActionResult text_copy(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                                 const std::byte*) noexcept TAPPET_REALTIME {
    const std::size_t length = text_length(a, in.count());
    if (length > in.size) return ActionResult::failed;
    const std::size_t length_at = (in.size + std::size_t{3}) / 4 * 4;
    copy_bytes(to, a, length);
    for (std::size_t i = length; i < length_at; ++i) to[i] = std::byte{0};
    store_value(to + length_at, static_cast<std::uint32_t>(length));
    return ActionResult::done;
}
/// `size`: offset of the length of `a`; count(): that of `b`.
constexpr bool same_text(const Instruction& in, const std::byte* a, const std::byte* b) noexcept
    TAPPET_REALTIME {
    const std::size_t length = text_length(a, in.size);
    if (length != text_length(b, in.count())) return false;
    for (std::size_t i = 0; i < length; ++i)
        if (a[i] != b[i]) return false;
    return true;
}
inline constexpr Primitive text_equal = &compare<true, &same_text>;
inline constexpr Primitive text_unequal = &compare<false, &same_text>;

// ---- parts of values

/// `to` = a.field; copies the field's bytes.
inline ActionResult field_read(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                               const std::byte*) noexcept TAPPET_REALTIME {
    copy_bytes(to, a + in.field->offset(), in.size);
    return ActionResult::done;
}
/// to.field = `a`
inline ActionResult field_write(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                                const std::byte*) noexcept TAPPET_REALTIME {
    copy_bytes(to + in.field->offset(), a, in.size);
    return ActionResult::done;
}

constexpr bool in_range(ScriptInt index, std::size_t count) noexcept TAPPET_REALTIME {
    return index >= 0 && static_cast<std::uint64_t>(index) < count;
}
/// `to` = a[b], of count() elements of `size` bytes; `b` is an int.
constexpr ActionResult element_read(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                                    const std::byte* b) noexcept TAPPET_REALTIME {
    const auto index = load_value<ScriptInt>(b);
    if (!in_range(index, in.count())) return ActionResult::failed;
    copy_bytes(to, a + static_cast<std::size_t>(index) * in.size, in.size);
    return ActionResult::done;
}
/// to[b] = `a`
constexpr ActionResult element_write(ProgramContext&, const Instruction& in, std::byte* to,
                                     const std::byte* a, const std::byte* b) noexcept TAPPET_REALTIME {
    const auto index = load_value<ScriptInt>(b);
    if (!in_range(index, in.count())) return ActionResult::failed;
    copy_bytes(to + static_cast<std::size_t>(index) * in.size, a, in.size);
    return ActionResult::done;
}
/// Computes the index of element (a, b) of a matrix of rows x columns for element_read; `inner`: row-major.
constexpr ActionResult matrix_index(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                                    const std::byte* b) noexcept TAPPET_REALTIME {
    const auto row = load_value<ScriptInt>(a);
    const auto column = load_value<ScriptInt>(b);
    if (!in_range(row, in.rows) || !in_range(column, in.columns)) return ActionResult::failed;
    store_value(to, in.inner != 0 ? row * in.columns + column : column * in.rows + row);
    return ActionResult::done;
}

/// Returns the number of elements of the sequence `a`: its length is stored at `length_at` in 8 bytes; at
/// most `most`.
constexpr std::size_t sequence_length(const std::byte* a, std::size_t length_at, std::size_t most) noexcept
    TAPPET_REALTIME {
    const auto length = load_value<std::uint64_t>(a + length_at);
    return length < most ? static_cast<std::size_t>(length) : most;
}
/// Returns the offset of the length of a sequence of count() elements of `size` bytes: after them (Bounded).
constexpr std::size_t length_place(const Instruction& in) noexcept TAPPET_REALTIME {
    return (in.count() * in.size + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t) * sizeof(std::uint64_t);
}
/// As element_read, limited to the elements present.
constexpr ActionResult sequence_read(ProgramContext& context, const Instruction& in, std::byte* to,
                                     const std::byte* a, const std::byte* b) noexcept TAPPET_REALTIME {
    const std::size_t length = sequence_length(a, length_place(in), in.count());
    if (!in_range(load_value<ScriptInt>(b), length)) return ActionResult::failed;
    return element_read(context, in, to, a, b);
}
/// As element_write, limited to the elements present.
constexpr ActionResult sequence_write(ProgramContext& context, const Instruction& in, std::byte* to,
                                      const std::byte* a, const std::byte* b) noexcept TAPPET_REALTIME {
    const std::size_t length = sequence_length(to, length_place(in), in.count());
    if (!in_range(load_value<ScriptInt>(b), length)) return ActionResult::failed;
    return element_write(context, in, to, a, b);
}
constexpr ActionResult sequence_size(ProgramContext&, const Instruction& in, std::byte* to,
                                     const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    store_value(to, static_cast<ScriptInt>(sequence_length(a, in.size, in.count())));
    return ActionResult::done;
}

// ---- time

/// Time since the node was entered, as a Duration.
constexpr ActionResult elapsed(ProgramContext& context, const Instruction&, std::byte* to, const std::byte*,
                               const std::byte*) noexcept TAPPET_REALTIME {
    const ProgramPosition& at = context.position;
    store_value(to, at.entered ? context.now - at.entered_at : Duration{});
    return ActionResult::done;
}
/// The machine's time since its world began, as a Duration.
constexpr ActionResult time_now(ProgramContext& context, const Instruction&, std::byte* to, const std::byte*,
                                const std::byte*) noexcept TAPPET_REALTIME {
    store_value(to, context.now.time_since_epoch());
    return ActionResult::done;
}

} // namespace tappet::primitive
