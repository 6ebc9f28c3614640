// A node's map from a DBC text at run time, by the reader that the compiler runs for a file of the firmware.
#pragma once

#include "drivers/can/dbc/reader.hpp"
#include "drivers/can/dbc/taking.hpp"

#include <string>
#include <vector>

namespace tappet::can {

/// Unused rows are empty and come last.
struct DbcMap {
    SignalMap<64, 512> map{};
    dbc::Sizes sizes{};

    DbcMap(std::string_view text, const NodeView& node) : text_{text} {
        const dbc::Room room = dbc::room_for(text_);
        messages_.resize(room.messages);
        signals_.resize(room.signals);
        read_values_.resize(room.values);
        dbc::Network network{"t.dbc", text_, {}, messages_, signals_, read_values_};
        dbc::Reader{network}.read();
        if (network.fault.empty()) {
            dbc::Taking taking{network, node};
            sizes = taking.take();
            values_.resize(sizes.values);
            characters_.resize(sizes.characters);
            const bool fits = sizes.frames <= map.frames.size() && sizes.signals <= map.signals.size();
            if (network.fault.empty() && !fits) network.fault = Sentence{"too large for this test"};
            if (network.fault.empty()) taking.fill(map, values_, characters_);
        }
        map.fault = network.fault;
    }
    DbcMap(const DbcMap&) = delete;
    DbcMap& operator=(const DbcMap&) = delete;

private:
    std::string text_;
    std::vector<dbc::MessageRow> messages_;
    std::vector<dbc::SignalRow> signals_;
    std::vector<ValueName> read_values_, values_;
    std::vector<char> characters_;
};

} // namespace tappet::can
