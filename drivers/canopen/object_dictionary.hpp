// The object dictionary of a CANopen device (CiA 301, 7.4): the objects that can be read and written by index
// and sub-index, with their limits.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::canopen {

/// Data types, by their number in the standard (CiA 301, table 44).
enum class DataType : std::uint16_t {
    boolean = 0x01,
    integer8,
    integer16,
    integer32,
    unsigned8,
    unsigned16,
    unsigned32,
    real32,
    visible_string,
    octet_string,
    unicode_string,
    time_of_day,
    time_difference,
    domain = 0x0F,
    integer24,
    real64,
    integer40,
    integer48,
    integer56,
    integer64,
    unsigned24,
    unsigned40 = 0x18,
    unsigned48,
    unsigned56,
    unsigned64,
};

/// Returns the bits of a value in a frame; 0: a type of variable length, or an unknown one.
constexpr unsigned bits_of(DataType type) noexcept TAPPET_REALTIME {
    switch (type) {
    case DataType::boolean: return 1;
    case DataType::integer8:
    case DataType::unsigned8: return 8;
    case DataType::integer16:
    case DataType::unsigned16: return 16;
    case DataType::integer24:
    case DataType::unsigned24: return 24;
    case DataType::integer32:
    case DataType::unsigned32:
    case DataType::real32: return 32;
    case DataType::integer40:
    case DataType::unsigned40: return 40;
    case DataType::integer48:
    case DataType::unsigned48:
    case DataType::time_of_day:
    case DataType::time_difference: return 48;
    case DataType::integer56:
    case DataType::unsigned56: return 56;
    case DataType::integer64:
    case DataType::unsigned64:
    case DataType::real64: return 64;
    case DataType::visible_string:
    case DataType::octet_string:
    case DataType::unicode_string:
    case DataType::domain: break;
    }
    return 0;
}
/// Returns the bytes of a value in a transfer; a boolean takes one.
constexpr unsigned bytes_of(DataType type) noexcept TAPPET_REALTIME { return (bits_of(type) + 7) / 8; }
constexpr bool is_signed(DataType type) noexcept TAPPET_REALTIME {
    return (type >= DataType::integer8 && type <= DataType::integer32) || type == DataType::integer24 ||
           (type >= DataType::integer40 && type <= DataType::integer64);
}
constexpr bool is_real(DataType type) noexcept TAPPET_REALTIME {
    return type == DataType::real32 || type == DataType::real64;
}
constexpr std::uint64_t low_bits(std::uint64_t value, unsigned bits) noexcept TAPPET_REALTIME {
    return bits >= 64 ? value : value & ((std::uint64_t{1} << bits) - 1);
}

enum class Access : std::uint8_t {
    read_only,
    write_only,
    read_write,
    read_write_read, ///< rwr: the device sends it in a PDO
    read_write_write,
    constant,
};
constexpr bool readable(Access access) noexcept TAPPET_REALTIME { return access != Access::write_only; }
constexpr bool writable(Access access) noexcept TAPPET_REALTIME {
    return access != Access::read_only && access != Access::constant;
}

/// The address of an object in a dictionary.
struct Address {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    constexpr Address() = default;
    // NOLINTNEXTLINE: an index alone means its sub-index 0
    constexpr Address(std::uint16_t at, std::uint8_t at_sub = 0) noexcept : index{at}, sub{at_sub} {}
    friend constexpr auto operator<=>(const Address&, const Address&) = default;
};

/// A number that may depend on the node's identifier: $NODEID+0x180.
struct Number {
    std::uint64_t bits = 0; ///< of the object's type, higher bits 0
    bool given = false;
    bool plus_node = false;
    [[nodiscard]] constexpr std::uint64_t of(std::uint8_t node) const noexcept TAPPET_REALTIME {
        return plus_node ? bits + node : bits;
    }
};

/// The parts of an object's description that a fault in the file makes unknown. A row that needs one of them
/// is refused.
namespace flaw {
inline constexpr std::uint8_t type = 1, value = 2, limits = 4;
inline constexpr std::uint8_t file = 8; ///< of a note, not of an object: the file is refused
} // namespace flaw

