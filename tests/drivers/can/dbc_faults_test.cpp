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
              "t.dbc:7:26: VFrameFormat has no such value; leave it out by a row, without(\"ours\")");
    EXPECT_EQ(fault(with("BA_ \"CANFD_BRS\" BO_ 2 yes;")),
              "t.dbc:7:23: found \"yes;\", expected the number of the attribute's value; leave it out by a "
              "row, without(\"ours\")");
    EXPECT_EQ(
        fault(with(
            "BA_DEF_ BO_ \"VFrameFormat\" INT 0 15;\nBA_DEF_ BU_ \"x\" STRING ;\nBA_DEF_ \"y\" INT 0 1;")),
        "");
    EXPECT_EQ(fault(with("BO_ 3 more: 13 them\n SG_ c : 0|8@1+ (1,0) [0|0] \"\" us\n"
                         "BA_ \"VFrameFormat\" BO_ 3 14;")),
              "t.dbc:7:7: frame \"more\" has 13 bytes: CAN FD has no such length; state it in its row, "
              "despite(fd_bytes(..), receive(\"more\", ..)), or leave it out, without(\"more\")");
    EXPECT_EQ(fault(with("BO_ 3 more: 64 them\n SG_ c : 504|8@1+ (1,0) [0|0] \"\" us\n"
                         "BA_ \"VFrameFormat\" BO_ 3 14;\nBA_ \"GenMsgCycleTime\" BO_ 3 20;")),
              "");
}

TEST(DbcFaults, are_not_reported_in_a_valid_file) {
    EXPECT_EQ(fault(with("")), "");
    EXPECT_EQ(fault(with_signal("c : 0|32@1- (1E-3,-.5) [-1e+3|1000.0] \"mm/s\" us, them")), "");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,0) [0|0] \"\"")), "") << "nobody receives it";
    EXPECT_EQ(fault("BU_:\n", node("").view()), "");
}

TEST(DbcFaults, in_what_nobody_takes_are_left_to_the_check) {
    EXPECT_EQ(fault(with("BO_ 3 x: 8 them SG_ c : 16|8@1+ (1,0) [0|0] \"\" us")), "");
    EXPECT_EQ(fault(with("BO_ 2048 more: 8 them")), "");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,0) [5|2] \"\" us")), "");
    EXPECT_EQ(fault(with("BA_DEF_ \"x\" INT 0 1\nCM_ \"x\";")), "");
    EXPECT_EQ(fault(with("BO_ 3 more: 8 then")), "");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,0) [0|0] \"\" us,robot")), "");
    EXPECT_EQ(fault(with("VAL_ 7 a 0 \"off\" ;")), "");
    EXPECT_EQ(fault(with("VAL_ 2 aa 0 \"off\" ;")), "");
    EXPECT_EQ(fault(with("VAL_ 1 a 0 \"off\" 0 \"on\" ;")), "");
    EXPECT_EQ(fault(with("VAL_ 1 a 300 \"off\" ;")), "");
    EXPECT_EQ(fault(with("VAL_ 1 a 0 \"off\" ;\nVAL_ 1 a 1 \"on\" ;")), "");
}

