// An object dictionary from an EDS or DCF file (CiA 306), of which the build made tables: tappet_file() of
// CMake. A fault in the file is a build error with the file's own line, or, where whose it is stands beyond
// doubt (see EdsReader), a note, which is an error in a row that needs what is wrong.
//
//     tappet_file(<target> servo.eds)                                       in CMakeLists.txt
//     #include "<path>/servo.eds.hpp"                                      tappet::files::servo_eds
//     canopen::dictionary<files::servo_eds>                                      what is in it
#pragma once

#include "drivers/canopen/cp1252.hpp"
#include "drivers/canopen/number_text.hpp"
#include "drivers/canopen/object_dictionary.hpp"

#include <array>

namespace tappet::canopen {

/// A file as the build's program read it.
struct EdsFile {
    std::string_view fault{}; ///< the file describes no device
    Dictionary dictionary{};
};

/// The machine builder's word on an object, in place of its file's: see despite().
struct Belief {
    Address at{};
    DataType type = DataType::unsigned32;
    Access access = Access::read_write;
};

namespace detail {

/// The file's objects with those believed, as part of the program that uses them.
template <const auto& File, Belief... beliefs> struct CheckedDictionary {
    static constexpr Sentence fault{File.fault};
    TAPPET_ACCEPTED(fault);
    static constexpr auto& read = File.dictionary;
    static constexpr std::array<Belief, sizeof...(beliefs)> believed{beliefs...};
    static constexpr std::size_t added =
        (std::size_t{0} + ... + (read.find(beliefs.at) != nullptr ? 0u : 1u));
    static constexpr auto objects = [] {
        std::array<Object, read.objects.size() + added> all{};
        auto end = std::copy(read.objects.begin(), read.objects.end(), all.begin());
        for (const Belief& each : believed) {
            if (read.find(each.at) == nullptr) (end++)->at = each.at;
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
    static constexpr Dictionary dictionary{read.file,    read.product, read.node, read.identity,
                                           read.doubted, objects,      read.notes};
};
template <const auto& File> struct CheckedDictionary<File> {
    static constexpr Sentence fault{File.fault};
    TAPPET_ACCEPTED(fault);
    static constexpr const Dictionary& dictionary = File.dictionary;
};

} // namespace detail

/// Takes the object as one of this type and access, which may be mapped and has no limits, in spite of the
/// file: for a fault in a file, where the device's manual says otherwise.
constexpr Belief despite(Address at, DataType type, Access access = Access::read_write) noexcept {
    return {at, type, access};
}

/// The dictionary of a file, a constant made by tappet_file(). A fault in what a network's rows need is
/// refused there, and its cure is a despite() behind the file, also for the simulated device:
///     canopen::dictionary<files::servo_eds, canopen::despite(0x6060, canopen::DataType::integer8)>
template <const auto& File, Belief... beliefs>
    requires std::same_as<std::remove_cvref_t<decltype(File)>, EdsFile>
inline constexpr const Dictionary& dictionary = detail::CheckedDictionary<File, beliefs...>::dictionary;

} // namespace tappet::canopen
