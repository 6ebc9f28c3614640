// An object dictionary read from an EDS or DCF file (CiA 306) in a constant expression; a fault in the file
// is a build error that names the file's own line.
//
//     tappet_file(<target> servo.eds)                                       in CMakeLists.txt
//     #include "<path>/servo.eds.hpp"                                      tappet::files::servo_eds, the text
//     canopen::dictionary<files::servo_eds>                                      what is in it
#pragma once

#include "drivers/canopen/cp1252.hpp"
#include "drivers/canopen/number_text.hpp"
#include "kernel/base/array_of.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/base/source_text.hpp"

#include <array>

namespace tappet::canopen {

namespace detail {

/// The meaning of a section's name.
struct SectionName {
    enum class Kind : std::uint8_t { other, object, sub_object, values, device, commissioning, list };
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
constexpr SectionName section_name(std::string_view name) noexcept {
    using Kind = SectionName::Kind;
    if (same(name, "DeviceInfo")) return {Kind::device, {}};
    if (same(name, "DeviceComissioning")) return {Kind::commissioning, {}}; // the standard's spelling
    for (const std::string_view list : {"MandatoryObjects", "OptionalObjects", "ManufacturerObjects"})
        if (same(name, list)) return {Kind::list, {}};
    if (name.size() < 4) return {};
    const auto index = hex_digits(name.substr(0, 4));
    if (!index || *index < 0x1000) return {}; // below are types
    const std::string_view rest = name.substr(4);
    if (rest.empty()) return {Kind::object, *index};
    if (same(rest, "Value")) return {Kind::values, *index};
    if (rest.size() < 4 || rest.size() > 5 || !same(rest.substr(0, 3), "sub")) return {};
    const auto sub = hex_digits(rest.substr(3));
    return sub ? SectionName{Kind::sub_object, {*index, static_cast<std::uint8_t>(*sub)}} : SectionName{};
}

/// Returns the largest number of objects that a text can contain.
constexpr std::size_t eds_room(std::string_view text) noexcept {
    std::size_t room = 1;
    IniLines lines{text};
    for (IniLine line = lines.next(); line.kind != IniLine::Kind::end; line = lines.next()) {
        if (line.kind == IniLine::Kind::section) ++room;
        if (line.kind != IniLine::Kind::entry || !same(line.name, "CompactSubObj")) continue;
        if (const auto count = to_whole(line.value); count && count->size <= 254) room += count->size + 1;
    }
    return room;
}

/// Reads the text once, and a second time for references to other sections.
template <std::size_t N> class EdsReader {
public:
    constexpr explicit EdsReader(const SourceText& source) : source_{source} {
        for (const auto step :
             {&EdsReader::read_sections, &EdsReader::order, &EdsReader::check_records,
              &EdsReader::read_references, &EdsReader::check_values, &EdsReader::find_identity})
            if (fault.empty()) (this->*step)();
    }

    Bounded<Object, N> objects{};
    Identity identity{};
    std::string_view product{};
    std::uint8_t node = 0;
    Sentence fault{};

private:
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
        compact_sub_obj,
        vendor_number,
        product_number,
        revision_number,
        product_name,
        compact_pdo,
        node_id,
        key_count,
    };
    static constexpr std::array<std::string_view, key_count> keys{
        "ParameterName", "ObjectType",     "DataType",    "AccessType", "DefaultValue",  "ParameterValue",
        "LowLimit",      "HighLimit",      "PDOMapping",  "SubNumber",  "CompactSubObj", "VendorNumber",
        "ProductNumber", "RevisionNumber", "ProductName", "CompactPDO", "NodeID"};
    struct Entry {
        std::string_view text{};
        std::uint32_t line = 0;
    };
    /// A section as it is in the file.
    struct Section {
        SectionName meant{};
        std::string_view name{};
        std::uint32_t line = 0;
        std::array<Entry, key_count> entries{};
    };
    /// An object with sub-indices.
    struct Record {
        std::uint16_t index = 0;
        std::uint32_t line = 0;
        Entry sub_number{};
        bool compact = false;
        bool plain = false; ///< a variable: it has no sub-indices
        bool operator==(const Record&) const = default;
    };

