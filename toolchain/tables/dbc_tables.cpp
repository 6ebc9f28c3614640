// Writes the rows of a DBC file as numbers and texts, which FieldReader reads in the compiler.
#include "toolchain/tables/dbc_tables.hpp"

#include "drivers/can/dbc/texts.hpp"
#include "drivers/can/dbc/value_rows.hpp"
#include "toolchain/tables/cpp_literal.hpp"

#include <map>

namespace tappet::tables {

using namespace can;
using namespace can::dbc;

namespace {

std::string utf8_of(std::string_view text) {
    std::string all;
    put_as_utf8(text, [&](std::string_view piece) { all += piece; });
    return all;
}

/// Writes what FieldReader reads.
class FieldWriter {
public:
    FieldWriter(std::string& rows, const std::vector<Trouble>& troubles) : rows_{rows}, troubles_{troubles} {}

    template <class... Numbers> void numbers(const Numbers&... from) { (number(from), ...); }
    template <class... Flags> void flags(const Flags&... from) {
        std::uint64_t bits = 0;
        unsigned i = 0;
        ((bits |= std::uint64_t{from} << i++), ...);
        number(bits);
    }
    template <class... Reals> void reals(const Reals&... from) {
        (number(std::byteswap(std::bit_cast<std::uint64_t>(from))), ...); // 0.5 has fewer digits then
    }
    template <class... Texts> void texts(const Texts&... from) {
        ((number(from.size()), rows_ += from), ...);
    }
    void list(const NodeList& from) {
        number(from.at);
        if (from.at != 0) texts(from.names);
    }
    void trouble(std::size_t from) {
        if (from == no_such) return number(0);
        number(troubles_[from].at + 1);
        texts(troubles_[from].text.view());
        ++told;
    }

    std::uint32_t told = 0;

private:
    void number(Duration from) { number(from.count()); }
    template <class Number> void number(Number from) {
        rows_ += std::to_string(static_cast<std::uint64_t>(from)) + ' ';
    }

