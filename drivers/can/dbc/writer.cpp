// Writes the statements of a DBC file in the order of CANdb++.
#include "drivers/can/dbc/writer.hpp"

#include "drivers/can/dbc/scanner.hpp"
#include "drivers/can/dbc/texts.hpp"
#include "kernel/base/real_text.hpp"

#include <algorithm>

namespace tappet::can::dbc {

namespace {

std::string real(double value) {
    char text[max_real_text];
    return {text, write_shortest(text, value)};
}
std::string whole(auto value) { return std::to_string(value); }

std::string name(std::string_view from) {
    std::string name{from};
    for (char& each : name)
        if (!is_word_character(each)) each = '_';
    if (name.empty() || is_digit(name[0])) name.insert(0, "_");
    return name;
}

/// Returns the code page 1252 byte for the UTF-8 character at the beginning.
char byte_of(std::string_view character) {
    if (character.size() == 1) return character[0];
    for (unsigned byte = 0x80; byte < 0x100; ++byte) {
        char utf8[4] = {};
        const std::size_t bytes = put_utf8(code_point_of(static_cast<std::uint8_t>(byte)), utf8);
        if (std::string_view{utf8, bytes} == character) return static_cast<char>(byte);
    }
    return '?';
}
std::string quoted(std::string_view text) {
    std::string out = "\"";
    while (!text.empty()) {
        const std::size_t bytes = std::max<std::size_t>(utf8_length(text), 1);
        if (text[0] == '"') out += '\\';
        out += text[0] == '\n' ? ' ' : byte_of(text.substr(0, bytes));
        text.remove_prefix(bytes);
    }
    return out + "\"";
}

/// In a file with CAN FD frames each message states its format.
const std::string fd_definitions =
    "BA_DEF_ \"BusType\" STRING ;\nBA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\"," +
    [] {
        std::string reserved;
        for (int i = 2; i < 14; ++i) reserved += "\"reserved\",";
        return reserved;
    }() +
    "\"StandardCAN_FD\",\"ExtendedCAN_FD\";\nBA_DEF_ BO_ \"CANFD_BRS\" ENUM \"0\",\"1\";\n";
const std::string fd_defaults =
    "BA_DEF_DEF_ \"BusType\" \"\";\nBA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\n"
    "BA_DEF_DEF_ \"CANFD_BRS\" \"1\";\nBA_ \"BusType\" \"CAN FD\";\n";

class Writer {
public:
    Writer(std::string_view machine, std::span<const Signal> signals)
        : machine_{name(machine)}, signals_{signals} {}

    void add(const FrameRow& frame) {
        const bool sent = frame.direction == Direction::transmit;
        const std::string id = whole(frame.identifier.id | (frame.identifier.extended ? 0x8000'0000u : 0u));
        messages_ += "BO_ " + id + ' ' + name(frame.name) + ": " + whole(unsigned{frame.length}) + ' ' +
                     (sent ? machine_ : "others") + '\n';
        const auto own = signals_.subspan(frame.first, frame.values);
        for (const Signal& signal : own) add(signal, own, id, sent ? "others" : machine_);
        messages_ += '\n';
        if (frame.format != Format::classical) {
            has_fd_ = true;
            formats_ += "BA_ \"VFrameFormat\" BO_ " + id + (frame.identifier.extended ? " 15;\n" : " 14;\n");
            formats_ +=
                "BA_ \"CANFD_BRS\" BO_ " + id + (frame.format == Format::flexible_faster ? " 1;\n" : " 0;\n");
        } else if (frame.identifier.extended) {
            formats_ += "BA_ \"VFrameFormat\" BO_ " + id + " 1;\n";
        }
        if (frame.every > Duration::zero())
            periods_ += "BA_ \"GenMsgCycleTime\" BO_ " + id + ' ' +
                        real(static_cast<double>(frame.every.count()) / 1e6) + ";\n";
    }
    [[nodiscard]] std::string text() const {
        return "VERSION \"\"\n\nNS_ "
               ":\n\tBA_\n\tBA_DEF_\n\tBA_DEF_DEF_\n\tVAL_\n\tSIG_VALTYPE_\n\tSG_MUL_VAL_\n\nBS_:\n\nBU_: " +
               machine_ + " others\n\n" + messages_ + "BA_DEF_ BO_ \"GenMsgCycleTime\" FLOAT 0 3600000;\n" +
               (has_fd_ ? fd_definitions : "") + "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n" +
               (has_fd_ ? fd_defaults + formats_ : "") + periods_ + values_ + types_ + selections_;
    }

private:
    void add(const Signal& signal, std::span<const Signal> own, const std::string& id,
             const std::string& receiver) {
        const std::string who = name(signal.name);
        const bool selects =
            std::ranges::any_of(own, [&](const Signal& each) { return each.multiplexor == signal.name; });
        std::string page;
        if (!signal.multiplexor.empty()) page = "m" + whole(signal.selections[0].from);
        if (selects) page += 'M';
        const bool is_unsigned = signal.kind == Kind::unsigned_integer;
        messages_ += " SG_ " + who + (page.empty() ? "" : " " + page) + " : " + whole(signal.start) + '|' +
                     whole(unsigned{signal.bits}) + (signal.order == Order::intel ? "@1" : "@0") +
                     (is_unsigned ? "+" : "-") + " (" + real(signal.factor) + ',' + real(signal.offset) +
                     ") [" + (signal.has_range ? real(signal.least) : "0") + '|' +
                     (signal.has_range ? real(signal.most) : "0") + "] " + quoted(signal.unit) + ' ' +
                     receiver + '\n';
        if (!signal.names.empty()) {
            values_ += "VAL_ " + id + ' ' + who;
            for (const ValueName& each : signal.names)
                values_ += ' ' + whole(each.value) + ' ' + quoted(each.name);
            values_ += " ;\n";
        }
        if (signal.kind == Kind::float32 || signal.kind == Kind::float64)
            types_ +=
                "SIG_VALTYPE_ " + id + ' ' + who + (signal.kind == Kind::float32 ? " : 1;\n" : " : 2;\n");
        if (signal.multiplexor.empty()) return;
        selections_ += "SG_MUL_VAL_ " + id + ' ' + who + ' ' + name(signal.multiplexor);
        for (std::size_t i = 0; i < signal.selections.size(); ++i)
            selections_ += (i == 0 ? " " : ", ") + whole(signal.selections[i].from) + '-' +
                           whole(signal.selections[i].to);
        selections_ += ";\n";
    }

    std::string machine_;
    std::span<const Signal> signals_;
    bool has_fd_ = false;
    std::string messages_, formats_, periods_, values_, types_, selections_;
};

} // namespace

std::string to_dbc(std::string_view machine, std::span<const FrameRow> frames,
                   std::span<const Signal> signals) {
    Writer writer{machine, signals};
    // Two frames with the same identifier become one message.
    for (auto frame = frames.begin(); frame != frames.end(); ++frame)
        if (std::find_if(frames.begin(), frame, [&](const FrameRow& before) {
                return before.identifier == frame->identifier;
            }) == frame)
            writer.add(*frame);
    return writer.text();
}

} // namespace tappet::can::dbc