    template <class... Pieces> constexpr void refuse(std::uint32_t line, const Pieces&... pieces) {
        if (fault.empty()) fault = Sentence{source_.name, ":", line, ": ", shown(pieces)...};
    }
    /// Quotes at most 60 characters: a name or value in the file may be longer than a sentence.
    template <class Piece> static constexpr auto shown(const Piece& piece) {
        if constexpr (std::is_same_v<Piece, std::string_view>) {
            Sentence text;
            add_readable(text, piece.substr(0, 60));
            return text;
        } else if constexpr (std::is_array_v<Piece>) {
            return std::string_view{piece};
        } else {
            return piece;
        }
    }

    constexpr void read_sections() {
        Section section;
        IniLines lines{source_.text};
        for (IniLine line = lines.next(); fault.empty(); line = lines.next()) {
            switch (line.kind) {
            case IniLine::Kind::nonsense:
                return refuse(line.line, "\"", line.name,
                              "\" is neither a [section] nor an entry Key=Value; begin a comment with ;");
            case IniLine::Kind::entry: read_entry(section, line); break;
            case IniLine::Kind::section:
            case IniLine::Kind::end:
                finish(section);
                for (Entry& each : section.entries) each = {std::string_view{}, 0};
                section.meant = section_name(line.name);
                section.name = line.name;
                section.line = line.line;
                if (line.kind == IniLine::Kind::end) return;
            }
        }
    }

    constexpr void read_entry(Section& section, const IniLine& line) {
        using Kind = SectionName::Kind;
        if (section.meant.kind == Kind::other || section.meant.kind == Kind::list ||
            section.meant.kind == Kind::values)
            return;
        for (std::size_t k = 0; k < key_count; ++k) {
            if (!same(line.name, keys[k])) continue;
            if (section.entries[k].line != 0)
                return refuse(line.line, keys[k], " is there twice in [", section.name, "], first in line ",
                              section.entries[k].line, "; keep one of them");
            section.entries[k] = {line.value, line.line};
        }
    }

    /// Returns a number of an entry that is not a value of the device.
    constexpr std::uint32_t count_of(const Section& section, Key key, std::uint32_t otherwise,
                                     std::uint32_t most = ~0u) {
        const Entry& entry = section.entries[key];
        if (entry.text.empty()) return otherwise;
        const auto number = to_whole(entry.text);
        if (number && !number->negative && number->size <= most)
            return static_cast<std::uint32_t>(number->size);
        refuse(entry.line, keys[key], " is \"", entry.text, "\"; write a number up to ", std::size_t{most});
        return otherwise;
    }

    constexpr void finish(const Section& section) {
        using Kind = SectionName::Kind;
        switch (section.meant.kind) {
        case Kind::object: finish_object(section); break;
        case Kind::sub_object: add(section, section.meant.at); break;
        case Kind::commissioning: node = static_cast<std::uint8_t>(count_of(section, node_id, 0, 127)); break;
        case Kind::device:
            identity.vendor = count_of(section, vendor_number, 0);
            identity.product = count_of(section, product_number, 0);
            identity.revision = count_of(section, revision_number, 0);
            product = section.entries[product_name].text;
            device_line_ = section.line;
            if (count_of(section, compact_pdo, 0) != 0)
                refuse(
                    section.entries[compact_pdo].line,
                    "CompactPDO stands for PDO objects that are not written; let its editor write them and "
                    "set it to 0");
            break;
        default: break;
        }
    }

    constexpr void finish_object(const Section& section) {
        constexpr std::uint32_t domain = 2, variable = 7, array = 8, record = 9;
        const std::uint32_t type = count_of(section, object_type, variable);
        const std::uint16_t index = section.meant.at.index;
        const std::uint32_t compact = count_of(section, compact_sub_obj, 0, 254);
        if (type != domain && type != variable && type != array && type != record)
            return refuse(section.entries[object_type].line, "ObjectType is ",
                          section.entries[object_type].text,
                          ", which is not an object type of a device; write 0x2, 0x7, 0x8 or 0x9");
        const bool plain = type == domain || type == variable;
        static_cast<void>(
            records_.push({index, section.line, section.entries[sub_number], compact != 0, plain}));
        if (plain) return add(section, index);
        if (compact == 0) return;
        Object count;
        count.at = index;
        count.type = DataType::unsigned8;
        count.access = Access::constant;
        count.value = {compact, true, false};
        count.name = "Number of entries";
        count.line = section.line;
        static_cast<void>(objects.push(count));
        for (std::uint32_t sub = 1; sub <= compact && fault.empty(); ++sub)
            add(section, {index, static_cast<std::uint8_t>(sub)});
    }

