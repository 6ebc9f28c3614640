// A DBC file with one character deleted, for each character: the map is the same, or it is refused, or only
// texts differ, which whoever uses them notices. Characters of numbers are left alone: nothing else in the
// file says which number is right.
#include "tests/drivers/can/dbc_generator.hpp"
#include "tests/drivers/can/dbc_on_host.hpp"

#include <gtest/gtest.h>

#include <map>
#include <memory>

namespace tappet::can {
namespace {

/// A map in two halves: what is on the wire, and the texts.
struct Written {
    std::string wire{}, texts{}, fault{};
};

std::string number(double value) {
    char digits[40] = {};
    std::snprintf(digits, sizeof digits, "%.17g ", value);
    return digits;
}
template <class... Numbers> std::string numbers(const Numbers&... all) {
    return (number(static_cast<double>(all)) + ... + std::string{});
}

Written map_of(const std::string& text, std::span<const FrameRow> rows) {
    const auto read = std::make_unique<DbcMap>(text, NodeView{"us", rows, {}});
    const auto& map = read->map;
    Written written{.fault = std::string{map.fault.view()}};
    for (std::size_t f = 0; f < read->sizes.frames && written.fault.empty(); ++f) {
        const FrameRow& frame = map.frames[f];
        written.wire += "\n" + numbers(frame.identifier.id, frame.identifier.extended, frame.direction,
                                       frame.length, frame.format, frame.every.count(), frame.apart.count());
        written.texts += std::string{frame.name} + "\n";
        for (std::size_t s = frame.first; s < frame.end(); ++s) {
            const Signal& signal = map.signals[s];
            written.wire += "\n " + numbers(signal.start, signal.bits, signal.order, signal.kind,
                                            signal.factor, signal.offset, signal.has_range, signal.least,
                                            signal.most, static_cast<double>(map.multiplexor_of[s]));
            for (const Selection& each : signal.selections) written.wire += numbers(each.from, each.to);
            written.texts += std::string{signal.name} + " " + std::string{signal.unit};
            for (const ValueName& each : signal.names)
                written.texts += " " + std::to_string(each.value) + std::string{each.name};
            written.texts += "\n";
        }
    }
    return written;
}

/// The statement, and the number of the field, in which a character is.
std::string place_of(const std::string& text, std::size_t at) {
    std::size_t from = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
    from = std::min(text.find_first_not_of(" \t", from), at);
    const std::string before = text.substr(from, at - from);
    const auto blanks = std::ranges::count(before, ' ');
    return text.substr(from, text.find_first_of(" \n", from) - from) + " " + std::to_string(blanks);
}
/// In these places texts may differ: names, units, values' names and receivers that are no nodes.
bool is_text(const std::string& place) {
    return place.starts_with("BO_ 2") || place.starts_with("SG_ ") || place.starts_with("VAL_ ");
}

/// Returns whether the character may be of a number: "1.5", "-3E-05".
bool is_of_number(const std::string& text, std::size_t i) {
    const char c = text[i];
    const bool is_exponent = (c == 'E' || c == 'e') && i != 0 && is_digit(text[i - 1]);
    return is_digit(c) || c == '-' || c == '+' || c == '.' || is_exponent;
}

struct Counts {
    std::size_t equal = 0, refused = 0, other_texts = 0, selections_in_names = 0;
};

Counts damage(const std::string& text, std::span<const FrameRow> rows) {
    const Written plain = map_of(text, rows);
    EXPECT_EQ(plain.fault, "");
    EXPECT_NE(plain.wire, "");
    Counts counts;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (is_of_number(text, i)) continue;
        std::string damaged = text;
        damaged.erase(i, 1);
        const Written read = map_of(damaged, rows);
        const auto line = [&] {
            const std::size_t from = i == 0 ? 0 : text.rfind('\n', i - 1) + 1;
            return place_of(text, i) + ", without '" + text[i] +
                   "': " + text.substr(from, text.find('\n', i) - from);
        };
        if (!read.fault.empty()) {
            ++counts.refused;
        } else if (read.wire != plain.wire) {
            // "name m1" becomes a name like any other; whoever uses the signal by its name notices.
            EXPECT_TRUE(place_of(text, i) == "SG_ 1" && text[i] == ' ' && text[i + 1] == 'm') << line();
            EXPECT_NE(read.texts, plain.texts) << line();
            ++counts.selections_in_names;
        } else if (read.texts != plain.texts) {
            EXPECT_TRUE(is_text(place_of(text, i))) << line();
            ++counts.other_texts;
        } else {
            ++counts.equal;
        }
    }
    return counts;
}

TEST(DbcDamage, of_one_character_changes_no_frame) {
    Counts all;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        DbcGenerator generator{seed};
        const std::string text = generator.file();
        std::vector<FrameRow> rows;
        for (const std::string& each : generator.own) rows.push_back(transmit(each).safe_by_silence().row);
        const Counts one = damage(text, rows);
        all.equal += one.equal;
        all.refused += one.refused;
        all.other_texts += one.other_texts;
        all.selections_in_names += one.selections_in_names;
    }
    EXPECT_GT(all.equal, 300u); // comments, foreign messages, blanks
    EXPECT_GT(all.refused, 2000u);
    EXPECT_GT(all.other_texts, 200u);
    EXPECT_LT(all.selections_in_names, 40u);
}

TEST(DbcDamage, of_one_character_changes_no_rate_and_no_format) {
    std::string text =
        "VERSION \"\"\nBU_: us them\nBO_ 1 Command: 8 us\n SG_ a : 0|8@1+ (1,0) [0|0] \"\" them\n"
        "BO_ 2 Event: 8 them\n SG_ b : 0|32@1- (1,0) [0|0] \"\" us\n"
        "BO_ 3 Fast: 8 them\n SG_ c : 0|8@0- (2.5,-1) [-9|9] \"\" us,them\n"
        "BO_ 4 Slow: 8 them\n SG_ d : 7|8@0- (2.5,-1) [-9|9] \"\" them,us\n"
        "BA_DEF_ BO_ \"GenMsgSendType\" ENUM \"Cyclic\",\"Spontaneous\",\"cyclicIfActive\";\n"
        "BA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"StandardCAN_FD\",\"reserved\";\n"
        "BA_DEF_ BO_ \"CANFD_BRS\" ENUM \"0\",\"1\";\n"
        "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\n"
        "BA_DEF_DEF_ \"GenMsgSendType\" \"Cyclic\";\nBA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\n"
        "BA_DEF_DEF_ \"CANFD_BRS\" \"1\";\nBA_DEF_DEF_ \"GenMsgCycleTime\" 50;\n"
        "BA_ \"GenMsgCycleTime\" BO_ 1 20;\nBA_ \"GenMsgCycleTime\" BO_ 3 30;\n"
        "BA_ \"GenMsgSendType\" BO_ 2 1;\nBA_ \"VFrameFormat\" BO_ 3 1;\n"
        "BA_ \"VFrameFormat\" BO_ 4 \"StandardCAN_FD\";\nBA_ \"CANFD_BRS\" BO_ 4 \"0\";\n"
        "SIG_VALTYPE_ 2 b : 1;\nBO_TX_BU_ 1 : us,them;\nCM_ BO_ 1 \"of two\nlines\";\n";
    const FrameRow rows[] = {transmit("Command").safe_by_silence().row,
                             receive("Event", on_demand(20ms)).row};
    const Counts counts = damage(text, rows);
    EXPECT_EQ(counts.selections_in_names, 0u);
    EXPECT_GT(counts.refused, 400u);
}

} // namespace
} // namespace tappet::can
