// The rows of a DBC file: messages, their signals, and names of values.
#pragma once

#include "drivers/can/signal_map.hpp"

#include <optional>

namespace tappet::can::dbc {

/// Vector's name for no node, as a sender and as a receiver.
inline constexpr std::string_view nobody = "Vector__XXX";

/// A part of a message or a signal that a fault concerns, and that a row can state instead.
enum class Part : std::uint8_t {
    all,        ///< no row states it
    identifier, ///< despite(extended(..), ..)
    format,     ///< CAN FD or not: despite(bytes(..), ..)
    rate,       ///< every(..) or on_demand(..)
    selection,  ///< of a signal, by its multiplexor: when(..)
};

/// A list of nodes, and its position in the text.
struct NodeList {
    std::string_view names{};
    std::size_t at = 0;
};

// Positions are those in the text; a trouble is the index of a fault that was told; no_such: none.

struct SignalRow {
    Signal shape{};
    std::string_view factor{}, offset{}; ///< as in the file
    std::size_t at = 0;                  ///< position of its name
    std::size_t message = 0;
    NodeList receivers{};
    std::string_view long_name{};
    bool is_multiplexor = false;
    bool is_multiplexed = false;
    std::uint32_t page = 0;                  ///< m0: 0
    std::size_t selected_by = no_such;       ///< index of a signal
    std::size_t trouble = no_such;           ///< its first one
    std::size_t limits_trouble = no_such;    ///< of its limits
    std::size_t selection_trouble = no_such; ///< of its selection
    std::size_t names_at = no_such;          ///< position of its VAL_
    std::size_t first_value = 0;
    std::size_t values = 0;
    bool has_good_names = false;  ///< all of them can be believed
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
    NodeList sender{}, more_senders{};
    std::size_t first = 0;
    std::size_t signals = 0;
    bool says_every = false;
    std::optional<bool> is_fd{}, switches{}, on_demand{}; ///< empty: the file's default
    Duration every{};
    std::array<std::size_t, 5> troubles{no_such, no_such, no_such, no_such,
                                        no_such}; ///< the first of each part
    bool shares_identifier = false;               ///< with another message
    bool is_taken = false;
    Direction direction = Direction::receive;
    const FrameRow* row = nullptr;
};

/// A part of an array. Another type of std::span costs clang 40 ms in each file.
template <class T> struct Slice {
    T* items = nullptr;
    std::size_t count = 0;

    [[nodiscard]] constexpr T* begin() const noexcept { return items; }
    [[nodiscard]] constexpr T* end() const noexcept { return items + count; }
    [[nodiscard]] constexpr std::size_t size() const noexcept { return count; }
    constexpr T& operator[](std::size_t i) const noexcept { return items[i]; }
};

/// Rows in memory owned elsewhere.
struct Rows {
    Slice<MessageRow> messages{};
    Slice<SignalRow> signals{};
    Slice<ValueName> values{};

    [[nodiscard]] constexpr Slice<SignalRow> of(const MessageRow& message) const noexcept {
        return {signals.items + message.first, message.signals};
    }
    [[nodiscard]] constexpr SignalRow* find(const MessageRow& message, std::string_view name) const noexcept {
        for (SignalRow& each : of(message))
            if (each.shape.name == name) return &each;
        return nullptr;
    }
    [[nodiscard]] constexpr Slice<ValueName> names_of(const SignalRow& signal) const noexcept {
        return {values.items + signal.first_value, signal.values};
    }
};

} // namespace tappet::can::dbc
