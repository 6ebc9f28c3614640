// Reads an EDS or DCF file (CiA 306), at compile time or at run time, into objects and notes on its faults.
#pragma once

#include "drivers/canopen/number_text.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/base/source_text.hpp"

#include <algorithm>
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

/// Reads the text once, and a second time for references to other sections. Holds N objects and M notes.
template <std::size_t N, std::size_t M = 64> class EdsReader {
public:
    constexpr explicit EdsReader(const SourceText& source) : source_{source} {
        for (const auto step :
             {&EdsReader::read_sections, &EdsReader::order, &EdsReader::check_records,
              &EdsReader::read_references, &EdsReader::check_values, &EdsReader::find_identity})
            if (fault.empty()) (this->*step)();
    }

    Bounded<Object, N> objects{};
    Bounded<FileNote, M> notes{};
    Identity identity{};
    std::string_view product{};
    std::uint8_t node = 0;
    std::uint8_t doubted = 0; ///< as in Dictionary
    Sentence fault{};         ///< the file describes no device

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
    /// The flaws of an object by its wrong entry.
    static constexpr std::array<std::uint8_t, key_count> flaws_of{
        0, flaw::type, flaw::type, flaw::access, 0, flaw::value, flaw::limits, flaw::limits, flaw::mapping};
    struct Entry {
        std::string_view text{};
        std::uint32_t line = 0;
    };
    /// A section as it is in the file.
    struct Section {
        SectionName meant{};
        std::string_view name{};
        std::uint32_t line = 0;
        std::uint8_t flaws = 0;
        bool is_read_only = false, has_wrong_limits = false;
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

    using Kind = FileNote::Kind;
    template <class... Pieces> constexpr void refuse(std::uint32_t line, const Pieces&... pieces) {
        if (fault.empty()) fault = Sentence{source_.name, ":", line, ": ", pieces...};
    }
    constexpr void note(const FileNote& each) { static_cast<void>(notes.push(each)); }
    constexpr void note(Section& section, Kind kind, Key key) {
        const Entry& entry = section.entries[key];
        std::uint8_t flaws = flaws_of[key];
        if (flaws == flaw::limits) section.has_wrong_limits = true;
        if (flaws == flaw::limits && section.is_read_only) flaws = 0; // nobody asks for them
        section.flaws |= flaws;
        note({kind, flaws, section.meant.at, entry.line != 0 ? entry.line : section.line, 0, keys[key],
              entry.line != 0 ? entry.text : section.name});
    }

    constexpr void read_sections() {
        Section section;
        IniLines lines{source_.text};
        for (IniLine line = lines.next();; line = lines.next()) {
            switch (line.kind) {
            case IniLine::Kind::nonsense: note({Kind::no_line, 0, {}, line.line, 0, {}, line.name}); break;
            case IniLine::Kind::entry: read_entry(section, line); break;
            case IniLine::Kind::section:
            case IniLine::Kind::end:
                finish(section);
                for (Entry& each : section.entries) each = {std::string_view{}, 0};
                section.meant = section_name(line.name);
                section.name = line.name;
                section.line = line.line;
                section.flaws = 0;
                if (line.kind == IniLine::Kind::end) return;
            }
        }
    }

    constexpr void read_entry(Section& section, const IniLine& line) {
        using Name = SectionName::Kind;
        if (section.meant.kind == Name::other || section.meant.kind == Name::list ||
            section.meant.kind == Name::values)
            return;
        for (std::size_t k = 0; k < key_count; ++k) {
            if (!same(line.name, keys[k])) continue;
            Entry& entry = section.entries[k];
            if (entry.line == 0) {
                entry = {line.value, line.line};
                continue;
            }
            const std::uint8_t flaws = entry.text == line.value ? std::uint8_t{0} : flaws_of[k];
            section.flaws |= flaws;
            note({Kind::entry_twice, flaws, section.meant.at, line.line, entry.line, keys[k], section.name});
        }
    }

    /// Returns a number of an entry that is not a value of the device.
    constexpr std::uint32_t count_of(Section& section, Key key, std::uint32_t otherwise,
                                     std::uint32_t most = ~0u) {
        const Entry& entry = section.entries[key];
        if (entry.text.empty()) return otherwise;
        const auto number = to_whole(entry.text);
        if (number && !number->negative && number->size <= most)
            return static_cast<std::uint32_t>(number->size);
        note(section, Kind::not_a_choice, key);
        return otherwise;
    }

    constexpr void finish(Section& section) {
        using Name = SectionName::Kind;
        switch (section.meant.kind) {
        case Name::object: finish_object(section); break;
        case Name::sub_object: add(section); break;
        case Name::commissioning: node = static_cast<std::uint8_t>(count_of(section, node_id, 0, 127)); break;
        case Name::device:
            identity.vendor = count_of(section, vendor_number, 0);
            identity.product = count_of(section, product_number, 0);
            identity.revision = count_of(section, revision_number, 0);
            product = section.entries[product_name].text;
            device_line_ = section.line;
            device_numbers_ = {section.entries[vendor_number].text, section.entries[product_number].text,
                               section.entries[revision_number].text};
            if (count_of(section, compact_pdo, 0) != 0) note(section, Kind::compact_pdo, compact_pdo);
            break;
        default: break;
        }
    }

    constexpr void finish_object(Section& section) {
        constexpr std::uint32_t domain = 2, variable = 7, array = 8, record = 9;
        const std::uint32_t type = count_of(section, object_type, variable);
        const std::uint16_t index = section.meant.at.index;
        const std::uint32_t compact = count_of(section, compact_sub_obj, 0, 254);
        if (type != domain && type != variable && type != array && type != record)
            return note(section, Kind::not_a_choice, object_type);
        const bool plain = type == domain || type == variable;
        static_cast<void>(
            records_.push({index, section.line, section.entries[sub_number], compact != 0, plain}));
        if (plain) return add(section);
        if (compact == 0) return;
        Object count;
        count.at = index;
        count.type = DataType::unsigned8;
        count.access = Access::constant;
        count.value = {compact, true, false};
        count.name = "Number of entries";
        count.line = section.line;
        static_cast<void>(objects.push(count));
        section.meant.at.sub = 1;
        add(section);
        for (std::uint32_t sub = 2; sub <= compact && !objects.full(); ++sub) {
            Object next = objects[objects.size() - 1];
            next.at.sub = static_cast<std::uint8_t>(sub);
            static_cast<void>(objects.push(next));
        }
    }

    constexpr void add(Section& section) {
        Object object;
        object.at = section.meant.at;
        object.line = section.line;
        object.name = section.entries[parameter_name].text;
        const Entry& type = section.entries[data_type];
        if (type.line == 0) note(section, Kind::no_entry, data_type);
        const std::uint32_t number = count_of(section, data_type, 0);
        constexpr std::array<std::uint32_t, 4> texts{9, 10, 11, 15};
        const bool is_text = std::ranges::find(texts, number) != texts.end();
        const bool is_known = is_text || (number <= 0x1B && bits_of(static_cast<DataType>(number)) != 0);
        object.type = static_cast<DataType>(is_known ? number : 0);
        if (!is_known && type.line != 0 && (section.flaws & flaw::type) == 0)
            note(section, Kind::not_a_choice, data_type);
        read_access(section, object);
        object.mappable = count_of(section, pdo_mapping, 0, 1) != 0;
        const Key value = section.entries[parameter_value].text.empty() ? default_value : parameter_value;
        object.is_parameter = value == parameter_value;
        object.text = section.entries[value].text;
        if (bits_of(object.type) != 0) {
            const NumberRead read = to_number(object.text, object.type);
            object.value = read.number;
            if (read.fault != NumberFault::none) note(section, kind_of(read.fault), value);
            read_limits(section, object);
        } else if (!is_known && object.is_parameter) {
            section.flaws |= flaw::value; // unknown like its type
        }
        object.flaws = section.flaws;
        static_cast<void>(objects.push(object));
    }

    static constexpr Kind kind_of(NumberFault fault) {
        return fault == NumberFault::no_number ? Kind::not_a_number : Kind::does_not_fit;
    }

    constexpr void read_access(Section& section, Object& object) {
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
        if (entry.line == 0) return note(section, Kind::no_entry, access_type);
        for (const Name& each : names)
            if (same(entry.text, each.text)) {
                object.access = each.access;
                section.is_read_only = each.access == Access::read_only || each.access == Access::constant;
                return;
            }
        note(section, Kind::not_a_choice, access_type);
    }

    /// Reads the limits. One beyond the type bounds nothing; contradictory ones are dropped, as a flaw.
    constexpr void read_limits(Section& section, Object& object) {
        const std::string_view low = section.entries[low_limit].text, high = section.entries[high_limit].text;
        for (const Key key : {low_limit, high_limit}) {
            const std::string_view text = section.entries[key].text;
            const NumberRead read = to_number(text, object.type);
            (key == low_limit ? object.low : object.high) = read.number;
            if (read.fault == NumberFault::none) continue;
            const bool is_beyond =
                read.fault == NumberFault::does_not_fit && text.starts_with('-') == (key == low_limit);
            if (is_beyond)
                note({Kind::bounds_nothing, 0, object.at, section.entries[key].line, 0, keys[key], text});
            else
                note(section, kind_of(read.fault), key);
        }
        if (is_real(object.type) || !object.high.given) return;
        Object bounded = object;
        bounded.high = {};
        // 0xFF of eight bits with a sign: -1, or 255?
        const bool is_pattern = is_signed(object.type) && !high.starts_with('-') &&
                                object.high.bits >> (bits_of(object.type) - 1) != 0;
        if (!within_limits(bounded, object.high.of(1), 1))
            note(section, Kind::limits_contradict, high_limit);
        else if (is_pattern && (low.empty() || low.starts_with('-')))
            note(section, Kind::ambiguous_limit, high_limit);
        if (section.has_wrong_limits) object.low = object.high = {};
    }

    constexpr void order() {
        std::ranges::sort(objects.begin(), objects.end(), [](const Object& a, const Object& b) {
            return a.at != b.at ? a.at < b.at : a.line < b.line;
        });
        std::size_t kept = 0;
        for (std::size_t i = 0; i < objects.size(); ++i) {
            if (kept == 0 || objects[i].at != objects[kept - 1].at) {
                if (kept != i) objects[kept] = objects[i];
                ++kept;
                continue;
            }
            constexpr std::uint8_t all =
                flaw::type | flaw::access | flaw::mapping | flaw::value | flaw::limits;
            objects[kept - 1].flaws = all;
            note({Kind::object_twice, all, objects[i].at, objects[i].line, objects[kept - 1].line, {}, {}});
        }
        objects.used = kept;
        std::ranges::sort(records_.begin(), records_.end(), [](const Record& a, const Record& b) {
            return a.index != b.index ? a.index < b.index : a.line < b.line;
        });
        if (objects.empty()) refuse(1, "it has no object; is it an EDS or DCF file of CiA 306?");
    }

    constexpr void check_records() {
        for (const Object& object : objects) {
            const Record* const record = record_of(object.at.index);
            if (record == nullptr)
                note({Kind::no_section, 0, object.at, object.line, 0, {}, {}});
            else if (record->plain && object.at.sub != 0)
                note({Kind::part_of_variable, 0, object.at, object.line, 0, {}, {}});
        }
        for (const Record& record : records_) {
            if (record.plain || record.compact) continue;
            const auto all = std::ranges::equal_range(objects, record.index, {},
                                                      [](const Object& each) { return each.at.index; });
            const auto subs = static_cast<std::uint32_t>(all.size());
            const auto said = to_whole(record.sub_number.text);
            if (said && said->size == subs) continue;
            const std::uint32_t line = record.sub_number.line;
            note({Kind::sub_number, 0, record.index, line != 0 ? line : record.line, subs, keys[sub_number],
                  record.sub_number.text});
        }
    }
    constexpr const Record* record_of(std::uint16_t index) const {
        const Record* const found =
            std::ranges::lower_bound(records_.begin(), records_.end(), index, {}, &Record::index);
        return found != records_.end() && found->index == index ? found : nullptr;
    }

    /// Checks references: lists name objects, and values of a compact array name its sub-indices.
    constexpr void read_references() {
        SectionName in{};
        IniLines lines{source_.text};
        for (IniLine line = lines.next(); line.kind != IniLine::Kind::end; line = lines.next()) {
            if (line.kind == IniLine::Kind::section) {
                in = section_name(line.name);
                continue;
            }
            const auto place = to_whole(line.name);
            if (!place || place->size == 0 || place->size > 0xFFFF) continue; // the number of entries
            if (in.kind == SectionName::Kind::list) {
                const auto index = to_whole(line.value);
                if (!index || index->size > 0xFFFF ||
                    (index->size >= 0x1000 && record_of(static_cast<std::uint16_t>(index->size)) == nullptr))
                    note({Kind::not_in_file, 0, {}, line.line, 0, {}, line.value});
            }
            if (in.kind == SectionName::Kind::values) read_value(in.at.index, place->size, line);
        }
    }
    constexpr void read_value(std::uint16_t index, std::uint64_t sub, const IniLine& line) {
        Object* const object = sub > 254 ? nullptr : find({index, static_cast<std::uint8_t>(sub)});
        if (object == nullptr) return note({Kind::no_such_element, 0, index, line.line, 0, {}, line.name});
        const NumberRead read = to_number(line.value, object->type);
        object->value = read.number;
        object->text = line.value;
        object->is_parameter = true;
        object->line = line.line;
        if (read.fault == NumberFault::none) return;
        object->flaws |= flaw::value;
        note({kind_of(read.fault), flaw::value, object->at, line.line, 0, "Value", line.value});
    }
    constexpr Object* find(Address at) {
        Object* const found = std::ranges::lower_bound(objects.begin(), objects.end(), at, {}, &Object::at);
        return found != objects.end() && found->at == at ? found : nullptr;
    }

    constexpr void check_values() {
        for (Object& object : objects) {
            if (!object.value.given || within_limits(object, object.value.of(1), 1)) continue;
            const std::uint8_t flaws = object.is_parameter ? flaw::value : std::uint8_t{0};
            object.flaws |= flaws;
            note({Kind::outside_of_limits, flaws, object.at, object.line, 0, {}, object.text});
        }
    }

    constexpr void find_identity() {
        if (const Object* const type = find(0x1000))
            identity.device_type = static_cast<std::uint32_t>(type->value.bits);
        else
            note({Kind::no_device_type, 0, 0x1000, 1, 0, {}, {}});
        for (std::uint8_t sub = 1; sub <= 3; ++sub) {
            const Object* const object = find({0x1018, sub});
            if (object == nullptr || !object->value.given || object->value.bits == 0) continue;
            std::uint32_t& number = sub == 1   ? identity.vendor
                                    : sub == 2 ? identity.product
                                               : identity.revision;
            const auto said = static_cast<std::uint32_t>(object->value.bits);
            if (number != 0 && number != said) {
                doubted |= static_cast<std::uint8_t>(1u << sub);
                note({Kind::identity_twice, 0, object->at, object->line, device_line_,
                      device_numbers_[sub - 1u], object->text});
            }
            number = said;
        }
    }

    SourceText source_;
    Bounded<Record, N> records_{};
    std::uint32_t device_line_ = 0;
    std::array<std::string_view, 3> device_numbers_{};
};

} // namespace detail

} // namespace tappet::canopen
