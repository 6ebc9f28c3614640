// Reads an EDS or DCF file (CiA 306) on the host, into objects and notes on its faults.
#pragma once

#include "drivers/canopen/eds_notes.hpp"
#include "drivers/canopen/eds_words.hpp"
#include "kernel/base/source_text.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace tappet::canopen {

namespace detail {

/// Reads the text once, and a second time for references to other sections.
/// Refuses the file as a whole for all that it cannot read: a line, a section's name, a word or a number, and
/// for each doubt about an object that a value belongs to. These alone are notes, or flaws of their object:
/// limits that do not fit, a SubNumber or a list that is wrong, a type of the file's own (DEFSTRUCT), a
/// number too large for an object that is no part of the identity or of a PDO, a value outside of its limits,
/// CompactPDO beside PDO objects, and an identity said twice. An empty entry is one that is not there.
class EdsReader {
public:
    explicit EdsReader(const SourceText& source) : source_{source} {
        for (const auto step :
             {&EdsReader::read_sections, &EdsReader::order, &EdsReader::check_records,
              &EdsReader::read_references, &EdsReader::check_values, &EdsReader::find_identity})
            if (fault.empty()) (this->*step)();
    }

    std::vector<Object> objects{};
    std::vector<FileNote> notes{};
    Identity identity{};
    std::string_view product{};
    std::uint8_t node = 0;
    std::uint8_t doubted = 0; ///< as in Dictionary
    Sentence fault{};         ///< the file describes no device

    /// Refers to the reader.
    [[nodiscard]] Dictionary dictionary() const {
        return {source_.name, product, node, identity, doubted, objects, notes};
    }

private:
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
    };

    using Kind = FileNote::Kind;
    /// Refuses the file.
    void refuse(FileNote each) {
        each.flaws = flaw::file;
        if (fault.empty())
            fault = Sentence(source_.name, ":", each.line, ": ", meaning(each),
                             "; the file is not read: correct this line, or take an undamaged file");
        notes.push_back(each);
    }
    void refuse(const Section& section, Kind kind, Key key) {
        const Entry& entry = section.entries[key];
        refuse({kind, 0, section.meant.at, entry.line != 0 ? entry.line : section.line, 0, keys[key],
                entry.line != 0 ? entry.text : section.name});
    }
    void note(const FileNote& each) { notes.push_back(each); }
    void note(Section& section, Kind kind, Key key, std::uint8_t flaws) {
        const Entry& entry = section.entries[key];
        section.flaws |= flaws;
        note({kind, flaws, section.meant.at, entry.line, 0, keys[key], entry.text});
    }
    /// Nobody asks for the limits of an object that is only read.
    void note_limit(Section& section, Kind kind, Key key) {
        section.has_wrong_limits = true;
        note(section, kind, key, section.is_read_only ? std::uint8_t{0} : flaw::limits);
    }

    void read_sections() {
        Section section;
        IniLines lines{source_.text};
        for (IniLine line = lines.next();; line = lines.next()) {
            switch (line.kind) {
            case IniLine::Kind::nonsense:
                refuse({Kind::no_line, 0, {}, line.line, 0, {}, line.name});
                // It may have been a section: nothing belongs to the one before it.
                if (line.name.front() == '[') section.meant.kind = SectionName::Kind::damaged;
                break;
            case IniLine::Kind::entry: read_entry(section, line); break;
            case IniLine::Kind::section:
            case IniLine::Kind::end:
                finish(section);
                for (Entry& each : section.entries) each = {std::string_view{}, 0};
                section.meant = section_name(line.name);
                section.name = line.name;
                section.line = line.line;
                section.flaws = 0;
                section.is_read_only = section.has_wrong_limits = false;
                if (line.kind == IniLine::Kind::end) return;
                if (section.meant.kind == SectionName::Kind::damaged)
                    refuse({Kind::no_such_section, 0, {}, line.line, 0, {}, line.name});
            }
        }
    }