TEST(DbcFaults, make_the_file_unreadable_where_it_is_not_certain_whom_they_concern) {
    EXPECT_EQ(
        fault(with("BOO_ 3 x: 8 them")),
        "t.dbc:7:1: found \"BOO_\", expected a statement, which begins with BO_, SG_, VAL_ or the like");
    EXPECT_EQ(fault(with("BO_ 3 x 8 them")),
              "t.dbc:7:9: found \"8\", expected \":\" after the message's name");
    EXPECT_EQ(fault(with("BO 3 x: 8 them\n SG_ c : 16|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:7:1: found \"BO\", expected a statement, which begins with BO_, SG_, VAL_ or the like");
    EXPECT_EQ(fault(with("BO_ 3 x: 8 them\n SG c : 16|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:2: found \"SG\", expected a statement, which begins with BO_, SG_, VAL_ or the like");
    EXPECT_EQ(fault(with("BU_: us")), "t.dbc:7:1: BU_ is there twice");
    EXPECT_EQ(fault(with("BO_TX_BU_ 1 them,us;")),
              "t.dbc:7:13: found \"them,us;\", expected \":\" before the nodes that send the message");
    EXPECT_EQ(fault(with("BO_TX_BU_ 1 : them;\nBO_TX_BU_ 1 : us;")),
              "t.dbc:8:1: message \"theirs\" has BO_TX_BU_ twice");
    EXPECT_EQ(fault(with("VAL_ 1 a 0 \"off\" 1 on ;")),
              "t.dbc:7:20: found \"on\", expected the value's name between quotes");
    EXPECT_EQ(fault(with("VAL_ 1 a 0 \"off\"\n")),
              "t.dbc:8:1: the file ends, expected \";\", the end of the statement; is it whole?");
    EXPECT_EQ(fault(with("BA_DEF_ \"x\" INT 0 1")),
              "t.dbc:7:20: the file ends, expected \";\", the end of a statement; is it whole?");
    EXPECT_EQ(fault(with("CM_ \"x\" SIG_VALTYPE_ 1 a : 1;")),
              "t.dbc:7:9: found \"SIG_VALTYPE_\", expected \";\" before it");
    EXPECT_EQ(fault(with("BA_DEF_ BO_ \"VFrameFormat\" ENUM \"a\" \"b\";")),
              "t.dbc:7:37: a text is unclosed or out of place, expected \";\", the end of the statement");
    EXPECT_EQ(fault(with("BA_DEF_DEF_ \"VFrameFormat\" 14.5;")),
              "t.dbc:7:28: found \"14.5;\", expected the number of the attribute's value");
    EXPECT_EQ(fault(with("BA_DEF_DEF_ \"GenMsgCycleTime\" 30;")),
              "t.dbc:7:13: GenMsgCycleTime has two defaults");
    EXPECT_EQ(fault(with("BA_ \"GenMsgSendType\" BO_ 1 1;\nBA_DEF_ BO_ \"GenMsgSendType\" ENUM \"cyclic\";")),
              "t.dbc:8:1: GenMsgSendType is defined twice, or behind its use");
    EXPECT_EQ(fault(with("BA_ \"GenMsgCycletime\" BO_ 1 30;")),
              "t.dbc:7:5: attribute \"GenMsgCycletime\" is unknown; did you mean \"GenMsgCycleTime\"?");
    EXPECT_EQ(fault(with("BA_ \"GenMsgCycleTime\" BO_ 7 30;")),
              "t.dbc:7:27: no message has the identifier 7");
    EXPECT_EQ(fault(with("SIG_VALTYPE_ 0x1 a : 1;")),
              "t.dbc:7:14: found \"0x1\", expected a message's identifier");
    EXPECT_EQ(fault(""), "t.dbc:1:1: the file has no statement; is it a DBC file?");
}

TEST(DbcFaults, of_a_statement_spoil_the_messages_that_it_names) {
    EXPECT_EQ(fault(with("SIG_VALTYPE_ 1 A : 1;")),
              "t.dbc:7:16: message \"theirs\" has no signal \"A\"; did you mean \"a\"? leave it out by a "
              "row, without(\"theirs\")");
    EXPECT_EQ(fault(with("SG_MUL_VAL_ 1 a b 3-;")),
              "t.dbc:7:21: found \";\", expected the last value of a range; state it in its row, "
              "despite(signal(\"a\", 0, 8).when(\"..\", ..)), or take other signals alone, "
              "receive(\"theirs\", signal(\"b\"), ..)");
    EXPECT_EQ(fault(with("BA_ \"GenMsgCycleTime\" BO_ 1 1 000;")),
              "t.dbc:7:31: found \"000;\", expected \";\", the end of the statement; write can::every(..) or "
              "can::on_demand(..) into receive(\"theirs\", ..)");
    EXPECT_EQ(fault(with("BA_ \"GenMsgCycleTime\" BO_ 1 10;\nBA_ \"GenMsgCycleTime\" BO_ 1 20;")),
              "t.dbc:8:29: GenMsgCycleTime is there twice; write can::every(..) or can::on_demand(..) into "
              "receive(\"theirs\", ..)");
    EXPECT_EQ(fault(with("SIG_VALTYPE_ 1 A : 1;"),
                    node("us", without("theirs"), transmit("ours").safe_by_silence()).view()),
              "");
    const std::string twins = with("BO_ 3 one: 4 them\n SG_ c : 0|32@1- (1,0) [0|0] \"\" them\n"
                                   "BO_ 3 two: 4 them\n SG_ c : 0|32@1- (1,0) [0|0] \"\" them\n");
    const auto two = node("us", receive("two"), transmit("ours").safe_by_silence());
    const DbcMap read{twins + "SIG_VALTYPE_ 3 c : 1;\nVAL_ 3 c 1 \"on\";\n", two.view()};
    ASSERT_EQ(read.map.fault.view(), "");
    EXPECT_EQ(read.map.signals[read.map.signal("two.c")].kind, Kind::float32);
    EXPECT_EQ(read.map.signals[read.map.signal("two.c")].names.size(), 1u);
    EXPECT_EQ(fault(twins + "SIG_VALTYPE_ 3 c : 3;", two.view()),
              "t.dbc:11:20: 3 is too large for 0 (integer), 1 (float) or 2 (double), which is 2 at most; "
              "state it in its row, despite(signal(\"c\", first bit, bits).as_signed()), or leave its "
              "message out by a row, without(\"two\")");
    EXPECT_EQ(fault(with("BO_ 3 more: 8 uss")),
              "t.dbc:7:15: \"uss\", which BU_ does not name, may be \"us\"; write transmit(\"more\", ..), "
              "receive(\"more\", ..) or without(\"more\")");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,0) [0|0] \"\" usthem")),
              "t.dbc:8:32: \"usthem\", which BU_ does not name, may be \"us\"; write transmit(\"more\", ..), "
              "receive(\"more\", ..) or without(\"more\")");
    EXPECT_EQ(fault(with("BO_ 3 more: 8 uss"),
                    node("us", without("more"), transmit("ours").safe_by_silence()).view()),
              "");
}

