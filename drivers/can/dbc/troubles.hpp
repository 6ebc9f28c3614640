// Troubles of a DBC file: what is wrong at a position, and which row it concerns.
#pragma once

#include "drivers/map/rows.hpp"

#include <span>

namespace tappet::can::dbc {

enum class Weight : std::uint8_t {
    note,   ///< no map suffers from it
    limits, ///< of a signal's limits, which only a sent signal needs
    fault,  ///< a map that takes the row is refused
};

struct Trouble {
    std::size_t at = 0; ///< position in the text
    Weight weight = Weight::note;
    std::size_t message = no_such, signal = no_such; ///< rows of the network; no_such: none
    Sentence text{};
};

/// Keeps the troubles that a reader tells, in memory owned elsewhere: all of them, or the one that makes a
/// map refused. A constant expression composes no other sentence.
struct Troubles {
    std::span<Trouble> rows{};
    std::size_t wanted = no_such; ///< position of the only one
    std::size_t count = 0;        ///< may exceed the memory: read again with more

    template <class... Pieces> constexpr void add(Trouble trouble, const Pieces&... pieces) {
        if (wanted != no_such && (wanted != trouble.at || trouble.weight == Weight::note || count != 0))
            return;
        trouble.text = Sentence{pieces...};
        if (count < rows.size()) rows[count] = trouble;
        ++count;
    }
};

} // namespace tappet::can::dbc