    void read_entry(Section& section, const IniLine& line) {
        using Name = SectionName::Kind;
        const Name in = section.meant.kind;
        if (in == Name::damaged) return;
        if (is_joined(line.value)) return refuse({Kind::joined, 0, {}, line.line, 0, line.name, line.value});
        const Key key = key_of(line.name);
        if (key == key_count) {
            Key meant = damaged_key(line.name);
            const std::size_t sign = line.value.rfind('=');
            if (meant == key_count && sign != std::string_view::npos) { // V=endorNumber=5
                const char* const end = line.value.data() + sign;
                meant = damaged_key({line.name.data(), static_cast<std::size_t>(end - line.name.data())});
            }
            const bool is_numbered =
                in != Name::other && in != Name::list && in != Name::values && is_decimal(line.name.front());
            if (meant != key_count)
                refuse({Kind::damaged_key, 0, {}, line.line, 0, keys[meant], line.name});
            else if (is_numbered)
                refuse({Kind::other_section, 0, {}, line.line, 0, line.name, section.name});
            return;
        }
        // A type has no value: its name is that of another object.
        const bool is_value_of_type = in == Name::described && key == parameter_value && !line.value.empty();
        if (!has_key(in, key) || is_value_of_type)
            return refuse({Kind::other_section, 0, {}, line.line, 0, keys[key], section.name});
        Entry& entry = section.entries[key];
        if (entry.line != 0 && key != product_name)
            return refuse({Kind::entry_twice, 0, {}, line.line, entry.line, keys[key], section.name});
        entry = {line.value, line.line};
    }

    /// Returns a number of an entry that is not a value of the device.
    std::uint32_t count_of(const Section& section, Key key, std::uint32_t otherwise,
                           std::uint32_t most = ~0u) {
        const Entry& entry = section.entries[key];
        if (entry.text.empty()) return otherwise;
        const auto number = to_whole(entry.text);
        if (number && !number->negative && number->size <= most)
            return static_cast<std::uint32_t>(number->size);
        refuse(section, Kind::not_a_choice, key);
        return otherwise;
    }

    void finish(Section& section) {
        using Name = SectionName::Kind;
        switch (section.meant.kind) {
        case Name::object: finish_object(section); break;
        case Name::sub_object: add(section); break;
        case Name::commissioning:
            is_only(section, commissioning_line_);
            node = static_cast<std::uint8_t>(count_of(section, node_id, 0, 127));
            if (section.entries[node_id].text.empty()) refuse(section, Kind::no_entry, node_id);
            break;
        case Name::device:
            is_only(section, device_line_);
            identity.vendor = count_of(section, vendor_number, 0);
            identity.product = count_of(section, product_number, 0);
            identity.revision = count_of(section, revision_number, 0);
            product = section.entries[product_name].text;
            device_numbers_ = {section.entries[vendor_number].text, section.entries[product_number].text,
                               section.entries[revision_number].text};
            if (count_of(section, compact_pdo, 0) != 0) compact_pdo_ = section.entries[compact_pdo];
            pdos_ = {count_of(section, number_of_rpdos, 0), count_of(section, number_of_tpdos, 0)};
            break;
        default: break;
        }
    }
    void is_only(const Section& section, std::uint32_t& first) {
        if (first != 0) refuse({Kind::section_twice, 0, {}, section.line, first, {}, section.name});
        first = section.line;
    }

    void finish_object(Section& section) {
        constexpr std::uint32_t domain = 2, variable = 7, array = 8, record = 9;
        const std::uint32_t type = count_of(section, object_type, variable);
        const std::uint16_t index = section.meant.at.index;
        const std::uint32_t compact = count_of(section, compact_sub_obj, 0, 254);
        if (type != domain && type != variable && type != array && type != record)
            return refuse(section, Kind::not_a_choice, object_type);
        const bool plain = type == domain || type == variable;
        records_.push_back({index, section.line, section.entries[sub_number], compact != 0, plain});
        if (plain) return add(section);
        if (compact == 0) {
            if (!section.entries[parameter_value].text.empty())
                refuse(section, Kind::value_of_record, parameter_value);
            return;
        }
        Object count;
        count.at = index;
        count.type = DataType::unsigned8;
        count.access = Access::constant;
        count.value = {compact, true, false};
        count.name = "Number of entries";
        count.line = section.line;
        objects.push_back(count);
        section.meant.at.sub = 1;
        add(section);
        for (std::uint32_t sub = 2; sub <= compact; ++sub) {
            Object next = objects.back();
            next.at.sub = static_cast<std::uint8_t>(sub);
            objects.push_back(next);
        }
    }

