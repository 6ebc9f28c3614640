// Walks a type and its bytes, both from the machine's memory.
#include "toolchain/tools/browser/value.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace tappet::browser {

namespace {

using map::Shape;
using Bytes = std::span<const std::byte>;

template <class T> T load(Bytes bytes) {
    T value{};
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
}

std::uint64_t natural(Bytes bytes, std::uint64_t size) {
    switch (size) {
    case 1: return load<std::uint8_t>(bytes);
    case 2: return load<std::uint16_t>(bytes);
    case 4: return load<std::uint32_t>(bytes);
    case 8: return load<std::uint64_t>(bytes);
    default: return 0;
    }
}

std::int64_t whole(Bytes bytes, std::uint64_t size) {
    switch (size) {
    case 1: return load<std::int8_t>(bytes);
    case 2: return load<std::int16_t>(bytes);
    case 4: return load<std::int32_t>(bytes);
    case 8: return load<std::int64_t>(bytes);
    default: return 0;
    }
}

template <class Real> std::string real_text(Real value, Style style) {
    std::array<char, 64> text{};
    const auto end = style == Style::brief ? std::to_chars(text.data(), text.data() + text.size(), value,
                                                           std::chars_format::general, 6)
                                           : std::to_chars(text.data(), text.data() + text.size(), value);
    const std::string number{text.data(), end.ptr};
    if (style == Style::plain && !std::isfinite(value)) return "null";
    return style == Style::json && !std::isfinite(value) ? in_quotes(number) : number;
}

bool is_clock(const MapReader& map, const map::Type& type) {
    return map.text(type.name).find("time_point") != std::string_view::npos;
}

/// Returns the time in the largest unit with a whole part, with `digits` significant digits.
std::string rounded_time(std::int64_t nanoseconds, int digits) {
    if (nanoseconds == 0) return "0s";
    const double magnitude = std::abs(static_cast<double>(nanoseconds));
    const auto [unit, name] = magnitude < 1e3   ? std::pair{1e0, "ns"}
                              : magnitude < 1e6 ? std::pair{1e3, "us"}
                              : magnitude < 1e9 ? std::pair{1e6, "ms"}
                                                : std::pair{1e9, "s"};
    const double value = static_cast<double>(nanoseconds) / unit;
    const int before_point = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    const double places = std::pow(10.0, std::max(0, digits - before_point));
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(),
                                   std::round(value * places) / places, std::chars_format::fixed);
    return std::string{text.data(), end.ptr} + name;
}

class Writer {
public:
    Writer(const MapReader& map, Style style) : map_{map}, style_{style} {}

    std::string write(std::uint32_t type_index, Bytes bytes) const {
        const map::Type& type = map_.types()[type_index];
        switch (type.shape) {
        case Shape::boolean: return std::to_integer<int>(bytes[0]) != 0 ? "true" : "false";
        case Shape::integer: return std::to_string(whole(bytes, type.size));
        case Shape::natural: return std::to_string(natural(bytes, type.size));
        case Shape::real:
            return type.size == sizeof(float) ? real_text(load<float>(bytes), style_)
                                              : real_text(load<double>(bytes), style_);
        case Shape::duration: {
            const auto nanoseconds = load<std::int64_t>(bytes);
            if (style_ == Style::plain) return real_text(static_cast<double>(nanoseconds) * 1e-9, style_);
            if (style_ == Style::brief)
                return is_clock(map_, type) ? clock_text(nanoseconds) : rounded_time(nanoseconds, 6);
            return style_ == Style::json ? in_quotes(duration_text(nanoseconds)) : duration_text(nanoseconds);
        }
        case Shape::text: return text(type, bytes);
        case Shape::enumeration: return enumerator(type, bytes);
        case Shape::matrix: return matrix(type, bytes);
        case Shape::sequence: return sequence(type, bytes);
        case Shape::record: return record(type, bytes);
        case Shape::arguments: return arguments(type, bytes);
        case Shape::opaque: break;
        }
        const std::string what = "<" + std::to_string(type.size) + " bytes>";
        return is_json() ? in_quotes(what) : what;
    }

private:
    [[nodiscard]] bool is_json() const { return style_ == Style::json || style_ == Style::plain; }
    [[nodiscard]] std::string text(const map::Type& type, Bytes bytes) const {
        const std::uint64_t length =
            std::min<std::uint64_t>(natural(bytes.subspan(type.length_at), type.length_bytes), type.columns);
        const std::string_view characters{reinterpret_cast<const char*>(bytes.data()) + type.items_at,
                                          length};
        if (!is_json()) return in_quotes(characters);
        // Invalid UTF-8 becomes U+FFFD.
        return nlohmann::json(characters).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    }

