// Checks all messages of a DBC file, whoever takes them.
#include "drivers/can/dbc/network.hpp"
#include "drivers/can/dbc/value_rows.hpp"
#include "toolchain/tools/check/check.hpp"

#include <algorithm>

namespace tappet::checking {

namespace {

using can::dbc::MessageRow;
using can::dbc::SignalRow;
using can::dbc::Trouble;

class DbcCheck {
public:
    explicit DbcCheck(std::string_view text) : net_{can::dbc::read("", text)} {
        for (const MessageRow& message : net_.messages)
            if (net_.fault.empty() && !message.is_independent) check(message);
    }
    [[nodiscard]] std::vector<Finding> findings() {
        std::ranges::sort(net_.troubles, [](const Trouble& a, const Trouble& b) {
            return a.at != b.at ? a.at < b.at : a.text.view() < b.text.view();
        });
        std::vector<Finding> found;
        for (const Trouble& each : net_.troubles) {
            Finding one{net_.line_of(each.at), Weight::note, std::string{each.text.view()},
                        affected_by(each)};
            if (each.weight != can::dbc::Weight::note && !one.affects.empty()) one.weight = Weight::fault;
            const auto same = std::ranges::find_if(found, [&](const Finding& before) {
                return before.meaning == one.meaning && before.weight == one.weight &&
                       before.affects == one.affects;
            });
            if (same == found.end())
                found.push_back(std::move(one));
            else
                ++same->more;
        }
        if (!net_.fault.empty()) found.push_back(fatal());
        return found;
    }

private:
    /// "file:line:column: sentence"; the name of the file is empty.
    [[nodiscard]] Finding fatal() const {
        const std::string text{net_.fault.view()};
        const std::size_t meaning = text.find(": ") + 2;
        return {
            static_cast<unsigned>(std::stoul(text.substr(1))), Weight::unreadable, text.substr(meaning), {}};
    }
    static void add(std::vector<std::string>& nodes, std::string_view list) {
        can::dbc::for_each_name(list, [&](std::string_view node) {
            // The rest of an unreadable line may have numbers.
            if (node != can::dbc::nobody && !is_digit(node[0]) &&
                std::ranges::find(nodes, node) == nodes.end())
                nodes.emplace_back(node);
        });
    }
    /// The nodes that send or receive the row; a signal's limits concern its senders only.
    [[nodiscard]] std::vector<std::string> affected_by(const Trouble& trouble) {
        std::vector<std::string> nodes;
        if (trouble.weight == can::dbc::Weight::note || trouble.message == no_such) return nodes;
        const MessageRow& message = net_.messages[trouble.message];
        add(nodes, message.sender.names);
        add(nodes, message.more_senders.names);
        if (trouble.weight == can::dbc::Weight::limits) return nodes;
        for (const SignalRow& each : net_.of(message))
            if (trouble.signal == no_such || &each == &net_.signals[trouble.signal])
                add(nodes, each.receivers.names);
        return nodes;
    }

    void tell(can::dbc::Weight weight, const MessageRow& message, const SignalRow* signal,
              const Sentence& what) {
        if (what.empty()) return;
        const auto m = static_cast<std::size_t>(&message - net_.messages.data());
        const auto s = signal == nullptr ? no_such : static_cast<std::size_t>(signal - net_.signals.data());
        net_.troubles.push_back({signal == nullptr ? message.at : signal->at, weight, m, s, what});
    }
    /// Checks what the map checks, for each signal that reads well.
    void check(const MessageRow& message) {
        constexpr auto fault = can::dbc::Weight::fault;
        can::FrameRow frame;
        frame.name = message.name;
        frame.length = static_cast<std::uint8_t>(std::min<std::size_t>(message.length, 255));
        if (*message.is_fd) frame.format = can::Format::flexible;
        if (message.length > 64)
            tell(fault, message, nullptr,
                 Sentence{"message \"", message.name, "\" has ", std::size_t{message.length},
                          " bytes, which no frame holds, only a transport protocol"});
        else
            tell(fault, message, nullptr, can::detail::length_fault(frame).text);
        tell(fault, message, nullptr, can::detail::facet_fault(frame));
        std::vector<can::Signal> all;
        std::vector<std::size_t> multiplexors;
        for (SignalRow& each : net_.of(message)) {
            all.push_back(each.shape);
            multiplexors.push_back(each.selected_by == no_such ? no_such : each.selected_by - message.first);
            if (each.names_at == no_such) continue;
            keep_good_names(net_.rows(), each, [&](const can::ValueName& name, std::string_view why) {
                tell(can::dbc::Weight::note, message, &each,
                     Sentence{"signal \"", each.shape.name, "\" names the value ", name.value, ", ", why});
                net_.troubles.back().at = each.names_at;
            });
        }
        if (message.length <= 64) check(message, frame, {all, multiplexors});
    }
    void check(const MessageRow& message, const can::FrameRow& frame, const can::Multiplexing& among) {
        const auto rows = net_.of(message);
        std::vector<std::size_t> inside; // signals that lie in their frame
        std::vector<can::detail::Covered> covered;
        for (std::size_t s = 0; s < rows.size(); ++s) {
            if (rows[s].trouble != no_such) continue;
            const auto is_told = [&](const Sentence& fault) {
                tell(can::dbc::Weight::fault, message, &rows[s], fault);
                return !fault.empty();
            };
            const can::Signal& signal = among.signals[s];
            is_told(can::detail::facet_fault(frame, signal));
            if (is_told(can::detail::layout_fault(frame, signal).text)) continue;
            if (const std::size_t m = among.multiplexor_of[s]; m != no_such)
                is_told(can::detail::multiplexor_fault(frame, signal, among.signals.subspan(m, 1)).text);
            const can::detail::Covered own = can::detail::covered_by(signal);
            for (std::size_t i = 0; i < inside.size(); ++i) {
                const unsigned shared = can::detail::first_shared(own, covered[i], frame.length);
                if (shared < 8u * frame.length && !among.exclude_each_other(s, inside[i]))
                    is_told(Sentence{"signal \"", message.name, ".", signal.name, "\" overlaps \"",
                                     among.signals[inside[i]].name, "\" at bit ", shared});
            }
            inside.push_back(s);
            covered.push_back(own);
        }
    }

    can::dbc::Network net_;
};

} // namespace

std::vector<Finding> check_dbc(std::string_view text) { return DbcCheck{text}.findings(); }

} // namespace tappet::checking