    constexpr void add(const Section& section, Address at) {
        Object object;
        object.at = at;
        object.line = section.line;
        object.name = section.entries[parameter_name].text;
        const Entry& type = section.entries[data_type];
        if (type.line == 0) return refuse(section.line, "[", section.name, "] has no DataType; write it");
        const std::uint32_t number = count_of(section, data_type, 0);
        object.type = static_cast<DataType>(number);
        const bool is_text = number == 9 || number == 10 || number == 11 || number == 15;
        if (!is_text && (number > 0x1B || bits_of(object.type) == 0))
            return refuse(type.line, "DataType ", type.text,
                          " is not one of CiA 301; write the number of a basic type");
        read_access(section, object);
        const std::uint32_t may_map = count_of(section, pdo_mapping, 0, 1);
        object.mappable = may_map != 0;
        const Entry& wanted = section.entries[parameter_value];
        object.is_parameter = !wanted.text.empty();
        const Entry& value = object.is_parameter ? wanted : section.entries[default_value];
        object.text = value.text;
        if (!is_text) {
            object.value = number_of(section, object.is_parameter ? parameter_value : default_value, object);
            object.low = number_of(section, low_limit, object);
            object.high = number_of(section, high_limit, object);
        }
        static_cast<void>(objects.push(object));
    }

    constexpr void read_access(const Section& section, Object& object) {
        struct Name {
            std::string_view text;
            Access access;
        };
        constexpr std::array<Name, 6> names{{{"ro", Access::read_only},
                                             {"wo", Access::write_only},
                                             {"rw", Access::read_write},
                                             {"rwr", Access::read_write_read},
                                             {"rww", Access::read_write_write},
                                             {"const", Access::constant}}};
        const Entry& entry = section.entries[access_type];
        if (entry.line == 0) return refuse(section.line, "[", section.name, "] has no AccessType; write it");
        for (const Name& each : names)
            if (same(entry.text, each.text)) {
                object.access = each.access;
                return;
            }
        refuse(entry.line, "AccessType is \"", entry.text, "\"; write ro, wo, rw, rwr, rww or const");
    }

    constexpr Number number_of(const Section& section, Key key, const Object& object) {
        return number_of(section.entries[key], keys[key], object);
    }
    constexpr Number number_of(const Entry& entry, std::string_view key, const Object& object) {
        const NumberRead read = to_number(entry.text, object.type);
        if (read.fault == NumberFault::no_number)
            refuse(entry.line, key, " \"", entry.text.substr(0, 40),
                   is_real(object.type) ? "\" is not a number of up to 15 digits; write one"
                                        : "\" is not a number; write 0x1F, 31 or $NODEID+0x1F");
        if (read.fault == NumberFault::does_not_fit)
            refuse(entry.line, key, " ", entry.text, " does not fit the ", bits_of(object.type), " bits of ",
                   to_text(object.at), is_signed(object.type) ? ", which has a sign" : "",
                   "; correct it or its DataType");
        return read.number;
    }

    constexpr void order() {
        std::ranges::sort(objects.begin(), objects.end(), [](const Object& a, const Object& b) {
            return a.at != b.at ? a.at < b.at : a.line < b.line;
        });
        for (std::size_t i = 1; i < objects.size(); ++i)
            if (objects[i].at == objects[i - 1].at)
                return refuse(objects[i].line, "object ", to_text(objects[i].at),
                              " is there twice, first in line ", objects[i - 1].line, "; keep one of them");
        if (objects.empty()) refuse(1, "it has no object; is it an EDS or DCF file of CiA 306?");
    }

    constexpr void check_records() {
        for (const Object& object : objects) {
            const Record* const record = record_of(object.at.index);
            if (record == nullptr)
                return refuse(object.line, "object ", to_text(object.at), " is a part of ",
                              hex(object.at.index, 4), ", which has no section; write it");
            if (record->plain && object.at.sub != 0)
                return refuse(object.line, "object ", to_text(object.at), " is a part of ",
                              hex(object.at.index, 4),
                              ", which is a variable; make it ObjectType 0x8 or 0x9");
        }
        for (const Record& record : records_) {
            if (record.plain || record.compact) continue;
            std::size_t subs = 0;
            for (const Object& object : objects) subs += object.at.index == record.index ? 1u : 0u;
            const auto said = to_whole(record.sub_number.text);
            if (!said || said->size != subs)
                return refuse(record.sub_number.line != 0 ? record.sub_number.line : record.line,
                              "SubNumber of ", hex(record.index, 4), " is ",
                              record.sub_number.text.empty() ? "not written" : record.sub_number.text,
                              " and ", subs, subs == 1 ? " sub-index is" : " sub-indices are",
                              " there; correct it, or what is missing");
        }
    }
    constexpr const Record* record_of(std::uint16_t index) const {
        for (const Record& record : records_)
            if (record.index == index) return &record;
        return nullptr;
    }

