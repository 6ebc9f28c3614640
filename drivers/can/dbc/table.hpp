// A DBC file as tables, which the build's program made of it. The compiler decodes the messages that may
// concern a map, and no others: a file may have thousands.
#pragma once

#include "drivers/can/dbc/nearly.hpp"
#include "drivers/can/dbc/node.hpp"
#include "drivers/can/dbc/rows.hpp"

#include <bit>
#include <utility>

namespace tappet::can::dbc {

/// The hash of a name (FNV-1a): the compiler compares numbers faster than texts.
constexpr std::uint32_t hash_of(std::string_view name) noexcept {
    std::uint32_t hash = 0x811C'9DC5;
    for (const char each : name) hash = (hash ^ static_cast<std::uint8_t>(each)) * 0x0100'0193u;
    return hash;
}

struct MessageEntry {
    const char* row = nullptr; ///< its fields and those of its signals, in the order of pass_message()
    std::uint32_t signals = 0, values = 0, troubles = 0;
};

/// A message by its name.
struct NameEntry {
    std::uint32_t hash = 0, message = 0;
};

/// A node that BU_ or a message names.
struct NodeEntry {
    std::string_view name{};
    std::uint32_t hash = 0; ///< of the name
    bool is_listed = false; ///< by BU_
    bool is_sender = false;
    std::uint32_t first = 0, messages = 0; ///< those that name it, in Table::mentions
};

struct Table {
    std::string_view file{};
    std::string_view fault{};    ///< nothing of the file can be used
    NodeList nodes{};            ///< those of BU_
    const char* lines = nullptr; ///< the number of characters of each line
    Slice<const MessageEntry> messages{};
    Slice<const NameEntry> names{}; ///< in the order of their hashes
    Slice<const NodeEntry> node_entries{};
    Slice<const std::uint32_t> mentions{};

    [[nodiscard]] constexpr const NodeEntry* node(std::string_view name) const noexcept {
        const std::uint32_t hash = hash_of(name);
        for (const NodeEntry& each : node_entries)
            if (each.hash == hash && each.name == name) return &each;
        return nullptr;
    }
};

/// A fault that the reader told.
struct Told {
    std::size_t at = 0;
    std::string_view text{};
};

/// Passes the fields of a message in the order of the table: the writer and the reader of rows use it. Fields
/// that most rows lack follow only if a flag says so, because each number costs the compiler time.
template <class Pass> constexpr void pass_message(Pass& pass, MessageRow& row) {
    bool has_troubles = row.troubles != MessageRow{}.troubles;
    pass.texts(row.name);
    pass.numbers(row.identifier.id, row.length, row.at, row.every);
    pass.flags(row.identifier.extended, *row.is_fd, *row.switches, *row.on_demand, row.shares_identifier,
               has_troubles);
    pass.list(row.sender);
    pass.list(row.more_senders);
    if (!has_troubles) return;
    for (std::size_t& each : row.troubles) pass.trouble(each);
}
/// Does the same for a signal, without the names of its values.
template <class Pass> constexpr void pass_signal(Pass& pass, SignalRow& row) {
    Signal& s = row.shape;
    bool is_scaled = s.factor != 1 || s.offset != 0, has_limits = s.least != 0 || s.most != 0;
    bool has_troubles =
        row.trouble != no_such || row.limits_trouble != no_such || row.selection_trouble != no_such;
    bool is_selected = row.selected_by != 0, is_motorola = s.order == Order::motorola;
    pass.texts(s.name, s.unit);
    pass.numbers(row.at, s.start, s.bits, s.kind, row.values);
    pass.flags(is_motorola, s.has_range, row.is_multiplexor, row.is_multiplexed, row.has_good_names,
               is_scaled, has_limits, is_selected, has_troubles);
    s.order = is_motorola ? Order::motorola : Order::intel;
    pass.list(row.receivers);
    if (is_scaled) {
        pass.reals(s.factor, s.offset);
        pass.texts(row.factor, row.offset);
    }
    if (has_limits) pass.reals(s.least, s.most);
    if (is_selected) {
        pass.numbers(row.selected_by, s.selections.used);
        for (Selection& each : s.selections) pass.numbers(each.from, each.to);
    }
    if (!has_troubles) return;
    pass.trouble(row.trouble);
    pass.trouble(row.limits_trouble);
    pass.trouble(row.selection_trouble);
}

/// Reads the fields of a row. A number ends with a blank; a text stands behind its length.
class FieldReader {
public:
    constexpr explicit FieldReader(const char* row, Told* told = nullptr) noexcept : at_{row}, told_{told} {}

