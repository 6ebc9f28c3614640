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
// A bag is a struct, a list is a sequence, everything else is simple. Orocos writes a list also as a struct:
//
//     <struct name="K" type="std::vector<double>">
//       <simple name="Size" type="long"><value>2</value></simple>
//       <simple name="0" type="double"><value>2</value></simple>
//       <simple name="1" type="double"><value>2.5</value></simple>
//     </struct>
//
// Elements have no names, or are numbered in their order from 0 or 1, also behind a word ("Element0"); "Size"
// is optional. A matrix is a list of its elements, column by column, or a list of its rows. Types: boolean;
// short, ushort, long, ulong, llong, ullong; float, double; string, which also holds times ("4ms") and names
// of enumerations. Unknown names, which Orocos ignores, are errors here.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/bounded_text.hpp"
#include "kernel/component/property_transaction.hpp"

#include <cstddef>
#include <span>
#include <string_view>

namespace tappet {

inline constexpr std::size_t max_cpf_bytes = 64 * 1024;

/// The form in which a file writes a list.
struct CpfListForm {
    /// The form of the list itself, or of each row of a matrix.
    struct Layer {
        bool is_struct = false; ///< otherwise a sequence
        bool has_size = false;
        bool has_names = false;
        std::size_t first = 0; ///< number of the first element's name
        Text<31> stem{};       ///< the names before their numbers
        Text<95> type{};       ///< of the struct or sequence; empty: that of its elements
        bool operator==(const Layer&) const = default;
    };
    std::string_view component{}; ///< its row's name
    std::size_t facet = 0;        ///< the property, in the component's interface
    bool in_rows = false;
    Layer list{}, row{};
};
/// Lists in another form than Tappet's own, of one machine.
using CpfListForms = Bounded<CpfListForm, 128>;

/// Receives the fault of a property that does not fit.
using LeftOut = void (*)(const Sentence& fault);

/// Proposes the values in the text for the transaction's component; they override those that the transaction
/// holds. Returns an empty sentence, or the first fault, with `file`, line, component and cure; the
/// transaction is then useless. With `left_out`, for a file from another version of the machine: a property
/// that this version does not know, or not with this type or value, is reported there and keeps its value;
/// only a file that is no properties file is a fault. With `forms`, keeps there the form of each list that
/// it reads. Allocates from the heap: only before arming.
[[nodiscard]] Sentence read_cpf(std::string_view text, std::string_view file, PropertyTransaction& into,
                                LeftOut left_out = nullptr, CpfListForms* forms = nullptr) noexcept;

/// Writes every value of the transaction, in the order of the component's interface, with its description;
/// each list in its form of `forms`, otherwise as a sequence. Returns the length, or 0 with the reason in
/// `fault`. No heap. read_cpf reads the text back to the same values.
[[nodiscard]] std::size_t write_cpf(const PropertyTransaction& from, std::span<char> into, Sentence& fault,
                                    std::span<const CpfListForm> forms = {}) noexcept;

} // namespace tappet