    /// Checks references: lists name objects, and values of a compact array name its sub-indices.
    constexpr void read_references() {
        SectionName in{};
        IniLines lines{source_.text};
        for (IniLine line = lines.next(); line.kind != IniLine::Kind::end && fault.empty();
             line = lines.next()) {
            if (line.kind == IniLine::Kind::section) {
                in = section_name(line.name);
                continue;
            }
            const auto place = to_whole(line.name);
            if (!place || place->size == 0 || place->size > 0xFFFF) continue; // the number of entries
            if (in.kind == SectionName::Kind::list) {
                const auto index = to_whole(line.value);
                if (!index ||
                    (index->size >= 0x1000 && record_of(static_cast<std::uint16_t>(index->size)) == nullptr))
                    refuse(line.line, "the list names object ", line.value.substr(0, 20),
                           ", which has no section; write it or take it off the list");
            }
            if (in.kind == SectionName::Kind::values) {
                Object* const object = find({in.at.index, static_cast<std::uint8_t>(place->size)});
                if (place->size > 254 || object == nullptr)
                    return refuse(line.line, "it is a value of ", hex(in.at.index, 4), ":", line.name,
                                  ", which is not there; correct CompactSubObj");
                object->value = number_of({line.value, line.line}, "Value", *object);
                object->is_parameter = true;
                object->line = line.line;
            }
        }
    }
    constexpr Object* find(Address at) {
        for (Object& object : objects)
            if (object.at == at) return &object;
        return nullptr;
    }

    constexpr void check_values() {
        for (const Object& object : objects) {
            if (object.low.given && object.high.given && !is_real(object.type)) {
                Object bounded = object;
                bounded.high = {};
                if (!within_limits(bounded, object.high.of(1), 1))
                    return refuse(object.line, "LowLimit of ", to_text(object.at),
                                  " is above its HighLimit; exchange them");
            }
            if (object.value.given && !within_limits(object, object.value.of(1), 1))
                return refuse(object.line, "the value ", object.text.substr(0, 20), " of ",
                              to_text(object.at),
                              " is outside of its own limits; correct it, LowLimit or HighLimit");
        }
    }

    constexpr void find_identity() {
        const Object* const type = find(0x1000);
        if (type == nullptr)
            return refuse(1, "object 1000h (device type) is missing, which each device has; write it");
        identity.device_type = static_cast<std::uint32_t>(type->value.bits);
        struct Part {
            std::uint8_t sub;
            std::uint32_t* number;
            std::string_view key;
        };
        for (const Part& part :
             {Part{1, &identity.vendor, "VendorNumber"}, Part{2, &identity.product, "ProductNumber"},
              Part{3, &identity.revision, "RevisionNumber"}}) {
            const Object* const object = find({0x1018, part.sub});
            if (object == nullptr || !object->value.given || object->value.bits == 0) continue;
            const auto said = static_cast<std::uint32_t>(object->value.bits);
            if (*part.number != 0 && *part.number != said)
                return refuse(object->line, to_text(object->at), " is ", hex(said, 8), ", but ", part.key,
                              " in line ", device_line_, " and below is ", hex(*part.number, 8),
                              "; correct one of them");
            *part.number = said;
        }
    }

    SourceText source_;
    Bounded<Record, N> records_{};
    std::uint32_t device_line_ = 0;
};

template <const auto& Source> inline constexpr EdsReader<eds_room(Source.text)> eds_read{Source};

/// Copies the objects to an array of exact size, as part of the program that uses it.
template <const auto& Source> struct CheckedDictionary {
    TAPPET_ACCEPTED(eds_read<Source>.fault);
    static constexpr auto objects =
        array_of<eds_read<Source>.objects.used>([](std::size_t i) { return eds_read<Source>.objects[i]; });
    static constexpr Dictionary dictionary{Source.name, eds_read<Source>.product, eds_read<Source>.node,
                                           eds_read<Source>.identity, objects};
};

} // namespace detail

/// The dictionary of a constant SourceText at namespace scope.
template <const auto& Source>
inline constexpr const Dictionary& dictionary = detail::CheckedDictionary<Source>::dictionary;

} // namespace tappet::canopen