    void add(Section& section) {
        Object object;
        object.at = section.meant.at;
        object.line = section.line;
        object.name = section.entries[parameter_name].text;
        const Entry& type = section.entries[data_type];
        if (type.line == 0) refuse(section, Kind::no_entry, data_type);
        const std::uint32_t number = count_of(section, data_type, 0);
        constexpr std::array<std::uint32_t, 4> texts{9, 10, 11, 15};
        const bool is_text = std::ranges::find(texts, number) != texts.end();
        const bool is_known = is_text || (number <= 0x1B && bits_of(static_cast<DataType>(number)) != 0);
        const bool is_of_file = number >= 0x20 && number < 0x260; // a DEFSTRUCT or a DEFTYPE (CiA 301)
        object.type = static_cast<DataType>(is_known ? number : 0);
        // 011 may be meant as 0x11, a real, and says 9, a text.
        const bool is_octal = number > 7 && type.text.front() == '0' && is_decimal(type.text[1]);
        if (is_of_file && !is_octal)
            note(section, Kind::not_a_choice, data_type, flaw::type);
        else if (type.line != 0 && (!is_known || is_octal))
            refuse(section, Kind::not_a_choice, data_type);
        read_access(section, object);
        object.mappable = count_of(section, pdo_mapping, 0, 1) != 0;
        const Key value = section.entries[parameter_value].text.empty() ? default_value : parameter_value;
        object.is_parameter = value == parameter_value;
        object.text = section.entries[value].text;
        if (bits_of(object.type) != 0) {
            const NumberRead read = to_number(object.text, object.type);
            object.value = read.number;
            if (read.fault == NumberFault::no_number ||
                (read.fault == NumberFault::does_not_fit && is_of_start(object.at.index)))
                refuse(section, kind_of(read.fault), value);
            else if (read.fault == NumberFault::does_not_fit)
                note(section, kind_of(read.fault), value,
                     object.is_parameter ? flaw::value : std::uint8_t{0});
            if (object.is_parameter &&
                to_number(section.entries[default_value].text, object.type).fault == NumberFault::no_number)
                refuse(section, Kind::not_a_number, default_value);
            read_limits(section, object);
        } else if (!is_known && object.is_parameter) {
            section.flaws |= flaw::value; // unknown like its type
        }
        object.flaws = section.flaws;
        objects.push_back(object);
    }

    /// The identity and the PDOs: each start-up of the node needs their numbers.
    static bool is_of_start(std::uint16_t index) {
        return index == 0x1000 || index == 0x1018 || (index >= 0x1400 && index < 0x1C00);
    }
    static Kind kind_of(NumberFault fault) {
        return fault == NumberFault::no_number ? Kind::not_a_number : Kind::does_not_fit;
    }

    void read_access(Section& section, Object& object) {
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
        if (entry.line == 0) return refuse(section, Kind::no_entry, access_type);
        for (const Name& each : names)
            if (same(entry.text, each.text)) {
                object.access = each.access;
                section.is_read_only = each.access == Access::read_only || each.access == Access::constant;
                return;
            }
        refuse(section, Kind::not_a_choice, access_type);
    }

