// An object dictionary read from an EDS or DCF file (CiA 306) in a constant expression. A fault in the file
// is a build error with the file's own line, or, where whose it is stands beyond doubt (see EdsReader), a
// note, which is an error in a row that needs what is wrong.
//
//     tappet_file(<target> servo.eds)                                       in CMakeLists.txt
//     #include "<path>/servo.eds.hpp"                                      tappet::files::servo_eds, the text
//     canopen::dictionary<files::servo_eds>                                      what is in it
#pragma once

#include "drivers/canopen/cp1252.hpp"
#include "drivers/canopen/eds_reader.hpp"
#include "kernel/base/array_of.hpp"

#include <array>

namespace tappet::canopen {

/// The machine builder's word on an object, in place of its file's: see despite().
struct Belief {
    Address at{};
    DataType type = DataType::unsigned32;
    Access access = Access::read_write;
};

namespace detail {

template <const auto& Source> inline constexpr EdsReader<eds_room(Source.text)> eds_read{Source};

/// Copies the objects to an array of exact size, as part of the program that uses it, with those believed.
template <const auto& Source, Belief... beliefs> struct CheckedDictionary {
    TAPPET_ACCEPTED(eds_read<Source>.fault);
    static constexpr auto& read = eds_read<Source>;
    static constexpr std::array<Belief, sizeof...(beliefs)> believed{beliefs...};
    static constexpr bool in_file(Address at) {
        return std::ranges::find(read.objects, at, &Object::at) != read.objects.end();
    }
    static constexpr std::size_t added = (std::size_t{0} + ... + (in_file(beliefs.at) ? 0u : 1u));
    static constexpr auto objects = [] {
        std::array<Object, read.objects.used + added> all{};
        auto end = std::copy(read.objects.begin(), read.objects.end(), all.begin());
        for (const Belief& each : believed) {
            if (!in_file(each.at)) (end++)->at = each.at;
            Object& object = *std::ranges::find(all, each.at, &Object::at);
            const NumberRead value =
                bits_of(each.type) != 0 ? to_number(object.text, each.type) : NumberRead{};
            const bool is_readable = value.fault == NumberFault::none;
            const bool was_untyped = object.flaws == (flaw::type | flaw::value);
            object.flaws = was_untyped && is_readable ? std::uint8_t{0}
                           : object.is_parameter && !is_readable
                               ? flaw::value
                               : static_cast<std::uint8_t>(object.flaws & flaw::value);
            object.value = value.number;
            object.type = each.type;
            object.access = each.access;
            object.mappable = true;
            object.low = object.high = {};
        }
        std::ranges::sort(all, {}, &Object::at);
        return all;
    }();
    static constexpr auto notes = array_of<read.notes.used>([](std::size_t i) { return read.notes[i]; });
    static constexpr Dictionary dictionary{Source.name,  read.product, read.node, read.identity,
                                           read.doubted, objects,      notes};
};

} // namespace detail

/// Takes the object as one of this type and access, which may be mapped and has no limits, in spite of the
/// file: for a fault in a file, where the device's manual says otherwise.
constexpr Belief despite(Address at, DataType type, Access access = Access::read_write) noexcept {
    return {at, type, access};
}

/// The dictionary of a constant SourceText at namespace scope. A fault in what a network's rows need is
/// refused there, and its cure is a despite() behind the file, also for the simulated device:
///     canopen::dictionary<files::servo_eds, canopen::despite(0x6060, canopen::DataType::integer8)>
template <const auto& Source, Belief... beliefs>
inline constexpr const Dictionary& dictionary = detail::CheckedDictionary<Source, beliefs...>::dictionary;

} // namespace tappet::canopen