    [[nodiscard]] std::string enumerator(const map::Type& type, Bytes bytes) const {
        const std::int64_t value = whole(bytes, type.size);
        for (std::uint32_t i = 0; i < type.enumerator_count; ++i) {
            const map::Enumerator& each = map_.enumerators()[type.first_enumerator + i];
            // The value of an unsigned enumeration may be written without its sign.
            if (each.value == value ||
                (type.size < 8 && each.value == static_cast<std::int64_t>(natural(bytes, type.size)))) {
                const std::string_view name = map_.text(each.name);
                return is_json() ? in_quotes(name) : std::string{name};
            }
        }
        return std::to_string(value);
    }

    template <class Item> static std::string list(std::uint64_t count, Item&& item) {
        std::string all = "[";
        for (std::uint64_t i = 0; i < count; ++i) {
            if (i > 0) all += ", ";
            all += item(i);
        }
        return all + "]";
    }

    [[nodiscard]] std::string matrix(const map::Type& type, Bytes bytes) const {
        const std::uint64_t one = map_.types()[type.element].size;
        const auto item = [&](std::uint64_t row, std::uint64_t column) {
            const std::uint64_t index =
                type.row_major != 0 ? row * type.columns + column : column * type.rows + row;
            return write(type.element, bytes.subspan(type.items_at + index * one, one));
        };
        if (type.columns == 1) return list(type.rows, [&](std::uint64_t i) { return item(i, 0); });
        if (type.rows == 1) return list(type.columns, [&](std::uint64_t i) { return item(0, i); });
        return list(type.rows, [&](std::uint64_t row) {
            return list(type.columns, [&](std::uint64_t column) { return item(row, column); });
        });
    }

    [[nodiscard]] std::string sequence(const map::Type& type, Bytes bytes) const {
        const std::uint64_t one = map_.types()[type.element].size;
        const std::uint64_t count =
            std::min<std::uint64_t>(natural(bytes.subspan(type.length_at), type.length_bytes), type.columns);
        return list(count, [&](std::uint64_t i) {
            return write(type.element, bytes.subspan(type.items_at + i * one, one));
        });
    }

    [[nodiscard]] std::string field(const map::Field& each, Bytes bytes) const {
        return write(each.type, bytes.subspan(each.at, map_.types()[each.type].size));
    }

    [[nodiscard]] std::string record(const map::Type& type, Bytes bytes) const {
        std::string all = "{";
        for (std::uint32_t i = 0; i < type.field_count; ++i) {
            const map::Field& each = map_.fields()[type.first_field + i];
            if (i > 0) all += ", ";
            const std::string_view name = map_.text(each.name);
            all += is_json() ? in_quotes(name) : std::string{name};
            all += ": " + field(each, bytes);
        }
        return all + "}";
    }

    [[nodiscard]] std::string arguments(const map::Type& type, Bytes bytes) const {
        std::string all = list(type.field_count, [&](std::uint64_t i) {
            return field(map_.fields()[type.first_field + i], bytes);
        });
        if (is_json()) return all;
        all.front() = '(';
        all.back() = ')';
        return all;
    }

    const MapReader& map_;
    Style style_;
};

} // namespace

