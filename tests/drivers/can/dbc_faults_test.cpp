// Every fault of a DBC file and of its rows: one sentence, with line and column.
#include "tests/drivers/can/dbc_on_host.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

constexpr auto us = node("us", transmit("ours", signal("a").safe(0)));

std::string fault(const std::string& text, const NodeView& node = us.view()) {
    return std::string{DbcMap{text, node}.map.fault.view()};
}

/// Line 1: a cycle time and nodes, 2: a foreign message, 3 and 4: its signals, 5: our message, 6: its signal;
/// then the text under test.
std::string with(const std::string& added) {
    return "BA_DEF_DEF_ \"GenMsgCycleTime\" 20; BU_: us them\n"
           "BO_ 1 theirs: 8 them\n"
           " SG_ a : 0|8@1+ (1,0) [0|0] \"\" us\n"
           " SG_ b : 8|8@1+ (1,0) [0|0] \"\" us\n"
           "BO_ 2 ours: 8 us\n"
           " SG_ a : 0|8@1+ (1,0) [0|0] \"\" them\n" +
           added;
}
std::string with_signal(const std::string& signal) {
    return with("BO_ 3 more: 4 them\n SG_ " + signal + "\n");
}

TEST(DbcFaults, name_invalid_message_formats) {
    EXPECT_EQ(fault(with("BA_ \"VFrameFormat\" BO_ 2 99;")),
              "t.dbc:7:26: 99 is too large for the number of the attribute's value, which is 63 at most; "
              "correct it");
    EXPECT_EQ(fault(with("BA_ \"CANFD_BRS\" BO_ 2 yes;")),
              "t.dbc:7:23: found \"yes;\", expected the number of the attribute's value; correct it");
    EXPECT_EQ(fault(with("BA_DEF_ BO_ \"VFrameFormat\" ENUM \"a\" \"b\";")),
              "t.dbc:7:37: a text is unclosed or out of place, expected \";\", the end of the "
              "statement; close the quotes in the same line");
    EXPECT_EQ(
        fault(with(
            "BA_DEF_ BO_ \"VFrameFormat\" INT 0 15;\nBA_DEF_ BU_ \"x\" STRING ;\nBA_DEF_ \"y\" INT 0 1;")),
        "");
    EXPECT_EQ(
        fault(with("BO_ 3 more: 13 them\n SG_ c : 0|8@1+ (1,0) [0|0] \"\" us\n"
                   "BA_ \"VFrameFormat\" BO_ 3 14;")),
        "t.dbc:7:7: frame \"more\" has 13 bytes: CAN FD has no such length; make it 16, and what no signal "
        "covers is padding");
    EXPECT_EQ(fault(with("BO_ 3 more: 64 them\n SG_ c : 504|8@1+ (1,0) [0|0] \"\" us\n"
                         "BA_ \"VFrameFormat\" BO_ 3 14;\nBA_ \"GenMsgCycleTime\" BO_ 3 20;")),
              "");
}

TEST(DbcFaults, are_not_reported_in_a_valid_file) {
    EXPECT_EQ(fault(with("")), "");
    EXPECT_EQ(fault(with_signal("c : 0|32@1- (1E-3,-.5) [-1e+3|1000.0] \"mm/s\" us, them")), "");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,0) [0|0] \"\"")), "") << "nobody receives it";
    EXPECT_EQ(fault("BU_:\n", node("").view()), "");
    EXPECT_EQ(fault("", node("").view()), "");
}

