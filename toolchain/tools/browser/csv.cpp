// Writes messages with the same time on one line, unless a channel has several.
#include "toolchain/tools/browser/csv.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace tappet::browser {

namespace {

std::string in_cell(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string{text};
    std::string cell = "\"";
    for (const char character : text) cell.append(character == '"' ? 2 : 1, character);
    return cell + "\"";
}

std::string cell_of(const mcap::Message& message) {
    const auto json = nlohmann::ordered_json::parse(message.data, nullptr, false);
    if (json.is_discarded()) return in_cell(message.data); // another program's channel: unchanged
    const auto& value = json.is_object() && json.size() == 1 && json.contains("value") ? json["value"] : json;
    if (value.is_null()) return {};
    return in_cell(value.is_string() ? value.get<std::string>() : value.dump());
}

std::string seconds(std::uint64_t ns) {
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "%llu.%09llu",
                  static_cast<unsigned long long>(ns / 1'000'000'000),
                  static_cast<unsigned long long>(ns % 1'000'000'000));
    return text.data();
}

} // namespace

std::string as_csv(const mcap::Contents& recording) {
    std::string text = "time_s";
    std::map<std::uint16_t, std::size_t> column;
    for (const mcap::Channel& each : recording.channels) {
        column[each.id] = column.size();
        text += "," + in_cell(each.topic);
    }
    text += "\r\n";
    std::vector<const mcap::Message*> messages;
    for (const mcap::Message& each : recording.messages) messages.push_back(&each);
    // Samples from before an event stand behind it in the file. Equal times keep the file's order.
    std::ranges::sort(messages, {}, [](const mcap::Message* each) { return std::pair{each->log_ns, each}; });
    std::vector<std::string> cells(column.size());
    std::vector<bool> used(column.size());
    const auto end_line = [&](std::uint64_t ns) {
        text += seconds(ns);
        for (std::string& cell : cells) {
            text += "," + cell;
            cell.clear();
        }
        text += "\r\n";
        used.assign(used.size(), false);
    };
    for (std::size_t i = 0; i < messages.size(); ++i) {
        const std::size_t at = column[messages[i]->channel];
        if (used[at] || (i > 0 && messages[i]->log_ns != messages[i - 1]->log_ns))
            end_line(messages[i - 1]->log_ns);
        cells[at] = cell_of(*messages[i]);
        used[at] = true;
    }
    if (!messages.empty()) end_line(messages.back()->log_ns);
    return text;
}

} // namespace tappet::browser