    std::string& rows_;
    const std::vector<Trouble>& troubles_;
};

bool has_good_names(Network& network, const SignalRow& signal) {
    const auto names = network.rows().names_of(signal);
    for (std::size_t i = 0; i < names.size(); ++i)
        if (!name_trouble(signal.shape, names, i).empty()) return false;
    return true;
}

} // namespace

OwnTable::OwnTable(Network network) : fault_{network.fault} {
    for (std::size_t from = 0; from <= network.text.size();) {
        const std::size_t end = std::min(network.text.find('\n', from), network.text.size());
        lines_ += std::to_string(end + 1 - from) + ' ';
        from = end + 1;
    }
    if (fault_.empty()) {
        for (MessageRow& each : network.messages)
            if (!each.is_independent) write(network, each);
        std::ranges::sort(names_, {}, &NameEntry::hash);
        write_nodes(network);
    }
    const NodeList nodes = network.nodes.names.empty() ? NodeList{} : network.nodes;
    table = {network.file,
             fault_.view(),
             nodes,
             lines_.c_str(),
             {messages_.data(), messages_.size()},
             {names_.data(), names_.size()},
             {nodes_.data(), nodes_.size()},
             {mentions_.data(), mentions_.size()}};
}

void OwnTable::write(Network& network, MessageRow& message) {
    std::string& fields = rows_.emplace_back();
    FieldWriter out{fields, network.troubles};
    MessageEntry entry{.signals = static_cast<std::uint32_t>(message.signals)};
    pass_message(out, message);
    std::string_view last{};
    for (SignalRow row : network.of(message)) {
        const auto names = network.rows().names_of(row);
        std::string unit;
        put_unit(row.shape.unit, [&](std::string_view piece) { unit += piece; });
        row.shape.unit = unit;
        row.selected_by = row.selected_by == no_such ? 0 : row.selected_by - message.first + 1;
        row.has_good_names = has_good_names(network, row);
        const bool is_same = last.data() != nullptr && row.receivers.names == last;
        last = row.receivers.names;
        if (last.data() == nullptr) last = "";
        row.receivers.at = is_same ? 0 : std::max<std::size_t>(row.receivers.at, 1);
        pass_signal(out, row);
        for (const ValueName& each : names) {
            out.numbers(each.value);
            out.texts(utf8_of(each.name));
        }
        entry.values += static_cast<std::uint32_t>(row.values);
    }
    entry.troubles = out.told;
    entry.row = fields.c_str();
    names_.push_back({hash_of(message.name), static_cast<std::uint32_t>(messages_.size())});
    messages_.push_back(entry);
}

void OwnTable::write_nodes(Network& network) {
    std::map<std::string_view, std::size_t> index;
    std::vector<std::vector<std::uint32_t>> messages;
    const auto entry = [&](std::string_view name) {
        const auto [found, is_new] = index.try_emplace(name, nodes_.size());
        if (is_new) nodes_.push_back({.name = name, .hash = hash_of(name)}), messages.emplace_back();
        return found->second;
    };
    for_each_name(network.nodes.names, [&](std::string_view name) { nodes_[entry(name)].is_listed = true; });
    std::uint32_t m = 0;
    for (MessageRow& message : network.messages) {
        const auto mention = [&](std::string_view list) {
            for_each_name(list, [&](std::string_view name) {
                auto& all = messages[entry(name)];
                if (!message.is_independent && (all.empty() || all.back() != m)) all.push_back(m);
            });
        };
        mention(message.sender.names);
        if (!message.sender.names.empty()) nodes_[entry(message.sender.names)].is_sender = true;
        mention(message.more_senders.names);
        for (const SignalRow& each : network.of(message)) mention(each.receivers.names);
        m += message.is_independent ? 0 : 1;
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        nodes_[i].first = static_cast<std::uint32_t>(mentions_.size());
        nodes_[i].messages = static_cast<std::uint32_t>(messages[i].size());
        mentions_.insert(mentions_.end(), messages[i].begin(), messages[i].end());
    }
}

std::string to_cpp(const Table& table, std::string_view name) {
    const std::string own{name};
    const auto numbers = [](std::initializer_list<std::uint32_t> all) {
        std::string text;
        for (const std::uint32_t each : all) text += ", " + std::to_string(each);
        return text;
    };
    std::string text, slices;
    // An array without elements is none.
    const auto array = [&](std::string_view type, std::string_view part, const auto& rows,
                           const auto& row_of) {
        slices += ",\n    {";
        if (rows.size() != 0) {
            const std::string array_name = own + "_" + std::string{part};
            text += "inline constexpr " + std::string{type} + " " + array_name + "[]{\n";
            for (const auto& each : rows) text += "    " + row_of(each) + ",\n";
            text += "};\n";
            slices += array_name + ", " + std::to_string(rows.size());
        }
        slices += "}";
    };
    array("can::dbc::MessageEntry", "messages", table.messages, [&](const MessageEntry& each) {
        return "{" + cpp_literal(each.row) + numbers({each.signals, each.values, each.troubles}) + "}";
    });
    array("can::dbc::NameEntry", "names", table.names, [&](const NameEntry& each) {
        return "{" + std::to_string(each.hash) + numbers({each.message}) + "}";
    });
    array("can::dbc::NodeEntry", "nodes", table.node_entries, [&](const NodeEntry& each) {
        return "{" + cpp_literal(each.name) +
               numbers({each.hash, each.is_listed, each.is_sender, each.first, each.messages}) + "}";
    });
    array("std::uint32_t", "mentions", table.mentions,
          [](const std::uint32_t each) { return std::to_string(each); });
    return text + "inline constexpr can::dbc::Table " + own + "{" + cpp_literal(table.file) + ",\n    " +
           cpp_literal(table.fault) + ",\n    {" + cpp_literal(table.nodes.names) + ", " +
           std::to_string(table.nodes.at) + "},\n    " + cpp_literal(table.lines) + slices + "};\n";
}

} // namespace tappet::tables
