// Encodes readings, and keeps what a client has.
#include "toolchain/tools/gateway/frame.hpp"

#include "toolchain/tools/browser/reading_text.hpp"
#include "toolchain/tools/gateway/bounds.hpp"
#include "toolchain/tools/gateway/encoding.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tappet::network {

namespace {

template <class Number> void add(std::string& bytes, Number number) {
    static_assert(std::endian::native == std::endian::little);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// Reads an integer of 1, 2, 4 or 8 bytes.
template <class Of8, class Of4, class Of2, class Of1> Of8 integer_of(std::span<const std::byte> bytes) {
    const auto as = [&]<class Number>(Number number) {
        std::memcpy(&number, bytes.data(), sizeof number);
        return static_cast<Of8>(number);
    };
    switch (bytes.size()) {
    case 1: return as(Of1{});
    case 2: return as(Of2{});
    case 4: return as(Of4{});
    default: return as(Of8{});
    }
}

double real_of(std::span<const std::byte> bytes) {
    float narrow = 0;
    double wide = 0;
    if (bytes.size() == sizeof narrow) return std::memcpy(&narrow, bytes.data(), sizeof narrow), narrow;
    return std::memcpy(&wide, bytes.data(), sizeof wide), wide;
}

void add_text(std::string& frame, std::string_view text) {
    const std::string clean = as_utf8(text);
    const std::string_view part = cut(clean, bounds.text_bytes);
    add(frame, static_cast<std::uint16_t>(part.size()));
    frame += part;
}

std::uint8_t flags_of(const browser::MapReader& map, const browser::Reading& reading) {
    if (reading.busy) return frame_busy;
    const std::string_view flow = browser::flow_of(map, reading);
    return static_cast<std::uint8_t>(
        (reading.forced ? frame_forced : 0) | (flow == "stale" ? frame_stale : 0) |
        (flow == "never_written" ? frame_never_written : 0) | (flow == "unread" ? frame_unread : 0));
}

/// Returns the characters of a text; the map was checked, so they lie inside the value.
std::string_view characters_of(const map::Type& type, std::span<const std::byte> bytes) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + type.length_at, type.length_bytes);
    return {reinterpret_cast<const char*>(bytes.data()) + type.items_at,
            std::min<std::uint64_t>(length, type.columns)};
}

bool is_number(const map::Type& type) {
    return type.size == 1 || type.size == 2 || type.size == 4 || type.size == 8;
}

} // namespace

FrameKind frame_kind(const browser::MapReader& map, std::uint32_t index) {
    const map::Type& type = map.types()[index];
    switch (type.shape) {
    case map::Shape::real: return type.size == 4 || type.size == 8 ? FrameKind::real : FrameKind::text;
    case map::Shape::integer: return is_number(type) ? FrameKind::integer : FrameKind::text;
    case map::Shape::natural: return is_number(type) ? FrameKind::natural : FrameKind::text;
    case map::Shape::boolean: return type.size == 1 ? FrameKind::boolean : FrameKind::text;
    case map::Shape::duration: return type.size == 8 ? FrameKind::duration : FrameKind::text;
    default: return FrameKind::text;
    }
}

std::string_view to_text(FrameKind kind) {
    switch (kind) {
    case FrameKind::none: return "none";
    case FrameKind::real: return "real";
    case FrameKind::integer: return "integer";
    case FrameKind::natural: return "natural";
    case FrameKind::boolean: return "boolean";
    case FrameKind::text: return "text";
    case FrameKind::duration: return "duration";
    }
    return "none";
}

void add_value(std::string& frame, const browser::MapReader& map, const browser::Reading& reading) {
    add(frame, flags_of(map, reading));
    const std::uint32_t type = map.facets()[reading.facet].type;
    const bool has_none = reading.busy || reading.value.empty() || type == map::none;
    const FrameKind kind = has_none ? FrameKind::none : frame_kind(map, type);
    add(frame, static_cast<std::uint8_t>(kind));
    add(frame, has_none ? std::int64_t{-1} : reading.stamp_ns);
    const std::span<const std::byte> bytes{reading.value};
    switch (kind) {
    case FrameKind::none: break;
    case FrameKind::real: add(frame, real_of(bytes)); break;
    case FrameKind::duration:
    case FrameKind::integer:
        add(frame, integer_of<std::int64_t, std::int32_t, std::int16_t, std::int8_t>(bytes));
        break;
    case FrameKind::natural:
        add(frame, integer_of<std::uint64_t, std::uint32_t, std::uint16_t, std::uint8_t>(bytes));
        break;
    case FrameKind::boolean: add(frame, static_cast<std::uint8_t>(bytes[0] != std::byte{0} ? 1 : 0)); break;
    case FrameKind::text: {
        const map::Type& of = map.types()[type];
        add_text(frame, of.shape == map::Shape::text
                            ? characters_of(of, bytes)
                            : std::string_view{browser::to_text(map, type, bytes, browser::Style::json)});
        break;
    }
    }
}

std::string Frames::make(const Station& station, std::span<const std::uint32_t> facets, std::int64_t now_ns) {
    const browser::MapReader& map = station.place()->map;
    std::string frame;
    fresh_.clear();
    std::string values;
    for (std::size_t i = 0; i < facets.size(); ++i) {
        std::string value;
        add_value(value, map, station.reading(facets[i]));
        if (value == known_[i]) continue;
        add(values, static_cast<std::uint16_t>(i));
        values += value;
        fresh_.emplace_back(i, std::move(value));
    }
    add(frame, frame_magic);
    add(frame, id_);
    add(frame, ++sequence_);
    add(frame, lost_);
    add(frame, station.machine_ns());
    add(frame, station.age_ns(now_ns));
    add(frame, static_cast<std::uint16_t>(fresh_.size()));
    return frame + values;
}

void Frames::keep() {
    for (auto& [index, value] : fresh_) known_[index] = std::move(value);
    fresh_.clear();
}

} // namespace tappet::network
