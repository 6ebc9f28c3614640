// A node's map from a DBC text at run time: by the reader of the build's program, and by the code with which
// the compiler takes a map from the tables that it wrote.
#pragma once

#include "drivers/can/dbc/taking.hpp"
#include "toolchain/tables/dbc_tables.hpp"

#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace tappet::can {

/// Unused rows are empty and come last.
struct DbcMap {
    SignalMap<64, 512> map{};
    dbc::Sizes sizes{};

    DbcMap(std::string_view text, const NodeView& node) : text_{text}, own_{dbc::read("t.dbc", text_)} {
        const dbc::Table& table = own_.table;
        map.fault = Sentence{table.fault};
        if (!table.fault.empty()) return;
        const auto marks = std::make_unique<bool[]>(table.messages.size());
        const dbc::Room room = dbc::mark_candidates(table, node, marks.get());
        messages_.resize(room.messages);
        signals_.resize(room.signals);
        read_values_.resize(room.values);
        told_.resize(room.troubles);
        const dbc::Rows rows{{messages_.data(), messages_.size()},
                             {signals_.data(), signals_.size()},
                             {read_values_.data(), read_values_.size()}};
        dbc::decode(table, marks.get(), rows, told_.data());
        dbc::Taking taking{table, rows, told_.data(), node, map.fault};
        sizes = taking.take();
        values_.resize(sizes.values);
        const bool fits = sizes.frames <= map.frames.size() && sizes.signals <= map.signals.size();
        if (map.fault.empty() && !fits) map.fault = Sentence{"too large for this test"};
        if (map.fault.empty()) taking.fill(map, values_.data());
    }
    DbcMap(const DbcMap&) = delete;
    DbcMap& operator=(const DbcMap&) = delete;

private:
    std::string text_;
    tables::OwnTable own_;
    std::vector<dbc::MessageRow> messages_;
    std::vector<dbc::SignalRow> signals_;
    std::vector<ValueName> read_values_, values_;
    std::vector<dbc::Told> told_;
};

} // namespace tappet::can
