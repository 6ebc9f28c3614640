// The types that a map describes, each once, in the order of their first use, and their description in the
// layout.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/machine/map/layout.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tappet::map {

inline constexpr std::size_t max_types = 512;

/// Not constexpr: a table with more types does not compile, and the error names this function.
inline void a_map_has_room_for_512_types() {}

/// Used by the compiler only.
class TypeList {
public:
    /// Returns its index; appends it when it is new.
    constexpr std::uint32_t of(TypeId type) {
        for (std::size_t i = 0; i < types_.size(); ++i)
            if (types_[i] == type) return static_cast<std::uint32_t>(i);
        if (!types_.push(type)) a_map_has_room_for_512_types();
        return static_cast<std::uint32_t>(types_.size() - 1);
    }
    [[nodiscard]] constexpr std::size_t size() const noexcept { return types_.size(); }
    constexpr TypeId operator[](std::size_t i) const noexcept { return types_[i]; }

private:
    Bounded<TypeId, max_types> types_{};
};

constexpr Shape shape_of(const TypeTag& tag) noexcept {
    switch (tag.kind) {
    case ValueKind::opaque: return Shape::opaque;
    case ValueKind::boolean: return Shape::boolean;
    case ValueKind::integer: return Shape::integer;
    case ValueKind::natural: return Shape::natural;
    case ValueKind::real: return Shape::real;
    case ValueKind::duration: return Shape::duration;
    case ValueKind::text: return Shape::text;
    case ValueKind::matrix: return Shape::matrix;
    case ValueKind::record: return Shape::record;
    case ValueKind::enumeration: return Shape::enumeration;
    case ValueKind::sequence: return Shape::sequence;
    case ValueKind::arguments: return Shape::arguments;
    }
    return Shape::opaque;
}

/// Describes everything but names, element, fields and enumerators.
constexpr Type describe(const TypeTag& tag) noexcept {
    Type type;
    type.shape = shape_of(tag);
    type.size = tag.size;
    type.row_major = tag.row_major ? 1 : 0;
    type.rows = static_cast<std::uint32_t>(tag.rows);
    type.columns = static_cast<std::uint32_t>(tag.columns);
    type.length_at = static_cast<std::uint32_t>(tag.length_at);
    type.length_bytes = static_cast<std::uint8_t>(tag.length_bytes);
    return type;
}

/// Calls put(name, unit, type, offset) for each field of a record, whose offset start-up adds later, or for
/// each element of an argument list.
template <class Put>
constexpr void for_each_field(const TypeTag& tag, Put&& put) {
    for (const RecordField& field : tag.fields) put(field.name, field.unit, field.type, 0);
    std::size_t at = 0;
    for (const TypeId element : tag.elements) {
        put("", "", element, at);
        at += element->size;
    }
}

/// A counter of an engine, and its place.
struct EngineFigure {
    std::string_view name{};
    std::string_view unit{};
    std::string_view doc{};
    TypeId type = nullptr;
    std::size_t at = 0; ///< in EngineStatistics
};

inline constexpr auto engine_figures = std::to_array<EngineFigure>({
    {"cycles", "", "cycles so far", type_id<std::uint64_t>, offsetof(EngineStatistics, cycles)},
    {"messages", "", "messages served", type_id<std::uint64_t>, offsetof(EngineStatistics, messages)},
    {"misses", "", "missed deadlines", type_id<std::uint64_t>, offsetof(EngineStatistics, misses)},
    {"skipped_periods", "", "periods that began too late to run", type_id<std::uint64_t>,
     offsetof(EngineStatistics, skipped_periods)},
    {"wakes_too_many", "", "wakes beyond what the row promised", type_id<std::uint64_t>,
     offsetof(EngineStatistics, wakes_too_many)},
    {"longest_response", "", "from release to the end, at worst", type_id<Duration>,
     offsetof(EngineStatistics, longest_response)},
    {"longest_lateness", "", "from release to the beginning, at worst", type_id<Duration>,
     offsetof(EngineStatistics, longest_lateness)},
    {"longest_busy", "", "from the beginning to the end, at worst", type_id<Duration>,
     offsetof(EngineStatistics, longest_busy)},
    {"most_processor", "", "processor time for one claim of its row; 0: it was never in doubt",
     type_id<Duration>, offsetof(EngineStatistics, most_processor)},
    {"over_claim", "", "how often it was measured to take more than its row claims", type_id<std::uint64_t>,
     offsetof(EngineStatistics, over_claim)},
    {"measured_claims", "", "how often that was measured", type_id<std::uint64_t>,
     offsetof(EngineStatistics, measured_claims)},
});
static_assert(std::is_standard_layout_v<EngineStatistics>);

} // namespace tappet::map
