// DBC files as the field has them: faults of no consequence are read past, to the right values; what a map
// takes is refused with a cure in the node's own rows.
#include "drivers/can/dbc/writer.hpp"
#include "drivers/can/from_dbc.hpp"
#include "drivers/can/signal_store.hpp"
#include "tests/drivers/can/awkward_dbc.hpp"
#include "tests/drivers/can/dbc_generator.hpp"
#include "tests/drivers/can/dbc_on_host.hpp"
#include "tests/drivers/can/files.hpp"
#include "tests/drivers/can/swallowed.dbc.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

template <class Node> std::string fault(const std::string& text, const Node& node) {
    return std::string{DbcMap{text, node.view()}.map.fault.view()};
}
/// The value of a signal of map row 0 in a frame with these bytes.
double decoded(const DbcMap& read, std::string_view path, Payload data) {
    EXPECT_EQ(read.map.fault.view(), "");
    SignalStore store{read.map};
    Frame frame{.id = read.map.frames[0].identifier.id, .extended = read.map.frames[0].identifier.extended};
    frame.length = read.map.frames[0].length;
    frame.data = data;
    EXPECT_EQ(store.decode(frame), Decoded::yes);
    const std::size_t s = read.map.signal(path);
    return is_integer(read.map.signals[s]) ? static_cast<double>(store.integer(s)) : store.physical(s);
}

constexpr auto us = node("us");
constexpr auto receiver = node("", receive("M", every(10ms)));

constexpr auto map = from_dbc<files::swallowed_dbc, us>;
TAPPET_ACCEPTED(map.fault);
static_assert(map.frames.size() == 3 && map.signals.size() == 3);
static_assert(map.signal("M.s") == 0 && map.signal("2nd.2t") == 1 && map.signal("O.u") == 2);
static_assert(map.signals[0].names.size() == 1 && map.frames[2].every == 10ms);

TEST(DbcField, reads_past_faults_of_no_consequence) {
    const DbcMap read{contents_of("swallowed.dbc"), us.view()};
    EXPECT_EQ(decoded(read, "M.s", {7}), 7.0);
    EXPECT_EQ(read.sizes.frames, 3u);
    EXPECT_EQ(read.sizes.signals, 3u);
}

/// The map of node "us" as a file again, or its fault.
std::string map_of(const std::string& text, const std::vector<std::string>& own) {
    std::vector<FrameRow> rows;
    for (const std::string& each : own) rows.push_back(transmit(each).safe_by_silence().row);
    const DbcMap read{text, NodeView{"us", rows, {}}};
    if (!read.map.fault.empty()) return std::string{read.map.fault.view()};
    return dbc::to_dbc("us", std::span{read.map.frames}.first(read.sizes.frames),
                       std::span{read.map.signals}.first(read.sizes.signals));
}

TEST(DbcField, means_the_same_when_it_is_awkward) {
    for (std::uint64_t seed = 1; seed <= 256; ++seed) {
        DbcGenerator generator{seed};
        const std::string text = generator.file();
        const std::string plain = map_of(text, generator.own);
        ASSERT_TRUE(plain.starts_with("VERSION")) << plain;
        EXPECT_EQ(map_of(more_awkward(text, seed), generator.own), plain) << more_awkward(text, seed);
    }
}

const std::string one = "BU_: A us\nBO_ 1 M: 8 A\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" us\n"
                        "BA_DEF_DEF_ \"GenMsgCycleTime\" 100;\n";

TEST(DbcField, does_not_take_a_message_on_demand_for_a_cyclic_one) {
    const std::string types =
        "BA_DEF_ BO_ \"GenMsgSendType\" ENUM \"cyclic\",\"spontaneous\",\"IfActive\";\n";
    const std::string refused =
        "t.dbc:2:7: message \"M\" is sent on demand, too (GenMsgSendType), not only in its cycle time; write "
        "can::on_demand(..) with the least time between two, or can::every(..), into receive(\"M\", ..)";
    EXPECT_EQ(fault(one + "BA_DEF_DEF_ \"GenMsgSendType\" \"spontaneous\";\n", us), refused);
    EXPECT_EQ(fault(one + types + "BA_ \"GenMsgSendType\" BO_ 1 1;\n", us), refused);
    EXPECT_EQ(fault(one + types + "BA_ \"GenMsgSendType\" BO_ 1 2;\n", us), refused);
    EXPECT_EQ(fault(one + "BA_DEF_DEF_ \"GenMsgSendType\" \"cyclicAndSpontaneous\";\n", us), refused);
    EXPECT_EQ(fault(one + types + "BA_ \"GenMsgSendType\" BO_ 1 0;\n", us), "");
    EXPECT_EQ(fault(one + "BA_DEF_DEF_ \"GenMsgSendType\" \"NoMsgSendType\";\n", us), "");
    const std::string spontaneous = one + types + "BA_ \"GenMsgSendType\" BO_ 1 \"spontaneous\";\n";
    constexpr auto on = node("us", receive("M", on_demand(20ms)));
    constexpr auto cyclic = node("us", receive("M", every(50ms)));
    EXPECT_EQ(fault(spontaneous, on), "");
    EXPECT_EQ(fault(spontaneous, cyclic), "");
    const DbcMap read{spontaneous, on.view()};
    EXPECT_EQ(read.map.frames[0].every, 0ms);
    EXPECT_EQ(read.map.frames[0].apart, 20ms);
    EXPECT_EQ(fault(one, on),
              "t.dbc:2:7: message \"M\" has a cycle time of 100 ms and a row with another one; "
              "leave it out of the row");
}