TEST(DbcFaults, name_unexpected_words) {
    EXPECT_EQ(fault(with("BOO_ 3 x: 8 them")), "t.dbc:7:1: found \"BOO_\", expected a statement, which "
                                               "begins with BO_, SG_, VAL_ or the like; correct it");
    EXPECT_EQ(fault(with("BO_ x")), "t.dbc:7:5: found \"x\", expected a message's identifier; correct it");
    EXPECT_EQ(fault(with("BO_ 3")), "t.dbc:7:6: the file ends, expected a message's name; is it whole?");
    EXPECT_EQ(fault(with("BO_ 3 x 8 them")),
              "t.dbc:7:9: found \"8\", expected \":\" after the message's name; correct it");
    EXPECT_EQ(fault(with_signal("c 0|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:8: found \"0|8@1+\", expected \":\" after the signal's name; correct it");
    EXPECT_EQ(fault(with_signal("c : 0|8@2+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:14: 2 is too large for the byte order, 0 (Motorola) or 1 (Intel), which is 1 at most; "
              "correct it");
    EXPECT_EQ(fault(with_signal("c : 0|8@1 (1,0) [0|0] \"\" us")),
              "t.dbc:8:16: found \"(1,0)\", expected \"+\" (unsigned) or \"-\" (signed); correct it");
    EXPECT_EQ(fault(with_signal("c k0 : 0|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:8: found \"k0\", expected \":\" or M, m0 or m0M of a multiplexed signal; correct it");
    EXPECT_EQ(fault(" SG_ c : 0|8@1+ (1,0) [0|0] \"\" us"),
              "t.dbc:1:6: a signal without a message; write BO_ before it");
    EXPECT_EQ(fault(with("CM_ \"x\";\n SG_ c : 16|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:6: signal \"c\" is not in its message; put it under its BO_");
    EXPECT_EQ(fault(with("BO_ 3 x: 8 them SG_ c : 16|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:7:21: SG_ is in the middle of a line; begin a new one");
    EXPECT_EQ(fault(with("BU_: us")), "t.dbc:7:1: BU_ is there twice; put all nodes into one");
}

TEST(DbcFaults, name_invalid_numbers) {
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1.2.3,0) [0|0] \"\" us")),
              "t.dbc:8:18: found \"1.2.3,0)\", expected the factor; correct it");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,1e999) [0|0] \"\" us")),
              "t.dbc:8:20: found \"1e999)\", expected the offset; correct it");
    EXPECT_EQ(
        fault(with_signal("c : 0|65@1+ (1,0) [0|0] \"\" us")),
        "t.dbc:8:12: 65 is too large for the number of the signal's bits, which is 64 at most; correct it");
    EXPECT_EQ(fault(with_signal("c : 0|0@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:12: signal \"c\" has 0 bits; give it 1 to 64");
    EXPECT_EQ(fault(with_signal("c : 99999999999999999999|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:10: found \"99999999999999999999|8@1\", expected the signal's first bit; correct it");
    EXPECT_EQ(fault(with("BO_ 2048 more: 8 them")), "t.dbc:7:5: message \"more\" has the identifier 2048: a "
                                                    "standard one ends at 2047, an extended one has bit 31 "
                                                    "set and 29 bits; correct it");
    EXPECT_EQ(fault(with("BA_ \"GenMsgCycleTime\" BO_ 1 -5;")),
              "t.dbc:7:29: a cycle time of -5 ms; correct it");
    EXPECT_EQ(
        fault(with_signal("c : 0|8@1+ (0,0) [0|0] \"\" us")),
        "t.dbc:8:6: signal \"more.c\" has the factor 0: every value would be the offset; give it another");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,0) [5|2] \"\" us")),
              "t.dbc:8:6: signal \"more.c\" has an empty range: put the lower bound first");
}

TEST(DbcFaults, name_unclosed_texts) {
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,0) [0|0] \"mm us\n")),
              "t.dbc:8:29: a text is unclosed or out of place, expected the unit between "
              "quotes; close "
              "the quotes in the same line");
    EXPECT_EQ(fault(with("CM_ \"never ends;\n")), "t.dbc:7:5: a text is unclosed; close its quotes");
    EXPECT_EQ(fault(with("VAL_ 1 a 0 \"off\" 1 on ;")),
              "t.dbc:7:20: found \"on\", expected the value's name between quotes; correct it");
    EXPECT_EQ(fault(with("VAL_ 1 a 0 \"off\"\n")),
              "t.dbc:8:1: the file ends, expected a value and its name, or \";\"; is it whole?");
    EXPECT_EQ(fault(with("BA_DEF_ \"x\" INT 0 1")),
              "t.dbc:7:20: the file ends, expected \";\", the end of a statement; is it whole?");
}

