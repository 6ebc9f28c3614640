// The faults of an EDS or DCF file as sentences.
#pragma once

#include "drivers/canopen/cp1252.hpp"
#include "drivers/canopen/object_dictionary.hpp"

#include <array>

namespace tappet::canopen {

/// Returns a type's name in the code; empty: a number without one.
constexpr std::string_view name_of(DataType type) noexcept {
    constexpr std::array<std::string_view, 0x1C> names{"",
                                                       "boolean",
                                                       "integer8",
                                                       "integer16",
                                                       "integer32",
                                                       "unsigned8",
                                                       "unsigned16",
                                                       "unsigned32",
                                                       "real32",
                                                       "visible_string",
                                                       "octet_string",
                                                       "unicode_string",
                                                       "time_of_day",
                                                       "time_difference",
                                                       "",
                                                       "domain",
                                                       "integer24",
                                                       "real64",
                                                       "integer40",
                                                       "integer48",
                                                       "integer56",
                                                       "integer64",
                                                       "unsigned24",
                                                       "",
                                                       "unsigned40",
                                                       "unsigned48",
                                                       "unsigned56",
                                                       "unsigned64"};
    const auto number = static_cast<std::size_t>(type);
    return number < names.size() ? names[number] : std::string_view{};
}

/// Says what is wrong. Quotes at most 40 characters of the file.
constexpr Sentence meaning(const FileNote& note) noexcept {
    using Kind = FileNote::Kind;
    Sentence text;
    add_readable(text, note.text.substr(0, 40));
    const Sentence at = to_text(note.at), index = hex(note.at.index, 4);
    switch (note.kind) {
    case Kind::no_line: return Sentence{"\"", text, "\" is neither a [section] nor an entry Key=Value"};
    case Kind::no_such_section: return Sentence{"[", text, "] is no section of CiA 306"};
    case Kind::section_twice: return Sentence{"[", text, "] is there twice, first in line ", note.other};
    case Kind::joined:
        return Sentence{"\"", text, "\" holds another entry or section: a line's end is missing"};
    case Kind::damaged_key: return Sentence{"\"", text, "\" is not ", note.key, ", and nearly"};
    case Kind::other_section: {
        Sentence key;
        add_readable(key, note.key.substr(0, 40));
        return Sentence{key, " is no entry of [", text,
                        "]: the name of its own section is missing or damaged"};
    }
    case Kind::entry_twice:
        return Sentence{note.key, " is there twice in [", text, "], first in line ", note.other};
    case Kind::no_entry: return Sentence{"[", text, "] has no ", note.key};
    case Kind::not_a_choice:
        return Sentence{note.key, " \"", text, "\" has no meaning there (CiA 301, CiA 306)"};
    case Kind::not_a_number: return Sentence{note.key, " \"", text, "\" of ", at, " is not a number"};
    case Kind::does_not_fit: return Sentence{note.key, " ", text, " of ", at, " does not fit its DataType"};
    case Kind::bounds_nothing:
        return Sentence{note.key, " ", text, " of ", at, " lies beyond its DataType and bounds nothing"};
    case Kind::limits_contradict: return Sentence{note.key, " ", text, " of ", at, " is under its LowLimit"};
    case Kind::ambiguous_limit:
        return Sentence{note.key, " ", text,
                        " of ",   at,  " is a negative number for its DataType, or one beyond it"};
    case Kind::outside_of_limits:
        return Sentence{"the value ", text, " of ", at, " is outside of its own limits"};
    case Kind::object_twice: return Sentence{at, " is there twice, first in line ", note.other};
    case Kind::no_section: return Sentence{at, " is a part of ", index, ", which has no section"};
    case Kind::part_of_variable: return Sentence{at, " is a part of ", index, ", which is a variable"};
    case Kind::sub_number:
        return Sentence(note.key, " of ", index, " is ", text.empty() ? Sentence{"not written"} : text,
                        ", and ", note.other,
                        note.other == 1 ? " sub-index is there" : " sub-indices are there");
    case Kind::not_in_file: return Sentence{"a list names object ", text, ", which has no section"};
    case Kind::no_such_element:
        return Sentence{"it is a value of ", index, ":", text, ", which CompactSubObj does not make"};
    case Kind::compact_pdo:
        return Sentence{note.key, " ", text,
                        " stands for PDO objects without sections; only those with sections are read"};
    case Kind::identity_twice:
        return Sentence(at, " is ", text, ", but [DeviceInfo] (line ", note.other, ") says ", note.key);
    case Kind::value_of_record:
        return Sentence{note.key, " ",   text,
                        " of ",   index, ": a record or an array has values in its sub-indices"};
    case Kind::value_twice: return Sentence{at, " has two values, the first in line ", note.other};
    case Kind::no_identifier:
        return Sentence{"PDO ", index, " has no sub-index 1 of 32 bits, its COB-ID, by which it is silenced"};
    case Kind::no_object: return Sentence{"it has no object; is it an EDS or DCF file of CiA 306?"};
    case Kind::no_device_type:
        return Sentence{"object 1000h (device type), which each device has, is missing"};
    }
    return {};
}

/// Says who is affected.
constexpr Sentence effect(const FileNote& note) noexcept {
    if (note.flaws == flaw::file) return Sentence{"every node of this file"};
    if (note.kind == FileNote::Kind::compact_pdo) return Sentence{"rows that map one of those PDOs"};
    if (note.kind == FileNote::Kind::identity_twice)
        return Sentence{"nodes of this file without .identity(..)"};
    if (note.flaws == 0) return Sentence{"nobody"};
    if (note.flaws == flaw::value)
        return Sentence{"nodes of this file without .write(", to_text(note.at), ", ..)"};
    const bool only_writes = (note.flaws & ~(flaw::limits | flaw::value)) == 0;
    return Sentence{"rows that ", only_writes ? "" : "map or ", "write ", to_text(note.at)};
}

} // namespace tappet::canopen