TEST(DbcField, keeps_values_of_64_bits) {
    const DbcMap read{"BU_: A B\nBO_ 1 M: 8 A\n SG_ s : 0|64@1+ (1,0) [0|0] \"\" B\n"
                      "VAL_ 1 s 18446744073709551615 \"SNA\" 9223372036854775807 \"most\" 1.0 \"one\";",
                      receiver.view()};
    ASSERT_EQ(read.map.fault.view(), "");
    ASSERT_EQ(read.map.signals[0].names.size(), 3u);
    EXPECT_TRUE(read.map.signals[0].has_name(to_integer(read.map.signals[0], ~std::uint64_t{0})));
}

TEST(DbcField, drops_names_that_cannot_be_believed) {
    const auto names = [](const std::string& values) {
        const DbcMap read{one + values, us.view()};
        EXPECT_EQ(read.map.fault.view(), "");
        std::string all;
        for (const ValueName& each : read.map.signals[0].names) all += std::string{each.name} + " ";
        return all;
    };
    EXPECT_EQ(names("VAL_ 1 s 0 \"off\" 300 \"far\" 1 \"on\";"), "off on ");
    EXPECT_EQ(names("VAL_ 1 s 18446744073709551615 \"SNA\" 1e99 \"x\" 1.5 \"y\" 1 \"on\";"), "on ");
    EXPECT_EQ(names("VAL_ 1 s 0 \"off\" 1 \"on\" 0 \"OFF\" 2 \"two\";"), "on two ");
    EXPECT_EQ(names("VAL_ 1 s 0 \"off\" 1 \"on\" 0 \"off\" 0 \"off\";"), "off on ");
    EXPECT_EQ(names("VAL_ 1 s 0 \"off\";\nVAL_ 1 s 1 \"on\";"), "");
}

TEST(DbcField, takes_some_signals_of_a_message) {
    const std::string overlapping =
        "BU_: A us\nBO_ 1 M: 8 A\n SG_ a : 0|16@1+ (1,0) [0|0] \"\" us\n"
        " SG_ b : 8|8@1+ (0.5,0) [0|0] \"\" us\n SG_ c : 60|8@1+ (1,0) [0|0] \"\" us\n";
    constexpr auto whole = node("us", receive("M", every(10ms)));
    constexpr auto some = node("us", receive("M", every(10ms), signal("b")));
    constexpr auto far = node("us", receive("M", every(10ms), signal("c")));
    constexpr auto none = node("us", without("M"));
    EXPECT_EQ(fault(overlapping, whole),
              "t.dbc:4:6: signal \"M.b\" overlaps \"a\" at bit 8; state it in its row, despite(signal(\"b\", "
              "first bit, bits).times(0.5)), or take other signals alone, receive(\"M\", signal(\"a\"), ..)");
    EXPECT_EQ(decoded({overlapping, some.view()}, "M.b", {1, 8}), 4.0);
    EXPECT_EQ(fault(overlapping, far),
              "t.dbc:5:6: signal \"M.c\" reaches outside its frame of 8 bytes: it starts at bit 60 (its "
              "lowest) and goes up 8 bits; state it in its row, despite(signal(\"c\", first bit, bits)), or "
              "take other signals alone, receive(\"M\", signal(\"a\"), ..)");
    EXPECT_EQ(fault(overlapping, none), "");
    const DbcMap read{overlapping, none.view()};
    EXPECT_EQ(read.sizes.frames, 0u);
}

