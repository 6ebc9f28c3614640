// The OMG Component Property Format as used by Orocos (thesis 4.7.1): reads and writes properties as XML
// text.
//
//     <properties>
//       <simple name="set_point_n" type="double"><value>300</value></simple>
//       <struct name="gains" type="PropertyBag">
//         <simple name="p" type="double"><description>proportional</description><value>0.004</value></simple>
//       </struct>
//       <sequence name="offsets" type="double">
//         <simple type="double"><value>0.5</value></simple>
//       </sequence>
//     </properties>
//
// A bag is a struct, a list is a sequence, everything else is simple. Types: boolean; short, ushort, long,
// ulong, llong, ullong; float, double; string, which also holds times ("4ms") and names of enumerations.
// Unknown names, which Orocos ignores, are errors here.
#pragma once

#include "kernel/component/property_transaction.hpp"

#include <cstddef>
#include <span>
#include <string_view>

namespace tappet {

inline constexpr std::size_t max_cpf_bytes = 64 * 1024;

/// Receives the fault of a property that does not fit.
using LeftOut = void (*)(const Sentence& fault);

/// Proposes the values in the text for the transaction's component; they override those that the transaction
/// holds. Returns an empty sentence, or the first fault, with `file`, line, component and cure; the
/// transaction is then useless. With `left_out`, for a file from another version of the machine: a property
/// that this version does not know, or not with this type or value, is reported there and keeps its value;
/// only a file that is no properties file is a fault. Allocates from the heap: only before arming.
[[nodiscard]] Sentence read_cpf(std::string_view text, std::string_view file, PropertyTransaction& into,
                                LeftOut left_out = nullptr) noexcept;

/// Writes every value of the transaction, in the order of the component's interface, with its description.
/// Returns the length, or 0 with the reason in `fault`. No heap. read_cpf reads the text back to the same
/// values.
[[nodiscard]] std::size_t write_cpf(const PropertyTransaction& from, std::span<char> into,
                                    Sentence& fault) noexcept;

} // namespace tappet
