// The contents of a DBC file as it is read on the host: its rows, which point into its text, and its faults.
#pragma once

#include "drivers/can/dbc/rows.hpp"
#include "drivers/can/dbc/scanner.hpp"

#include <vector>

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

/// Vector's container for signals without a message.
inline constexpr std::string_view independent = "VECTOR__INDEPENDENT_SIG_MSG";

struct Network {
    std::string_view file{};
    std::string_view text{};
    NodeList nodes{}; ///< those of BU_
    std::vector<MessageRow> messages{};
    std::vector<SignalRow> signals{};
    std::vector<ValueName> values{}; ///< as in the file
    std::vector<Trouble> troubles{};
    Sentence fault{}; ///< nothing of the file can be used

    [[nodiscard]] Rows rows() noexcept {
        return {{messages.data(), messages.size()},
                {signals.data(), signals.size()},
                {values.data(), values.size()}};
    }
    [[nodiscard]] Slice<SignalRow> of(const MessageRow& message) noexcept { return rows().of(message); }
    [[nodiscard]] SignalRow* find(const MessageRow& message, std::string_view name) noexcept {
        return rows().find(message, name);
    }
    [[nodiscard]] unsigned line_of(std::size_t at) const noexcept {
        return static_cast<unsigned>(std::ranges::count(text.substr(0, at), '\n')) + 1;
    }
    [[nodiscard]] std::size_t position_of(std::string_view part) const noexcept {
        return static_cast<std::size_t>(part.data() - text.data());
    }
    /// Records a fault; only the first one counts.
    template <class... Pieces> void fail(std::size_t at, const Pieces&... pieces) {
        if (!fault.empty()) return;
        unsigned column = 1;
        while (column <= at && text[at - column] != '\n') ++column;
        fault = Sentence{file, ":", line_of(at), ":", column, ": ", pieces...};
    }
};

/// Reads a DBC file, whose text must outlive the network.
[[nodiscard]] Network read(std::string_view file, std::string_view text);

} // namespace tappet::can::dbc