TEST(DbcField, sends_for_a_node_without_a_name) {
    constexpr auto sender = node("", transmit("M", every(100ms), signal("s").safe(3)));
    EXPECT_EQ(fault("BU_:\nBO_ 1 M: 8 Vector__XXX\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" Vector__XXX\n", sender),
              "");
    EXPECT_EQ(fault("BO_ 1 M: 8 A\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" B\n", sender), "");
    constexpr auto named = node("B", transmit("M", every(100ms), signal("s").safe(3)));
    EXPECT_EQ(fault("BO_ 1 M: 8 A\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" B\n", named),
              "t.dbc:1:7: message \"M\" is sent by \"A\", not by \"B\"; write receive(..)");
}

TEST(DbcField, leaves_out_one_of_two_messages_with_an_identifier) {
    const std::string two = one + "BO_ 1 N: 8 A\n SG_ n : 8|8@1+ (1,0) [0|0] \"\" A\n"
                                  "VAL_ 1 n 1 \"on\";\nBA_ \"GenMsgCycleTime\" BO_ 1 30;\n";
    constexpr auto second = node("us", receive("N"));
    const DbcMap read{two, second.view()};
    EXPECT_EQ(decoded(read, "N.n", {1, 2}), 2.0);
    EXPECT_EQ(read.sizes.frames, 1u);
    EXPECT_EQ(read.map.frames[0].every, 30ms);
    EXPECT_EQ(read.map.signals[0].names.size(), 1u);
    EXPECT_EQ(fault(two, us),
              "t.dbc:2:7: message \"M\" has the identifier of another one; write the one that is "
              "on the bus as a row, receive(\"M\", ..)");
}

TEST(DbcField, asks_for_limits_only_where_it_sends) {
    const std::string limits =
        "BU_: us\nBO_ 1 M: 8 us\n SG_ s : 0|8@1+ (1,0) [0|1E+481] \"\" A\n"
        " SG_ t : 8|8@1+ (1,0) [5|2] \"\" A\n SG_ u : 16|8@1+ (1,0) [-inf|NaN] \"\" A\n"
        " SG_ v : 24|8@1+ (1,0) [-1.79769313486232E+308|1.7976931348623157E+308] \"\" A\n";
    constexpr auto them = node("A", receive("M", every(10ms)));
    EXPECT_EQ(fault(limits, them), "");
    const DbcMap read{limits, them.view()};
    EXPECT_FALSE(read.map.signals[0].has_range);
    EXPECT_TRUE(read.map.signals[3].has_range);
    EXPECT_EQ(read.map.signals[3].most, std::numeric_limits<double>::max());
    constexpr auto sender = node("us", transmit("M", every(10ms)).safe_by_silence());
    EXPECT_EQ(fault(limits, sender),
              "t.dbc:3:26: the greatest value is beyond a double; state it in its row, despite(signal(\"s\", "
              "0, 8).range(.., ..)), or leave its message out by a row, without(\"M\") (and 2 more: tappet "
              "check t.dbc lists all)");
}

TEST(DbcField, believes_a_row_despite_the_file) {
    const std::string wrong = "BU_: us A\nBO_ 1 M: 8 us\n SG_ a : 0|16@1+ (1,0) [0|0] \"\" A\n"
                              " SG_ b : 8|8@1+ (0,0) [9|1] \"Nm\" A\nVAL_ 1 b 3 \"three\";\n"
                              "BO_ 419361537 N: 12 A\n SG_ n m1 : 0|8@1+ (1,0) [0|0] \"\" us\n"
                              " SG_ m : 8|8@1+ (1,0) [0|0] \"\" us\n";
    constexpr auto believing = node(
        "us",
        transmit("M", every(10ms), signal("a").safe(0), despite(signal("b", 16, 8).times(0.5)).safe("three")),
        despite(extended(0x18FEF101),
                despite(fd_bytes(12),
                        receive("N", every(10ms), signal("m"), despite(signal("n", 0, 8).when("m", 2))))));
    const DbcMap read{wrong, believing.view()};
    ASSERT_EQ(read.map.fault.view(), "");
    EXPECT_EQ(read.map.safe_frames()[0].data, (Payload{0, 0, 3}));
    EXPECT_EQ(read.map.signals[1].unit, "N m");
    EXPECT_EQ(read.map.frames[1].identifier, extended(0x18FEF101));
    EXPECT_EQ(read.map.frames[1].format, Format::flexible_faster);
    EXPECT_EQ(read.map.frames[1].length, 12);
    EXPECT_EQ(read.map.multiplexor_of[read.map.signal("N.n")], read.map.signal("N.m"));
    constexpr auto silent =
        transmit("M", every(10ms), signal("a").safe(0), despite(signal("b", 16, 8)).safe(0));
    EXPECT_EQ(
        fault(wrong, node("us", silent)),
        "t.dbc:6:5: message \"N\" has the identifier 419361537: a standard one ends at 2047, an extended one "
        "has bit 31 set and 29 bits; state it in its row, despite(extended(..), receive(\"N\", ..)), or "
        "leave "
        "it out, without(\"N\") (and 1 more: tappet check t.dbc lists all)");
    EXPECT_EQ(fault(wrong, node("us", silent, despite(extended(1), receive("N", every(10ms), signal("m"))))),
              "t.dbc:6:15: frame \"N\" has 12 bytes: a classical frame holds 8 at most; state it in its row, "
              "despite(fd_bytes(..), receive(\"N\", ..)), or leave it out, without(\"N\")");
    EXPECT_EQ(
        fault(wrong, node("us", transmit("M", every(10ms), despite(signal("b")).safe(0)))),
        "t.dbc:4:6: the row of signal \"b\" does not say its place; write despite(signal(\"b\", first bit, "
        "bits))");
    EXPECT_EQ(
        fault(wrong, node("us", silent, receive("N", despite(signal("n", 0, 8).when("x", 2))))),
        "t.dbc:7:6: the row of signal \"n\" has the multiplexor \"x\"; name a signal of its message that is "
        "in every frame of it");
}

TEST(DbcField, believes_one_row_for_two_signals_of_a_name) {
    const std::string twins = "BU_: us A\nBO_ 1 M: 8 us\n SG_ a : 0|8@1+ (1,0) [0|0] \"\" A\n"
                              " SG_ a : 8|8@1+ (1,0) [0|0] \"\" A\n";
    constexpr auto believing = node("us", transmit("M", every(10ms), despite(signal("a", 16, 8)).safe(7)));
    const DbcMap read{twins, believing.view()};
    ASSERT_EQ(read.map.fault.view(), "");
    EXPECT_EQ(read.sizes.signals, 1u);
    EXPECT_EQ(read.map.safe_frames()[0].data, (Payload{0, 0, 7}));
}

TEST(DbcField, takes_no_receiver_from_a_comment) {
    const DbcMap read{"BU_: A // C\nBO_ 1 M: 8 A\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" A // us\n", us.view()};
    EXPECT_EQ(read.map.fault.view(),
              "t.dbc:1:6: BU_ names no node \"us\"; name one of its nodes, or none: node(\"\", ..)");
}

TEST(DbcField, obeys_the_cures_that_it_prints) {
    const std::string pages = "BU_: us A\nBO_ 1 M: 8 A\n SG_ k M : 0|8@1+ (1,0) [0|0] \"\" us\n"
                              " SG_ j M : 8|8@1+ (1,0) [0|0] \"\" us\n"
                              " SG_ t m3 : 16|16@1- (0.1,-40) [0|0] \"\" us\n";
    EXPECT_EQ(fault(pages, node("us", receive("M", every(10ms)))),
              "t.dbc:5:6: message \"M\" has several multiplexors, and SG_MUL_VAL_ says not which one selects "
              "\"t\"; state it in its row, despite(signal(\"t\", 16, "
              "16).as_signed().times(0.1).plus(-40).when(\"..\", ..)), or take other signals alone, "
              "receive(\"M\", signal(\"k\"), ..)");
    const auto cured = [](const Signal& t) { return node("us", receive("M", every(10ms), despite(t))); };
    const Signal place = signal("t", 16, 16).as_signed().times(0.1).plus(-40);
    EXPECT_EQ(fault(pages, cured(place)), "t.dbc:5:6: the row of signal \"t\" does not say what selects it; "
                                          "write .when(\"..\", ..) behind its place");
    const auto when = cured(place.when("k", 3));
    const DbcMap read{pages, when.view()};
    ASSERT_EQ(read.map.fault.view(), "");
    EXPECT_EQ(read.map.multiplexor_of[read.map.signal("M.t")], read.map.signal("M.k"));
    EXPECT_EQ(fault("BU_: us A\nBO_ 1 M: 8 us\n SG_ t : 7|16@0- (0.1,-40) [0|1E+999] \"\" A\n",
                    node("us", transmit("M", every(10ms), signal("t").safe(0)))),
              "t.dbc:3:31: the greatest value is beyond a double; state it in its row, despite(signal(\"t\", "
              "7, 16).big_endian().as_signed().times(0.1).plus(-40).range(.., ..)), or leave its message out "
              "by a row, without(\"M\")");
    // A row cures the fault that it states, and no other one.
    const std::string two = "BU_: us A\nBO_ 1 M: 8 A\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" us\n"
                            "BO_ 3000 M: 8 A\n SG_ s : 8|8@1+ (1,0) [0|0] \"\" us\n";
    EXPECT_EQ(fault(two, node("us", despite(bytes(8), receive("M", every(10ms))))),
              "t.dbc:4:10: message \"M\" is there twice; leave it out by a row, without(\"M\") (and 2 more: "
              "tappet check t.dbc lists all)");
    constexpr auto zero = node("us", despite(standard(0), receive("M")));
    const DbcMap zeroed{one, zero.view()};
    ASSERT_EQ(zeroed.map.fault.view(), "");
    EXPECT_EQ(zeroed.map.frames[0].identifier, standard(0));
}

} // namespace
} // namespace tappet::can