    [[nodiscard]] constexpr std::uint64_t number() noexcept {
        const char* at = at_; // a member costs more time in a constant expression
        std::uint64_t number = 0;
        for (; *at != ' '; ++at) number = 10 * number + static_cast<unsigned>(*at - '0');
        at_ = at + 1;
        return number;
    }
    template <class... Numbers> constexpr void numbers(Numbers&... to) noexcept {
        ((to = static_cast<Numbers>(number())), ...);
    }
    template <class... Flags> constexpr void flags(Flags&... to) noexcept {
        std::uint64_t bits = number();
        ((to = (bits & 1u) != 0, bits >>= 1), ...);
    }
    template <class... Reals> constexpr void reals(Reals&... to) noexcept {
        ((to = std::bit_cast<double>(std::byteswap(number()))), ...);
    }
    template <class... Texts> constexpr void texts(Texts&... to) noexcept {
        const auto read = [this](std::string_view& text) {
            const auto size = static_cast<std::size_t>(number());
            text = {at_, size};
            at_ += size;
        };
        (read(to), ...);
    }
    constexpr void list(NodeList& to) noexcept {
        numbers(to.at);
        if (to.at != 0) texts(to.names);
    }
    constexpr void trouble(std::size_t& to) noexcept {
        const std::uint64_t at = number(); // 0: none
        if (at == 0) return;
        told_[told_count_].at = static_cast<std::size_t>(at - 1);
        texts(told_[told_count_].text);
        to = told_count_++;
    }
    constexpr void go_to(const char* row) noexcept { at_ = row; }

private:
    const char* at_;
    Told* told_;
    std::size_t told_count_ = 0;
};

constexpr std::string_view name_of(const MessageEntry& message) noexcept {
    std::string_view name;
    FieldReader{message.row}.texts(name);
    return name;
}

struct Room {
    std::size_t messages = 0, signals = 0, values = 0, troubles = 0;
};

/// Marks each message that the node's rows or the file's lists of nodes bring to the node: its own name, or
/// one that BU_ lacks and that may be a damaged one. Returns the room for the rows of these messages.
constexpr Room mark_candidates(const Table& table, const NodeView& node, bool* marks) {
    Room room;
    const auto visit = [&](std::size_t m) {
        if (std::exchange(marks[m], true)) return;
        const MessageEntry& entry = table.messages[m];
        ++room.messages;
        room.signals += entry.signals;
        room.values += entry.values;
        room.troubles += entry.troubles;
    };
    for (const FrameRow& row : node.frames) {
        const std::string_view name = row.in_file.empty() ? row.name : row.in_file;
        const std::uint32_t hash = hash_of(name);
        std::size_t at = 0;
        for (std::size_t end = table.names.size(); at < end;) {
            const std::size_t middle = (at + end) / 2;
            (table.names[middle].hash < hash ? at : end) = middle + (table.names[middle].hash < hash ? 1 : 0);
        }
        for (; at < table.names.size() && table.names[at].hash == hash; ++at)
            if (name_of(table.messages[table.names[at].message]) == name) visit(table.names[at].message);
    }
    if (node.name.empty()) return room;
    const NodeEntry* const own = table.node(node.name);
    const bool is_listed = own != nullptr && own->is_listed;
    for (const NodeEntry& each : table.node_entries)
        if (&each == own ||
            (is_listed && !each.is_listed && may_be_node(each.name, node.name, table.nodes.names)))
            for (std::uint32_t i = 0; i < each.messages; ++i) visit(table.mentions[each.first + i]);
    return room;
}

/// Rows of a table's messages, in the order of the file, and the faults told of them.
template <Room room> struct Store {
    std::array<MessageRow, room.messages> messages{};
    std::array<SignalRow, room.signals> signals{};
    std::array<ValueName, room.values> values{};
    std::array<Told, room.troubles> told{};

    constexpr Rows rows() noexcept {
        return {
            {messages.data(), room.messages}, {signals.data(), room.signals}, {values.data(), room.values}};
    }
};

/// Decodes the messages with a mark into memory of their size.
constexpr void decode(const Table& table, const bool* marks, const Rows& into, Told* told) {
    FieldReader in{nullptr, told};
    std::size_t m = 0, s = 0, v = 0;
    for (std::size_t i = 0; i < table.messages.size(); ++i) {
        if (!marks[i]) continue;
        const MessageEntry& entry = table.messages[i];
        MessageRow& message = into.messages[m];
        message.first = s;
        message.signals = entry.signals;
        message.is_fd = message.switches = message.on_demand = false;
        in.go_to(entry.row);
        pass_message(in, message);
        for (std::size_t end = s + entry.signals; s != end; ++s) {
            SignalRow& signal = into.signals[s];
            signal.selected_by = 0;
            pass_signal(in, signal);
            signal.selected_by = signal.selected_by == 0 ? no_such : message.first + signal.selected_by - 1;
            if (signal.receivers.at == 0) signal.receivers = into.signals[s - 1].receivers;
            signal.first_value = v;
            for (ValueName& each : into.names_of(signal)) {
                in.numbers(each.value);
                in.texts(each.name);
            }
            v += signal.values;
        }
        for (SignalRow& each : into.of(message))
            if (each.selected_by != no_such)
                each.shape.multiplexor = into.signals[each.selected_by].shape.name;
        ++m;
    }
}

} // namespace tappet::can::dbc