/// A fault in the file, as data; eds_notes.hpp says it.
struct FileNote {
    enum class Kind : std::uint8_t {
        no_line,
        no_such_section,
        section_twice,
        joined,
        damaged_key,
        other_section,
        entry_twice,
        no_entry,
        not_a_choice,
        not_a_number,
        does_not_fit,
        bounds_nothing,
        limits_contradict,
        ambiguous_limit,
        outside_of_limits,
        object_twice,
        no_section,
        part_of_variable,
        sub_number,
        not_in_file,
        no_such_element,
        compact_pdo,
        identity_twice,
        no_device_type,
        value_of_record,
        value_twice,
        no_identifier,
        no_object,
    };
    Kind kind = Kind::no_line;
    std::uint8_t flaws = 0; ///< of the object; 0: no row needs what is wrong
    Address at{};
    std::uint32_t line = 0;
    std::uint32_t other = 0; ///< another line, or a count
    std::string_view key{};  ///< in the file
    std::string_view text{}; ///< in the file
};

struct Object {
    Address at{};
    DataType type = DataType::unsigned32;
    Access access = Access::read_only;
    bool mappable = false;
    bool is_parameter = false; ///< the value comes from a DCF, instead of the device's default
    std::uint8_t flaws = 0;    ///< see flaw
    Number value{}, low{}, high{};
    std::string_view name{};
    std::string_view text{}; ///< the value as the file writes it; strings are kept here
    std::uint32_t line = 0;
};

/// Returns whether a value of the object's type lies within its limits.
constexpr bool within_limits(const Object& object, std::uint64_t bits, std::uint8_t node) noexcept
    TAPPET_REALTIME {
    if (is_real(object.type)) return true;
    const unsigned wide = bits_of(object.type);
    const auto whole = [&](std::uint64_t raw) {
        if (!is_signed(object.type) || wide >= 64 || (raw >> (wide - 1) & 1) == 0) return raw;
        return raw | ~low_bits(~std::uint64_t{0}, wide);
    };
    const auto less = [&](std::uint64_t a, std::uint64_t b) {
        return is_signed(object.type)
                   ? static_cast<std::int64_t>(whole(a)) < static_cast<std::int64_t>(whole(b))
                   : a < b;
    };
    return (!object.low.given || !less(bits, object.low.of(node))) &&
           (!object.high.given || !less(object.high.of(node), bits));
}

/// The objects that identify a device type (1000h and 1018h). 0: any.
struct Identity {
    std::uint32_t device_type = 0;
    std::uint32_t vendor = 0;
    std::uint32_t product = 0;
    std::uint32_t revision = 0;
    bool operator==(const Identity&) const = default;
};

/// A device's dictionary from its file. The data it refers to are constants.
struct Dictionary {
    std::string_view file{};
    std::string_view product{};
    std::uint8_t node = 0; ///< the only node that a DCF is for; 0: any
    Identity identity{};
    /// Bit n: the file contradicts itself on 1018h:n of the identity, which is then that of the object.
    std::uint8_t doubted = 0;
    std::span<const Object> objects{}; ///< in the order of their addresses
    /// On the file's faults: for sentences, so no decision may depend on them.
    std::span<const FileNote> notes{};

    /// Finds an object; null when the device has none there. Real-time: binary search.
    [[nodiscard]] constexpr const Object* find(Address at) const noexcept TAPPET_REALTIME {
        std::size_t first = 0, last = objects.size();
        while (first < last) {
            const std::size_t middle = first + (last - first) / 2;
            if (objects[middle].at < at)
                first = middle + 1;
            else
                last = middle;
        }
        return first < objects.size() && objects[first].at == at ? &objects[first] : nullptr;
    }
};

/// Adds a number as the standard writes it: "1018h".
constexpr void add_hex(Sentence& to, std::uint64_t number, unsigned digits) noexcept TAPPET_REALTIME {
    while (digits < 16 && number >> (4 * digits) != 0) ++digits;
    for (unsigned i = digits; i-- > 0;) {
        const char digit = "0123456789ABCDEF"[number >> (4 * i) & 0xF];
        to.add(std::string_view{&digit, 1});
    }
    to.add(std::string_view{"h"});
}
constexpr Sentence hex(std::uint64_t number, unsigned digits) noexcept {
    Sentence text;
    add_hex(text, number, digits);
    return text;
}
/// Returns an address as the standard writes it: "1018h:2".
constexpr Sentence to_text(Address at) noexcept { return hex(at.index, 4).add(":").add(unsigned{at.sub}); }

} // namespace tappet::canopen