TEST(DbcFaults, name_unknown_and_duplicate_names) {
    EXPECT_EQ(fault(with("BO_ 3 more: 8 then")),
              "t.dbc:7:15: BU_ names no node \"then\"; did you mean \"them\"?");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,0) [0|0] \"\" us,robot")),
              "t.dbc:8:35: BU_ names no node \"robot\"; add it there");
    EXPECT_EQ(fault(with(""), node("uss").view()),
              "t.dbc:1:40: BU_ names no node \"uss\"; did you mean \"us\"?");
    EXPECT_EQ(fault(with("BO_ 1 more: 8 them")),
              "t.dbc:7:5: message \"more\" has the identifier of \"theirs\"; give it its own");
    EXPECT_EQ(fault(with("BO_ 3 theirs: 8 them")),
              "t.dbc:7:7: message \"theirs\" is there twice; rename one of them");
    EXPECT_EQ(fault(with(" SG_ a : 16|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:7:6: message \"ours\" has two signals \"a\"; rename one of them");
    EXPECT_EQ(fault(with("VAL_ 7 a 0 \"off\" ;")),
              "t.dbc:7:6: no message has the identifier 7; define it by BO_ before it is used");
    EXPECT_EQ(fault(with("VAL_ 2 aa 0 \"off\" ;")),
              "t.dbc:7:8: message \"ours\" has no signal \"aa\"; did you mean \"a\"?");
    EXPECT_EQ(fault(with("VAL_ 1 a 0 \"off\" 0 \"on\" ;")),
              "t.dbc:3:6: signal \"theirs.a\" has two names for the value 0: keep one");
    EXPECT_EQ(fault(with("VAL_ 1 a 300 \"off\" ;")),
              "t.dbc:3:6: signal \"theirs.a\" has a name for the value 300, which its 8 bits cannot hold: "
              "correct one of them");
    EXPECT_EQ(fault(with("VAL_ 1 a 0 \"off\" ;\nVAL_ 1 a 1 \"on\" ;")),
              "t.dbc:8:10: signal \"a\" has its values named twice; keep one VAL_");
}

TEST(DbcFaults, name_signals_that_overlap_or_exceed_their_frame) {
    EXPECT_EQ(fault(with_signal("c : 30|4@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:6: signal \"more.c\" reaches outside its frame of 4 bytes: it starts at bit 30 (its "
              "lowest) and goes up 4 "
              "bits; move it or lengthen the frame");
    EXPECT_EQ(fault(with_signal("c : 0|16@1+ (1,0) [0|0] \"\" us\n SG_ d : 11|4@0+ (1,0) [0|0] \"\" us")),
              "t.dbc:9:6: signal \"more.d\" overlaps \"c\" at bit 8: move one of them");
    EXPECT_EQ(fault(with_signal("c : 0|16@1+ (1,0) [0|0] \"\" them\n SG_ d : 11|4@0+ (1,0) [0|0] \"\" them")),
              "")
        << "what the node does not take is not its business";
    EXPECT_EQ(fault(with("BO_ 3 more: 12 them\n SG_ c : 90|4@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:7:7: frame \"more\" has 12 bytes: a classical frame holds 8 at most; make it CAN FD by "
              "fd_bytes(..), in a "
              "DBC file by VFrameFormat");
    EXPECT_EQ(fault(with("BO_ 3 more: 1785 them\n SG_ c : 90|4@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:7:7: message \"more\" has 1785 bytes, which no frame holds; a transport protocol is "
              "needed for it");
    EXPECT_EQ(fault(with_signal("c : 0|16@1+ (1,0) [0|0] \"\" us\nSIG_VALTYPE_ 3 c : 1;")),
              "t.dbc:9:20: signal \"c\" has 16 bits, but a float has 32; correct one of them");
}

TEST(DbcFaults, name_invalid_multiplexors) {
    EXPECT_EQ(fault(with_signal("c m0 : 0|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:6: signal \"c\" is multiplexed but its message has no multiplexor; write M behind the "
              "name of one");
    const std::string two =
        "p M : 0|8@1+ (1,0) [0|0] \"\" us\n SG_ q m1M : 8|8@1+ (1,0) [0|0] \"\" us\n SG_ c m0 : 16|8@1+ "
        "(1,0) [0|0] \"\" us\n";
    EXPECT_EQ(
        fault(with_signal(two)),
        "t.dbc:9:6: message \"more\" has several multiplexors; say by SG_MUL_VAL_ which one selects \"q\"");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 q p 1-1;\nSG_MUL_VAL_ 3 c q 0-0, 7-9;")), "");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 q q 1-1;\nSG_MUL_VAL_ 3 c q 0-0;")),
              "t.dbc:9:6: signal \"q\" is selected by itself, through others; correct SG_MUL_VAL_");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 c p 3-1;")),
              "t.dbc:11:19: an empty range; exchange its bounds");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 c c 1-1;")),
              "t.dbc:11:17: signal \"c\" selects others but is not a multiplexor; write M behind its name");
    EXPECT_EQ(
        fault(with_signal(two + "SG_MUL_VAL_ 3 p q 1-1;")),
        "t.dbc:11:15: signal \"p\" is selected but not multiplexed; write m and a number behind its name");
    EXPECT_EQ(
        fault(with_signal(two + "SG_MUL_VAL_ 3 q p 1-1;\nSG_MUL_VAL_ 3 c p 300-300;")),
        "t.dbc:10:6: signal \"more.c\" is selected by values that \"p\" never has: 300 to 300; correct them");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 q p 1-1;\nSG_MUL_VAL_ 3 c p "
                                      "0-0,2-2,4-4,6-6,8-8,10-10,12-12,14-14,16-16;")),
              "t.dbc:10:6: signal \"c\" is selected by more than 8 ranges; leave some to a second signal");
    EXPECT_EQ(
        fault(with_signal("p M : 0|8@1+ (0.5,0) [0|0] \"\" us\n SG_ c m0 : 8|8@1+ (1,0) [0|0] \"\" us")),
        "t.dbc:9:6: signal \"more.p\" selects \"c\" but is not an integer of at most 32 bits: remove factor "
        "and offset");
    EXPECT_EQ(fault(with_signal(
                  "p M : 0|8@1+ (1,0) [0|0] \"\" us\n SG_ c m0 : 8|8@1+ (1,0) [0|0] \"\" us\n SG_ d m1 : "
                  "8|16@1+ (1,0) [0|0] \"\" us\n SG_ e m0 : 12|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:11:6: signal \"more.e\" overlaps \"c\" at bit 12: move one of them");
}

TEST(DbcFaults, name_invalid_rows_of_the_node) {
    const auto of = [](const auto& node) { return fault(with(""), node.view()); };
    EXPECT_EQ(
        of(node("us")),
        "t.dbc:5:7: message \"ours\" is sent by \"us\" but has no safe values; write transmit(\"ours\", "
        "signal(\"..\").safe(..)) into its node, or .safe_by_silence() behind that");
    EXPECT_EQ(fault(with("BA_ \"GenMsgCycleTime\" BO_ 2 0;")),
              "t.dbc:5:7: message \"ours\" has no cycle time (GenMsgCycleTime); write can::every(..) or "
              "can::on_demand(..) into transmit(\"ours\", ..)");
    EXPECT_EQ(fault(with("BA_ \"GenMsgCycleTime\" BO_ 1 0;")),
              "t.dbc:2:7: message \"theirs\" has no cycle time (GenMsgCycleTime); write can::every(..) or "
              "can::on_demand(..) into receive(\"theirs\", ..)");
    EXPECT_EQ(fault(with("BA_ \"GenMsgCycleTime\" BO_ 2 10;"),
                    node("us", transmit("ours", every(5ms), signal("a").safe(0))).view()),
              "t.dbc:5:7: message \"ours\" has a cycle time of 10 ms and a row with another one; leave it "
              "out of the row");
    EXPECT_EQ(of(node("us", transmit("ours", signal("a")))),
              "t.dbc:6:6: signal \"ours.a\" does not say its safe value: write .safe(..) behind it, or "
              ".safe_by_silence() "
              "behind the frame");
    EXPECT_EQ(of(node("us", transmit("ours", signal("a").safe(256)))),
              "t.dbc:6:6: signal \"ours.a\" cannot hold its safe value: it is outside of the signal's range");
    EXPECT_EQ(of(node("us", transmit("our"))),
              "t.dbc:1:1: it has no message \"our\", which a row of \"us\" names; did you mean \"ours\"?");
    EXPECT_EQ(of(node("us", transmit("ours", signal("aa").safe(0)))),
              "t.dbc:5:7: message \"ours\" has no signal \"aa\", which its row names; did you mean \"a\"?");
    EXPECT_EQ(of(node("us", transmit("ours").safe_by_silence(), transmit("theirs"))),
              "t.dbc:2:7: message \"theirs\" is sent by \"them\", not by \"us\"; write receive(..)");
    EXPECT_EQ(
        of(node("us", receive("ours"))),
        "t.dbc:5:7: message \"ours\" is sent by \"us\", so \"us\" does not receive it; write transmit(..)");
    EXPECT_EQ(of(node("us", transmit("ours").safe_by_silence(), receive("ours"))),
              "t.dbc:5:7: message \"ours\" has two rows of \"us\"; keep one");
    EXPECT_EQ(of(node("us", transmit("ours", signal("a", 0, 8).safe(0)))),
              "t.dbc:6:6: the row of signal \"a\" repeats its file; write signal(\"a\"), its safe "
              "value and unit");
    EXPECT_EQ(of(node("us", transmit("ours", signal("a").safe(0), signal("a").safe(1)))),
              "t.dbc:6:6: the row of message \"ours\" names \"a\" twice; keep one");
    EXPECT_EQ(of(node("us", transmit(standard(2), "ours", bytes(8), on_demand(10ms)))),
              "t.dbc:5:7: the row of message \"ours\" repeats its file; leave identifier and length out");
}

TEST(DbcFaults, name_names_that_cannot_be_facets) {
    const std::string long_name(56, 'x');
    const auto silent = [](const auto&... rows) {
        return node("us", transmit("ours").safe_by_silence(), rows...);
    };
    EXPECT_EQ(fault(with("BO_ 3 " + long_name + ": 8 them\n SG_ speed_abc : 0|8@1+ (1,0) [0|0] \"\" us"),
                    silent().view()),
              "t.dbc:7:7: frame \"" + long_name +
                  "\": its name is too long for a facet's, which has at most 63 characters; give it a "
                  "shorter one with "
                  ".called(\"..\")");
    EXPECT_EQ(fault(with("BO_ 3 " + long_name + ": 8 them\n SG_ speed_abc : 0|8@1+ (1,0) [0|0] \"\" us"),
                    silent(receive(long_name).called("short")).view()),
              "");
    EXPECT_EQ(
        fault(with_signal("received : 0|8@1+ (1,0) [0|0] \"\" us")),
        "t.dbc:8:6: signal \"more.received\" has the name of the event that its frame arrived: rename it");
    EXPECT_EQ(fault(with_signal("received : 0|8@1+ (1,0) [0|0] \"\" us"),
                    silent(receive("more", signal("received").called("count"))).view()),
              "");
    EXPECT_EQ(fault(with(""), silent(receive("theirs", signal("b").called("a"))).view()),
              "t.dbc:4:6: frame \"theirs\" has two signals \"a\": rename one of them");
}

} // namespace
} // namespace tappet::can
