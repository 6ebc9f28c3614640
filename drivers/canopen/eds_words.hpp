// The words of an EDS or DCF file (CiA 306): names of sections, keys, and signs that one of them is damaged.
#pragma once

#include "drivers/canopen/number_text.hpp"

#include <array>
#include <initializer_list>

namespace tappet::canopen::detail {

/// The meaning of a section's name.
struct SectionName {
    enum class Kind : std::uint8_t {
        other,     ///< without an object, such as FileInfo, or of a maker
        damaged,   ///< it begins or ends as an object does, and is none
        described, ///< of a type or of a module, in the words of an object; not read
        object,
        sub_object,
        values,
        device,
        commissioning,
        list,
    };
    Kind kind = Kind::other;
    Address at{};
};
constexpr std::optional<std::uint16_t> hex_digits(std::string_view text) noexcept {
    std::uint16_t number = 0;
    for (const char each : text) {
        const char c = lower(each);
        const bool digit = c >= '0' && c <= '9';
        if (!digit && !(c >= 'a' && c <= 'f')) return {};
        number = static_cast<std::uint16_t>(number * 16 + (digit ? c - '0' : c - 'a' + 10));
    }
    return text.empty() ? std::nullopt : std::optional{number};
}
constexpr bool is_decimal(char c) noexcept { return c >= '0' && c <= '9'; }
/// M1ModuleInfo, M12SubExt6000 and so on (CiA 306-2).
constexpr bool is_of_module(std::string_view name) noexcept {
    std::size_t digits = 0;
    while (digits + 1 < name.size() && is_decimal(name[digits + 1])) ++digits;
    if (digits == 0 || lower(name[0]) != 'm') return false;
    const std::string_view rest = name.substr(digits + 1);
    for (const std::string_view begin : {"ModuleInfo", "Comments", "Fixed", "SubExt"})
        if (same(rest.substr(0, begin.size()), begin)) return true;
    return false;
}
constexpr SectionName section_name(std::string_view name) noexcept {
    using Kind = SectionName::Kind;
    if (same(name, "DeviceInfo")) return {Kind::device, {}};
    for (const std::string_view spelling :
         {"DeviceComissioning", "DeviceCommissioning"}) // the standard's, English
        if (same(name, spelling)) return {Kind::commissioning, {}};
    for (const std::string_view list : {"MandatoryObjects", "OptionalObjects", "ManufacturerObjects"})
        if (same(name, list)) return {Kind::list, {}};
    if (is_of_module(name)) return {Kind::described, {}};
    const bool is_object = name.empty() || is_decimal(name[0]) ||
                           (name.size() > 2 && lower(name[0]) == 'm' && is_decimal(name[1])) ||
                           (name.size() > 4 && same(name.substr(name.size() - 5), "Value"));
    const SectionName none{is_object ? Kind::damaged : Kind::other, {}};
    const auto index = name.size() < 4 ? std::nullopt : hex_digits(name.substr(0, 4));
    if (!index) return none;
    const std::string_view rest = name.substr(4);
    for (const std::string_view texts : {"Name", "Denotation", "ObjectLinks"})
        if (same(rest, texts)) return {};
    const bool is_type = *index < 0x1000;
    if (rest.empty()) return {is_type ? Kind::described : Kind::object, *index};
    if (same(rest, "Value")) return {Kind::values, *index};
    if (rest.size() < 4 || rest.size() > 5 || !same(rest.substr(0, 3), "sub")) return none;
    const auto sub = hex_digits(rest.substr(3));
    if (!sub) return none;
    return {is_type ? Kind::described : Kind::sub_object, {*index, static_cast<std::uint8_t>(*sub)}};
}

enum Key : std::uint8_t {
    parameter_name,
    object_type,
    data_type,
    access_type,
    default_value,
    parameter_value,
    low_limit,
    high_limit,
    pdo_mapping,
    sub_number,
    compact_sub_obj, ///< the last of an object
    vendor_number,
    product_number,
    revision_number,
    compact_pdo,
    number_of_rpdos,
    number_of_tpdos,
    node_id,
    product_name, ///< a text, in other sections, too
    key_count,
};
inline constexpr std::array<std::string_view, key_count> keys{
    "ParameterName",  "ObjectType",   "DataType",      "AccessType",     "DefaultValue",
    "ParameterValue", "LowLimit",     "HighLimit",     "PDOMapping",     "SubNumber",
    "CompactSubObj",  "VendorNumber", "ProductNumber", "RevisionNumber", "CompactPDO",
    "NrOfRXPDO",      "NrOfTXPDO",    "NodeID",        "ProductName"};

/// Returns whether a section of this kind has the key.
constexpr bool has_key(SectionName::Kind section, Key key) noexcept {
    using Kind = SectionName::Kind;
    if (key == product_name) return true;
    switch (section) {
    case Kind::damaged: return true; // it is told itself
    case Kind::described:
    case Kind::object:
    case Kind::sub_object: return key <= compact_sub_obj;
    case Kind::device: return key > compact_sub_obj && key < node_id;
    case Kind::commissioning: return key == node_id;
    case Kind::other:
    case Kind::list:
    case Kind::values: return false;
    }
    return false;
}

/// Returns the key of this text; key_count: none.
constexpr Key key_of(std::string_view text) noexcept {
    for (std::size_t k = 0; k < key_count; ++k)
        if (same(text, keys[k])) return static_cast<Key>(k);
    return key_count;
}
/// Returns the key from which the text differs in one place of at most two characters (one of NodeID), and is
/// thus most likely a damaged one; key_count: none.
constexpr Key damaged_key(std::string_view text) noexcept {
    for (std::size_t k = 0; k < key_count; ++k) {
        const std::string_view key = keys[k];
        const std::size_t most = std::max(key.size(), text.size()), least = std::min(key.size(), text.size());
        const std::size_t place = key.size() < 8 ? 1 : 2;
        if (most - least > place) continue;
        std::size_t equal = 0;
        while (equal < least && lower(key[equal]) == lower(text[equal])) ++equal;
        for (std::size_t end = 1; equal < least && end <= least - equal; ++end) {
            if (lower(key[key.size() - end]) != lower(text[text.size() - end])) break;
            if (end == least - equal || equal + end + place >= most) return static_cast<Key>(k);
        }
        if (equal + place >= most) return static_cast<Key>(k);
    }
    return key_count;
}
/// Returns whether a value goes on with another entry or section: the end of its line is lost.
constexpr bool is_joined(std::string_view value) noexcept {
    for (std::size_t sign = value.find('='); sign != std::string_view::npos; sign = value.find('=', sign + 1))
        for (const std::string_view key : keys)
            if (sign >= key.size() && same(value.substr(sign - key.size(), key.size()), key)) return true;
    if (value.empty() || value.back() != ']') return false;
    const std::size_t begin = value.rfind('[');
    return begin != std::string_view::npos &&
           section_name(value.substr(begin + 1, value.size() - begin - 2)).kind == SectionName::Kind::values;
}

} // namespace tappet::canopen::detail
