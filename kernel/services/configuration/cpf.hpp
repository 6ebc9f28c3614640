// The OMG Component Property Format as Orocos uses it (thesis 4.7.1): properties as XML text, read and
// written.
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
// Where Orocos lets what it does not know pass, this is an error.
#pragma once

#include "kernel/component/property_transaction.hpp"

#include <cstddef>
#include <span>
#include <string_view>

namespace tappet {

inline constexpr std::size_t max_cpf_bytes = 64 * 1024;

/// Told of a property that does not fit: the fault that it would be.
using LeftOut = void (*)(const Sentence& fault);

/// Proposes what the text says for the transaction's component. An empty sentence; or the first fault, with
/// `file`, line, component and cure, and the transaction is worth nothing. What the transaction holds before
/// is overruled. With `left_out`, for a file that another version of the machine wrote: a property that this
/// one does not know, or not with this type or value, is told there and stays as it was; only a file that is
/// no properties file is a fault. Takes heap: only before arming.
[[nodiscard]] Sentence read_cpf(std::string_view text, std::string_view file, PropertyTransaction& into,
                                LeftOut left_out = nullptr) noexcept;

/// Writes every value of the transaction, in the order of the component's interface, with its description.
/// The length, or 0 and `fault` says why. No heap. What it writes read_cpf reads to the same values.
[[nodiscard]] std::size_t write_cpf(const PropertyTransaction& from, std::span<char> into,
                                    Sentence& fault) noexcept;

} // namespace tappet