    /// Reads the limits. One beyond the type bounds nothing; contradictory ones are dropped, as a flaw.
    void read_limits(Section& section, Object& object) {
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
            else if (read.fault == NumberFault::does_not_fit)
                note_limit(section, Kind::does_not_fit, key);
            else
                refuse(section, Kind::not_a_number, key);
        }
        if (is_real(object.type) || !object.high.given) return;
        Object bounded = object;
        bounded.high = {};
        // 0xFF of eight bits with a sign: -1, or 255?
        const bool is_pattern = is_signed(object.type) && !high.starts_with('-') &&
                                object.high.bits >> (bits_of(object.type) - 1) != 0;
        if (!within_limits(bounded, object.high.of(1), 1))
            note_limit(section, Kind::limits_contradict, high_limit);
        else if (is_pattern && (low.empty() || low.starts_with('-')))
            note_limit(section, Kind::ambiguous_limit, high_limit);
        if (section.has_wrong_limits) object.low = object.high = {};
    }

    void order() {
        std::ranges::sort(objects, [](const Object& a, const Object& b) {
            return a.at != b.at ? a.at < b.at : a.line < b.line;
        });
        for (std::size_t i = 1; i < objects.size(); ++i)
            if (objects[i].at == objects[i - 1].at)
                refuse({Kind::object_twice, 0, objects[i].at, objects[i].line, objects[i - 1].line, {}, {}});
        std::ranges::sort(records_, [](const Record& a, const Record& b) {
            return a.index != b.index ? a.index < b.index : a.line < b.line;
        });
        for (std::size_t i = 1; i < records_.size(); ++i) {
            const Record &one = records_[i - 1], &same = records_[i];
            if (one.index == same.index)
                refuse({Kind::object_twice, 0, same.index, same.line, one.line, {}, {}});
        }
        if (objects.empty()) refuse({Kind::no_object, 0, {}, 1, 0, {}, {}});
    }

    void check_records() {
        for (const Object& object : objects) {
            const Record* const record = record_of(object.at.index);
            if (record == nullptr)
                refuse({Kind::no_section, 0, object.at, object.line, 0, {}, {}});
            else if (record->plain && object.at.sub != 0)
                refuse({Kind::part_of_variable, 0, object.at, object.line, 0, {}, {}});
        }
        check_pdos();
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
    /// A PDO is silenced by its sub-index 1, unless a row uses it.
    void check_pdos() {
        std::array<std::uint32_t, 2> written{};
        for (const Record& record : records_) {
            const bool is_sent = record.index >= 0x1800;
            const unsigned number = record.index - (is_sent ? 0x1800u : 0x1400u);
            if (number >= 0x200) continue;
            if (number < 4) ++written[is_sent ? 1 : 0];
            const Object* const cob = find({record.index, 1});
            if (cob == nullptr || (bits_of(cob->type) != 32 && (cob->flaws & flaw::type) == 0))
                refuse({Kind::no_identifier, 0, {record.index, 1}, record.line, 0, {}, {}});
        }
        if (compact_pdo_.line == 0) return;
        const FileNote compact{Kind::compact_pdo, 0, {}, compact_pdo_.line, 0, keys[compact_pdo],
                               compact_pdo_.text};
        // Those beyond the fourth are silent by themselves (CiA 301).
        if (written[0] < std::min(pdos_[0], 4u) || written[1] < std::min(pdos_[1], 4u) ||
            written[0] + written[1] == 0)
            refuse(compact);
        else
            note(compact);
    }
    const Record* record_of(std::uint16_t index) const {
        const auto found = std::ranges::lower_bound(records_, index, {}, &Record::index);
        return found != records_.end() && found->index == index ? &*found : nullptr;
    }

    /// Checks references: lists name objects, and values of a compact array name its sub-indices.
    void read_references() {
        SectionName in{};
        IniLines lines{source_.text};
        for (IniLine line = lines.next(); line.kind != IniLine::Kind::end; line = lines.next()) {
            if (line.kind == IniLine::Kind::section) {
                in = section_name(line.name);
                continue;
            }
            const auto place = to_whole(line.name);
            const bool is_place = place && !place->negative && place->size != 0 && place->size <= 0xFFFF;
            if (in.kind == SectionName::Kind::list && is_place) {
                const auto index = to_whole(line.value);
                const FileNote absent{Kind::not_in_file, 0, {}, line.line, 0, {}, line.value};
                if (!index || index->negative)
                    refuse(absent);
                else if (index->size > 0xFFFF ||
                         (index->size >= 0x1000 &&
                          record_of(static_cast<std::uint16_t>(index->size)) == nullptr))
                    note(absent);
            }
            if (in.kind != SectionName::Kind::values) continue;
            if (is_place)
                read_value(in.at.index, place->size, line);
            else if (!same(line.name, "NrOfEntries") || !to_whole(line.value))
                refuse({Kind::no_such_element, 0, in.at.index, line.line, 0, {}, line.name});
        }
    }
    void read_value(std::uint16_t index, std::uint64_t sub, const IniLine& line) {
        Object* const object = sub > 254 ? nullptr : find({index, static_cast<std::uint8_t>(sub)});
        if (object == nullptr) return refuse({Kind::no_such_element, 0, index, line.line, 0, {}, line.name});
        if (object->is_parameter)
            return refuse({Kind::value_twice, 0, object->at, line.line, object->line, {}, line.value});
        const NumberRead read = to_number(line.value, object->type);
        object->value = read.number;
        object->text = line.value;
        object->is_parameter = true;
        object->line = line.line;
        if (bits_of(object->type) == 0) return;
        FileNote fault_of{kind_of(read.fault), flaw::value, object->at, line.line, 0, "Value", line.value};
        if (read.fault == NumberFault::no_number || line.value.empty()) {
            fault_of.kind = Kind::not_a_number;
            return refuse(fault_of);
        }
        if (read.fault == NumberFault::none) return;
        object->flaws |= flaw::value;
        note(fault_of);
    }
    Object* find(Address at) {
        const auto found = std::ranges::lower_bound(objects, at, {}, &Object::at);
        return found != objects.end() && found->at == at ? &*found : nullptr;
    }

    void check_values() {
        for (Object& object : objects) {
            if (!object.value.given || within_limits(object, object.value.of(1), 1)) continue;
            const std::uint8_t flaws = object.is_parameter ? flaw::value : std::uint8_t{0};
            object.flaws |= flaws;
            note({Kind::outside_of_limits, flaws, object.at, object.line, 0, {}, object.text});
        }
    }

    void find_identity() {
        const Object* const type = find(0x1000);
        if (type == nullptr) return refuse({Kind::no_device_type, 0, 0x1000, 1, 0, {}, {}});
        identity.device_type = identity_of(*type);
        for (std::uint8_t sub = 1; sub <= 3; ++sub) {
            const Object* const object = find({0x1018, sub});
            if (object == nullptr) continue;
            const std::uint32_t said = identity_of(*object);
            if (said == 0) continue;
            std::uint32_t& number = sub == 1   ? identity.vendor
                                    : sub == 2 ? identity.product
                                               : identity.revision;
            if (number != 0 && number != said) {
                doubted |= static_cast<std::uint8_t>(1u << sub);
                note({Kind::identity_twice, 0, object->at, object->line, device_line_,
                      device_numbers_[sub - 1u], object->text});
            }
            number = said;
        }
    }

    /// Returns an object's part of the identity; 0: not given.
    std::uint32_t identity_of(const Object& object) {
        if (!object.text.empty() &&
            (!object.value.given || object.value.plus_node || object.value.bits > ~0u))
            refuse({Kind::not_a_number, 0, object.at, object.line, 0, "Value", object.text});
        return static_cast<std::uint32_t>(object.value.bits);
    }

    SourceText source_;
    std::vector<Record> records_{};
    std::uint32_t device_line_ = 0, commissioning_line_ = 0;
    Entry compact_pdo_{};
    std::array<std::uint32_t, 2> pdos_{}; ///< RPDOs and TPDOs as [DeviceInfo] counts them
    std::array<std::string_view, 3> device_numbers_{};
};

} // namespace detail

} // namespace tappet::canopen
