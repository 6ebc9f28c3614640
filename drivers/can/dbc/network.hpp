// The contents of a DBC file: messages, their signals, and names of values, as rows that point into its text.
#pragma once

#include "drivers/can/dbc/scanner.hpp"
#include "drivers/can/dbc/troubles.hpp"
#include "drivers/can/signal_map.hpp"

#include <optional>

namespace tappet::can::dbc {

/// Vector's name for no node, as a sender and as a receiver.
inline constexpr std::string_view nobody = "Vector__XXX";
/// Vector's container for signals without a message.
inline constexpr std::string_view independent = "VECTOR__INDEPENDENT_SIG_MSG";

/// A part of a message or a signal that a fault concerns, and that a row can state instead.
enum class Part : std::uint8_t {
    all,        ///< no row states it
    identifier, ///< despite(extended(..), ..)
    format,     ///< CAN FD or not: despite(bytes(..), ..)
    rate,       ///< every(..) or on_demand(..)
    selection,  ///< of a signal, by its multiplexor: when(..)
};

struct SignalRow {
    Signal shape{};                      ///< its unit is as in the file
    std::string_view factor{}, offset{}; ///< as in the file
    std::size_t at = 0;                  ///< position of its name in the text
    std::size_t message = 0;
    std::string_view receivers{};
    std::string_view long_name{};
    bool is_multiplexor = false;
    bool is_multiplexed = false;
    std::uint32_t page = 0;                  ///< m0: 0
    std::size_t selected_by = no_such;       ///< index of a signal
    std::size_t trouble = no_such;           ///< position of its first fault
    std::size_t limits_trouble = no_such;    ///< position of a fault of its limits
    std::size_t selection_trouble = no_such; ///< position of a fault of its selection
    std::size_t names_at = no_such;          ///< position of its VAL_
    std::size_t first_value = 0;
    std::size_t values = 0;
    bool is_replaced = false;     ///< by a row of the machine for another one of this name
    bool is_taken = false;        ///< by the node in question
    const Signal* row = nullptr;  ///< the machine's row for it
    std::size_t placed = no_such; ///< index in the node's map
};

struct MessageRow {
    Identifier identifier{};
    bool is_independent = false;
    std::string_view name{};
    std::string_view long_name{};
    std::size_t at = 0;
    std::uint32_t length = 0;
    std::string_view sender{};
    std::string_view more_senders{};
    std::size_t first = 0;
    std::size_t signals = 0;
    bool says_every = false;
    std::optional<bool> is_fd{}, switches{}, on_demand{}; ///< empty: the file's default
    Duration every{};
    /// Position of the first fault of each part.
    std::array<std::size_t, 5> troubles{no_such, no_such, no_such, no_such, no_such};
    bool shares_identifier = false; ///< with another message
    bool is_taken = false;
    Direction direction = Direction::receive;
    const FrameRow* row = nullptr;
};

/// Upper bounds, from a quick scan of the text.
struct Room {
    std::size_t messages = 0, signals = 0, values = 0;
};
constexpr bool is_keyword(std::string_view text, std::string_view word) noexcept {
    return text.starts_with(word) && (text.size() == word.size() || is_blank(text[word.size()]));
}
constexpr Room room_for(std::string_view text) noexcept {
    text = without_mark(text);
    Room room;
    std::size_t quotes = 0;
    bool begins = true;
    bool in_message = false; // the line begins with BO_: a signal may follow
    const char* const characters = text.data();
    const std::size_t size = text.size();
    for (std::size_t i = 0; i < size; ++i) {
        const char c = characters[i];
        quotes += c == '"';
        if (begins && c == 'B' && is_keyword(text.substr(i), "BO_")) {
            ++room.messages;
            in_message = true;
        } else if ((begins || in_message) && c == 'S') {
            room.signals += is_keyword(text.substr(i), "SG_");
        }
        const bool ends = c == '\n' || c == '\r' || c == ';';
        if (ends) in_message = false;
        begins = ends || (begins && is_blank(c));
    }
    room.values = quotes / 2;
    return room;
}

/// A network; its rows are in memory owned elsewhere.
struct Network {
    std::string_view file{};
    std::string_view text{};
    std::string_view nodes{}; ///< all of them, as a list
    std::span<MessageRow> messages{};
    std::span<SignalRow> signals{};
    std::span<ValueName> values{}; ///< as in the file
    Room used{};
    Sentence fault{};
    Troubles* troubles = nullptr; ///< where the reader tells what is wrong

    [[nodiscard]] constexpr std::span<MessageRow> all() const noexcept {
        return messages.first(used.messages);
    }
    [[nodiscard]] constexpr std::span<SignalRow> of(const MessageRow& message) const noexcept {
        return signals.subspan(message.first, message.signals);
    }
    [[nodiscard]] constexpr SignalRow* find(const MessageRow& message, std::string_view name) const noexcept {
        for (SignalRow& each : of(message))
            if (each.shape.name == name) return &each;
        return nullptr;
    }
    [[nodiscard]] constexpr bool sends(const MessageRow& message, std::string_view node) const noexcept {
        return message.sender == node || names(message.more_senders, node);
    }
    [[nodiscard]] constexpr unsigned line_of(std::size_t at) const noexcept {
        return static_cast<unsigned>(std::ranges::count(text.substr(0, at), '\n')) + 1;
    }

    /// Records a fault; only the first one counts.
    template <class... Pieces> constexpr void fail(std::size_t at, const Pieces&... pieces) {
        if (!fault.empty()) return;
        unsigned column = 1;
        while (column <= at && text[at - column] != '\n') ++column;
        fault = Sentence{file, ":", line_of(at), ":", column, ": ", pieces...};
    }
};

/// A network with its memory; `text` must outlive it.
template <Room room> struct Store {
    std::array<MessageRow, room.messages> messages{};
    std::array<SignalRow, room.signals> signals{};
    std::array<ValueName, room.values> values{};
    std::string_view file{}, text{}, nodes{};
    Room used{};
    Sentence fault{};

    constexpr Network network() noexcept {
        return {file, text, nodes, messages, signals, values, used, fault};
    }
    constexpr void keep(const Network& from) noexcept {
        nodes = from.nodes;
        used = from.used;
        fault = from.fault;
    }
};

} // namespace tappet::can::dbc