TEST(DbcFaults, name_unexpected_words) {
    EXPECT_EQ(fault(with("BO_ 3")), "t.dbc:7:6: the file ends, expected a message's name; is it whole?");
    EXPECT_EQ(fault(with_signal("c 0|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:8: found \"0|8@1+\", expected \":\" after the signal's name");
    EXPECT_EQ(fault(with_signal("c : 0|8@2+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:14: 2 is no byte order: 0 (Motorola) or 1 (Intel)");
    EXPECT_EQ(fault(with_signal("c : 0|8@1 (1,0) [0|0] \"\" us")),
              "t.dbc:8:16: found \"(1,0)\", expected \"+\" (unsigned) or \"-\" (signed)");
    EXPECT_EQ(fault(with_signal("c k0 : 0|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:8: found \"k0\", expected \":\" or M, m0 or m0M of a multiplexed signal");
    EXPECT_EQ(fault(" SG_ c : 0|8@1+ (1,0) [0|0] \"\" us"),
              "t.dbc:1:6: a signal without a message; write BO_ before it");
    EXPECT_EQ(fault(with("CM_ \"x\";\n SG_ c : 16|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:6: a signal that is not behind its message");
}

TEST(DbcFaults, name_invalid_numbers) {
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1.2.3,0) [0|0] \"\" us")),
              "t.dbc:8:18: found \"1.2.3,0)\", expected the factor");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,1e999) [0|0] \"\" us")),
              "t.dbc:8:20: the offset is beyond a double; state it in its row, despite(signal(\"c\", first "
              "bit, bits).plus(..)), or leave its message out by a row, without(\"more\")");
    EXPECT_EQ(fault(with_signal("c : 0|65@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:12: 65 is too large for the number of the signal's bits, which is 64 at most; state "
              "it in its row, despite(signal(\"c\", first bit, bits)), or leave its message out by a row, "
              "without(\"more\")");
    EXPECT_EQ(
        fault(with_signal("c : 0|0@1+ (1,0) [0|0] \"\" us")),
        "t.dbc:8:12: signal \"c\" has 0 bits instead of 1 to 64; state it in its row, despite(signal(\"c\", "
        "first bit, bits)), or leave its message out by a row, without(\"more\")");
    EXPECT_EQ(fault(with_signal("c : 99999999999999999999|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:10: found \"99999999999999999999|8@1\", expected the signal's first bit");
    EXPECT_EQ(fault(with("BA_ \"GenMsgCycleTime\" BO_ 1 -5;")),
              "t.dbc:7:29: a cycle time of -5 ms; write can::every(..) or can::on_demand(..) into "
              "receive(\"theirs\", ..)");
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (0,0) [0|0] \"\" us")),
              "t.dbc:8:18: signal \"c\" has the factor 0: every value would be the offset; state it in its "
              "row, despite(signal(\"c\", first bit, bits).times(..)), or leave its message out by a row, "
              "without(\"more\")");
}

TEST(DbcFaults, name_unclosed_texts) {
    EXPECT_EQ(fault(with_signal("c : 0|8@1+ (1,0) [0|0] \"mm us\n")),
              "t.dbc:8:29: a text is unclosed or out of place, expected the unit between quotes");
    EXPECT_EQ(fault(with("CM_ \"never ends;\n")),
              "t.dbc:7:5: a text is unclosed at the end of the file; is it whole?");
}

TEST(DbcFaults, name_unknown_and_duplicate_names) {
    EXPECT_EQ(fault(with(""), node("uss").view()),
              "t.dbc:1:40: BU_ names no node \"uss\"; did you mean \"us\"?");
    EXPECT_EQ(fault(with("BO_ 1 more: 8 them")),
              "t.dbc:2:7: message \"theirs\" has the identifier of another one; write the one that is on the "
              "bus as a row, receive(\"theirs\", ..)");
    EXPECT_EQ(fault(with("BO_ 3 theirs: 8 them")),
              "t.dbc:7:7: message \"theirs\" is there twice; leave it out by a row, without(\"theirs\")");
    EXPECT_EQ(fault(with(" SG_ a : 16|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:7:6: message \"ours\" has two signals \"a\"; state it in its row, despite(signal(\"a\", "
              "first bit, bits)), or leave its message out by a row, without(\"ours\") (and 1 more: tappet "
              "check t.dbc lists all)");
}

TEST(DbcFaults, name_signals_that_overlap_or_exceed_their_frame) {
    EXPECT_EQ(fault(with_signal("c : 30|4@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:6: signal \"more.c\" reaches outside its frame of 4 bytes: it starts at bit 30 (its "
              "lowest) and goes up 4 bits; state it in its row, despite(signal(\"c\", first bit, bits)), or "
              "leave its message out by a row, without(\"more\")");
    EXPECT_EQ(
        fault(with_signal("c : 0|16@1+ (1,0) [0|0] \"\" us\n SG_ d : 11|4@0+ (1,0) [0|0] \"\" us")),
        "t.dbc:9:6: signal \"more.d\" overlaps \"c\" at bit 8; state it in its row, despite(signal(\"d\", "
        "first bit, bits).big_endian()), or take other signals alone, receive(\"more\", signal(\"c\"), ..)");
    EXPECT_EQ(fault(with_signal("c : 0|16@1+ (1,0) [0|0] \"\" them\n SG_ d : 11|4@0+ (1,0) [0|0] \"\" them")),
              "")
        << "what the node does not take is not its business";
    EXPECT_EQ(fault(with("BO_ 3 more: 12 them\n SG_ c : 90|4@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:7:7: frame \"more\" has 12 bytes: a classical frame holds 8 at most; state it in its "
              "row, despite(fd_bytes(..), receive(\"more\", ..)), or leave it out, without(\"more\")");
    EXPECT_EQ(fault(with("BO_ 3 more: 1785 them\n SG_ c : 90|4@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:7:7: message \"more\" has 1785 bytes, which no frame holds, only a transport protocol; "
              "leave it out by a row, without(\"more\")");
    EXPECT_EQ(
        fault(with_signal("c : 0|16@1+ (1,0) [0|0] \"\" us\nSIG_VALTYPE_ 3 c : 1;")),
        "t.dbc:9:20: signal \"c\" has 16 bits, but a float has 32; state it in its row, "
        "despite(signal(\"c\", first bit, bits)), or leave its message out by a row, without(\"more\")");
}

TEST(DbcFaults, name_invalid_multiplexors) {
    EXPECT_EQ(fault(with_signal("c m0 : 0|8@1+ (1,0) [0|0] \"\" us")),
              "t.dbc:8:6: signal \"c\" is multiplexed but its message has no multiplexor; state it in its "
              "row, despite(signal(\"c\", 0, 8).when(\"..\", ..)), or leave its message out by a row, "
              "without(\"more\")");
    const std::string two =
        "p M : 0|8@1+ (1,0) [0|0] \"\" us\n SG_ q m1M : 8|8@1+ (1,0) [0|0] \"\" us\n SG_ c m0 : 16|8@1+ "
        "(1,0) [0|0] \"\" us\n";
    EXPECT_EQ(
        fault(with_signal(two)),
        "t.dbc:9:6: message \"more\" has several multiplexors, and SG_MUL_VAL_ says not which one selects "
        "\"q\"; state it in its row, despite(signal(\"q\", 8, 8).when(\"..\", ..)), or take other signals "
        "alone, receive(\"more\", signal(\"p\"), ..) (and 1 more: tappet check t.dbc lists all)");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 q p 1-1;\nSG_MUL_VAL_ 3 c q 0-0, 7-9;")), "");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 q q 1-1;\nSG_MUL_VAL_ 3 c q 0-0;")),
              "t.dbc:9:6: signal \"q\" is selected by itself, through others; state it in its row, "
              "despite(signal(\"q\", 8, 8).when(\"..\", ..)), or take other signals alone, receive(\"more\", "
              "signal(\"p\"), ..)");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 c p 3-1;\nSG_MUL_VAL_ 3 q p 1-1;")),
              "t.dbc:11:19: an empty range; state it in its row, despite(signal(\"c\", 16, 8).when(\"..\", "
              "..)), or take other signals alone, receive(\"more\", signal(\"p\"), ..)");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 c c 1-1;\nSG_MUL_VAL_ 3 q p 1-1;")),
              "t.dbc:11:17: signal \"c\" selects others but is not a multiplexor; state it in its row, "
              "despite(signal(\"c\", 16, 8).when(\"..\", ..)), or take other signals alone, "
              "receive(\"more\", signal(\"p\"), ..)");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 p q 1-1;")),
              "t.dbc:11:15: signal \"p\" is selected but not multiplexed; state it in its row, "
              "despite(signal(\"p\", 0, 8).when(\"..\", ..)), or leave its message out by a row, "
              "without(\"more\") (and 2 more: tappet check t.dbc lists all)");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 q p 1-1;\nSG_MUL_VAL_ 3 c p 300-300;")),
              "t.dbc:10:6: signal \"more.c\" is selected by values that \"p\" never has: 300 to 300; state "
              "it in its row, despite(signal(\"c\", first bit, bits)), or take other signals alone, "
              "receive(\"more\", signal(\"p\"), ..)");
    EXPECT_EQ(fault(with_signal(two + "SG_MUL_VAL_ 3 q p 1-1;\nSG_MUL_VAL_ 3 c p "
                                      "0-0,2-2,4-4,6-6,8-8,10-10,12-12,14-14,16-16;")),
              "t.dbc:10:6: signal \"c\" is selected by more than 8 ranges; state it in its row, "
              "despite(signal(\"c\", 16, 8).when(\"..\", ..)), or take other signals alone, "
              "receive(\"more\", signal(\"p\"), ..)");
    EXPECT_EQ(
        fault(with_signal("p M : 0|8@1+ (0.5,0) [0|0] \"\" us\n SG_ c m0 : 8|8@1+ (1,0) [0|0] \"\" us")),
        "t.dbc:9:6: signal \"more.p\" selects \"c\" but is not an integer of at most 32 bits; state it in "
        "its row, despite(signal(\"c\", first bit, bits)), or take other signals alone, receive(\"more\", "
        "signal(\"p\"), ..)");
    EXPECT_EQ(
        fault(with_signal(
            "p M : 0|8@1+ (1,0) [0|0] \"\" us\n SG_ c m0 : 8|8@1+ (1,0) [0|0] \"\" us\n SG_ d m1 : "
            "8|16@1+ (1,0) [0|0] \"\" us\n SG_ e m0 : 12|8@1+ (1,0) [0|0] \"\" us")),
        "t.dbc:11:6: signal \"more.e\" overlaps \"c\" at bit 12; state it in its row, despite(signal(\"e\", "
        "first bit, bits)), or take other signals alone, receive(\"more\", signal(\"p\"), ..)");
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
    EXPECT_EQ(fault(with(""), silent(receive("theirs", signal("a"), signal("b").called("a"))).view()),
              "t.dbc:4:6: frame \"theirs\" has two signals \"a\": rename one of them");
}

} // namespace
} // namespace tappet::can