std::string duration_text(std::int64_t nanoseconds) {
    struct Unit {
        std::int64_t nanoseconds;
        const char* name;
    };
    constexpr std::array units{Unit{1'000'000'000, "s"}, Unit{1'000'000, "ms"}, Unit{1000, "us"}};
    if (nanoseconds == 0) return "0s";
    for (const Unit& unit : units)
        if (nanoseconds % unit.nanoseconds == 0)
            return std::to_string(nanoseconds / unit.nanoseconds) + unit.name;
    return std::to_string(nanoseconds) + "ns";
}

std::string moment_text(std::int64_t nanoseconds) { return rounded_time(nanoseconds, 3); }

std::string to_text(const MapReader& map, std::uint32_t type, std::span<const std::byte> bytes, Style style) {
    return Writer{map, style}.write(type, bytes);
}

std::string clock_text(std::int64_t nanoseconds) {
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "%.6fs", static_cast<double>(nanoseconds) * 1e-9);
    return text.data();
}

std::string user_name(std::string_view type) {
    constexpr std::string_view own = "tappet::";
    const auto is_part = [](char c) {
        return c == ':' || c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
               (c >= 'A' && c <= 'Z');
    };
    std::string text;
    while (!type.empty()) {
        std::size_t end = 0;
        while (end < type.size() && is_part(type[end])) ++end;
        std::string_view name = type.substr(0, end);
        if (name.starts_with(own))
            name.remove_prefix(own.size());
        else if (const std::size_t colons = name.rfind("::"); colons != std::string_view::npos)
            name.remove_prefix(colons + 2);
        text += name;
        if (end < type.size()) text += type[end++];
        type.remove_prefix(end);
    }
    return text;
}

std::string type_name(const MapReader& map, std::uint32_t index) {
    const map::Type& type = map.types()[index];
    const std::string_view name = map.text(type.name);
    const std::string bits = std::to_string(type.size * 8);
    switch (type.shape) {
    case Shape::boolean: return "bool";
    case Shape::integer: return "int" + bits;
    case Shape::natural: return "uint" + bits;
    case Shape::real: return type.size == sizeof(float) ? "float" : "double";
    case Shape::duration: return is_clock(map, type) ? "Time" : "Duration";
    case Shape::text: return "Text<" + std::to_string(type.columns) + ">";
    case Shape::matrix:
        return type_name(map, type.element) + "[" + std::to_string(type.rows) +
               (type.columns == 1 ? "]" : "x" + std::to_string(type.columns) + "]");
    case Shape::sequence:
        return "Sequence<" + type_name(map, type.element) + ", " + std::to_string(type.columns) + ">";
    case Shape::arguments: return signature(map, index);
    case Shape::record:
    case Shape::enumeration:
    case Shape::opaque: break;
    }
    return user_name(name);
}

std::string signature(const MapReader& map, std::uint32_t type) {
    if (type == map::none) return "()";
    const map::Type& list = map.types()[type];
    if (list.shape != Shape::arguments) return "(" + type_name(map, type) + ")";
    std::string all = "(";
    for (std::uint32_t i = 0; i < list.field_count; ++i) {
        if (i > 0) all += ", ";
        all += type_name(map, map.fields()[list.first_field + i].type);
    }
    return all + ")";
}

std::string in_quotes(std::string_view text) {
    std::string all = "\"";
    for (const char character : text) {
        if (character == '"' || character == '\\') {
            all += '\\';
            all += character;
        } else if (static_cast<unsigned char>(character) < 0x20) {
            std::array<char, 8> escape{};
            std::snprintf(escape.data(), escape.size(), "\\u%04x", static_cast<unsigned>(character));
            all += escape.data();
        } else {
            all += character;
        }
    }
    return all + "\"";
}

std::string as_word(std::string_view text) {
    // Brackets and quotes keep their blanks together.
    const bool one = !text.empty() && (text.front() == '[' || text.front() == '{' || text.front() == '"' ||
                                       text.find_first_of(" \t\"\\") == std::string_view::npos);
    return one ? std::string{text} : in_quotes(text);
}

std::string quoted_word(std::string_view text) {
    std::string word{"\""};
    for (const char character : text) {
        if (character == '"' || character == '\\') word += '\\';
        word += character;
    }
    return word + "\"";
}

std::string padded(std::string text, std::size_t width, bool right) {
    if (text.size() < width) text.insert(right ? 0 : text.size(), width - text.size(), ' ');
    return text;
}

} // namespace tappet::browser
