// The tables of a DBC file, made from what was read, and as constants of C++.
#pragma once

#include "drivers/can/dbc/network.hpp"
#include "drivers/can/dbc/table.hpp"

#include <deque>
#include <string>

namespace tappet::tables {

/// A table with its memory. The text that was read must outlive it.
struct OwnTable {
    explicit OwnTable(can::dbc::Network network);
    OwnTable(const OwnTable&) = delete;
    OwnTable& operator=(const OwnTable&) = delete;

    can::dbc::Table table{}; ///< refers to the rest

private:
    void write(can::dbc::Network& network, can::dbc::MessageRow& message);
    void write_nodes(can::dbc::Network& network);

    std::deque<std::string> rows_{}; ///< of the messages
    std::string lines_{};
    Sentence fault_{};
    std::vector<can::dbc::MessageEntry> messages_{};
    std::vector<can::dbc::NameEntry> names_{};
    std::vector<can::dbc::NodeEntry> nodes_{};
    std::vector<std::uint32_t> mentions_{};
};

/// Returns definitions of constants, of which `name` is the table.
[[nodiscard]] std::string to_cpp(const can::dbc::Table& table, std::string_view name);

} // namespace tappet::tables
