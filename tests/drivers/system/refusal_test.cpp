// Refusals of a system's table: one sentence each, which names the row, the fault and the cure.
#include "drivers/gpio/kind.hpp"
#include "tests/drivers/system/pair.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tappet::pair {
namespace {

constexpr auto good_wire = usual_wire("wire");

template <std::size_t N, std::size_t X, std::size_t P = 0>
std::string refusal(const Section<SystemNode, N>& n, const WireRow& w, const Section<Crossing, X>& x,
                    const Section<PromiseRow, P>& p = {}) {
    const auto table = system("lane", n, w, x, p);
    const auto plan = plan_system(table, &systems::analyse_can);
    if (!plan.fault.empty()) return std::string{plan.fault.view()};
    std::array<Duration, P> proven{};
    return std::string{systems::check_promises(table.view(), plan, proven).view()};
}
template <class... Rows>
std::string refusal(const Rows&... rows) {
    return refusal(both_nodes, good_wire, crossings(rows...));
}
const std::string of_level = "lane: crossing \"a.giver.level\" -> \"b.taker.level\"";
const std::string of_sent = "lane: crossing \"a.giver.sent\" -> \"b.taker.take\"";

/// The two crossings that most faults are planted in.
template <class... Words>
constexpr auto level(const Words&... words) {
    return across(data("a.giver.level", "b.taker.level"), words...);
}
template <class... Words>
constexpr auto sent(const Words&... words) {
    return across(when("a.giver.sent", tell("b.taker.take")), words...);
}

TEST(SystemRefusals, accept_a_valid_system) {
    EXPECT_EQ(refusal(level_row, sent_row, doubled_row, presence("b", "a.giver.other_is_there")), "");
}

TEST(SystemRefusals, name_invalid_nodes_and_wires) {
    EXPECT_EQ(refusal(nodes(node<giver_table>("a")), good_wire, crossings()),
              "lane: a system has two nodes at least; add node<table>(\"name\")");
    EXPECT_EQ(refusal(nodes(node<giver_table>("a"), node<taker_table>("a")), good_wire, crossings()),
              "lane: node \"a\" appears twice; rename one of them");
    EXPECT_EQ(refusal(nodes(node<giver_table>("a.b"), node<taker_table>("b")), good_wire, crossings()),
              "lane: node \"a.b\": a node's name is not empty and has no dot; rename it");
    EXPECT_EQ(refusal(both_nodes, wire("wire"), crossings(level_row)),
              "lane: wire \"wire\" has no bit rate; add bit_rate(500'000)");
    EXPECT_EQ(refusal(both_nodes, wire("wire", bit_rate(500'000), lines(8)), crossings(level_row)),
              "lane: wire \"wire\": lines(...) does not apply to a wire; remove it");
    EXPECT_EQ(refusal(both_nodes, wire("giver", bit_rate(500'000)), crossings(level_row)),
              "lane: node \"a\" has a component \"giver\", which is the wire's name; rename one of them");
    EXPECT_EQ(refusal(both_nodes, wire("wire", bit_rate(500'000), beats(20ms), silent_after(30ms)),
                      crossings(level_row)),
              "lane: wire \"wire\": a node is silent after 30000 us, but must survive one lost beat, and "
              "beats come every 20000 us; write silent_after(...) of more than twice that");
}

TEST(SystemRefusals, name_unknown_and_duplicate_names) {
    EXPECT_EQ(refusal(across(data("c.giver.level", "b.taker.level"), every(10ms))),
              "lane: crossing \"c.giver.level\" -> \"b.taker.level\": there is no node \"c\"; add it to "
              "nodes(...)");
    EXPECT_EQ(refusal(across(data("a.giver.levle", "b.taker.level"), every(10ms))),
              "lane: crossing \"a.giver.levle\" -> \"b.taker.level\": in node \"a\" component \"giver\" has "
              "no output \"levle\"; did you mean \"level\"?");
    EXPECT_EQ(refusal(across(data("a.giver.level", "b"), every(10ms))),
              "lane: crossing \"a.giver.level\" -> \"b\": \"b\" is not of the form \"node.component.facet\"; "
              "name all three");
    EXPECT_EQ(refusal(presence("c", "a.giver.other_is_there")),
              "lane: presence of \"c\" -> \"a.giver.other_is_there\": there is no node \"c\"; add it to "
              "nodes(...)");
    EXPECT_EQ(refusal(presence("a", "b.taker.level")),
              "lane: presence of \"a\" -> \"b.taker.level\": \"b.taker.level\" is not an input of type bool; "
              "name one");
    EXPECT_EQ(refusal(level_row, level_row),
              of_level + " has the same number as \"a.giver.level\" -> \"b.taker.level\", or appears twice; "
                         "remove it, or rename a node");
}

TEST(SystemRefusals, name_invalid_values) {
    EXPECT_EQ(refusal(level()), of_level + " does not say how often it is sent; add every(10ms)");
    EXPECT_EQ(refusal(level(every(10ms))),
              of_level + ": its value takes 65 bits with its validity bit, but a frame has 52 for values; "
                         "send fewer: in_bits(32, 0.001) of a number, or a part of a record");
    EXPECT_EQ(refusal(level(every(10ms), in_bits(24, 0))),
              of_level + ": in_bits takes 1 to 56 bits and a finite step above 0");
    EXPECT_EQ(refusal(level(every(10ms), in_bits(24, std::numeric_limits<double>::infinity()))),
              of_level + ": in_bits takes 1 to 56 bits and a finite step above 0");
    EXPECT_EQ(refusal(across(buffer<4>("a.giver.level", "b.taker.level"), every(10ms))),
              of_level + ": a buffer does not cross a wire: emit an event for each value, which crosses with "
                         "when(\"...\", tell(\"...\")), or send the last one by data(...)");
    EXPECT_EQ(refusal(across(data("b.taker.level", "a.giver.level"), every(10ms))),
              "lane: crossing \"b.taker.level\" -> \"a.giver.level\": connection \"b.taker.level\" -> "
              "\"a.giver.level\" runs from an input to an output; exchange the two");
    EXPECT_EQ(refusal(across(data("a.giver.level", "a.giver.other_is_there"), every(10ms))),
              "lane: crossing \"a.giver.level\" -> \"a.giver.other_is_there\": connection \"a.giver.level\" "
              "-> \"a.giver.other_is_there\": \"a.giver.level\" is of type double but "
              "\"a.giver.other_is_there\" is of type bool; connect ports of one type");
}

TEST(SystemRefusals, name_invalid_events_and_commands) {
    EXPECT_EQ(refusal(across(when("a.giver.sent", call("b.taker.take")), at_most(1, 40ms), within(30ms))),
              of_sent + ": call(...) runs in the emitter, which is another machine's; write tell(...)");
    EXPECT_EQ(refusal(sent(within(30ms))),
              of_sent + " does not say how often it may happen; add at_most(1, 100ms)");
    EXPECT_EQ(refusal(sent(at_most(3, 40ms), within(30ms))),
              of_sent + " says at_most(3, ...): one is under way at a time; write at_most(1, ...) with the "
                        "least time between two");
    EXPECT_EQ(refusal(sent(at_most(1, 40ms))),
              of_sent + " does not say by when it must be served; add within(20ms)");
    EXPECT_EQ(refusal(sent(at_most(1, 20ms), within(30ms))),
              of_sent + " may follow after 20000 us, while the one before it may still be under way for "
                        "30000 us; write within(...) no longer than at_most(1, ...)");
    EXPECT_EQ(refusal(sent(at_most(1, 6ms), within(6ms))),
              of_sent +
                  " must be served within 6000 us, but 11000 us of that are the deadlines of the activities "
                  "that serve the wire and the operation; shorten those, or write a longer within(...)");
    EXPECT_EQ(refusal(sent(at_most(1, 40ms), within(30ms), if_lost("b.taker.take"))),
              of_sent + ": if_lost(\"b.taker.take\") names no operation without arguments of the emitter's "
                        "node; name one");
    EXPECT_EQ(refusal(across(uses("a.giver.doubled", "b.taker.take"), at_most(1, 100ms), within(20ms))),
              "lane: crossing \"a.giver.doubled\" -> \"b.taker.take\": \"b.taker.take\" is an operation, not "
              "a command");
    EXPECT_EQ(refusal(across(uses("a.giver.doubled", "b.taker.twice"), at_most(1, 100ms), within(20ms))),
              "lane: crossing \"a.giver.doubled\" -> \"b.taker.twice\": its results take 32 bits, and a "
              "frame has 24 for them; send them by data(...)");
}

TEST(SystemRefusals, name_typical_mistakes_of_newcomers) {
    EXPECT_EQ(refusal(sent(at_most(1, 40ms), within(30ms), in_bits(60))),
              of_sent + ": in_bits takes 1 to 56 bits and a finite step above 0");
    EXPECT_EQ(refusal(presence("b", "a.giver.other_is_there", stale_after(50ms))),
              "lane: presence of \"b\" -> \"a.giver.other_is_there\" has stale_after(...), but it becomes "
              "false instead of stale; remove that");
    EXPECT_EQ(refusal(level(every(10ms), in_bits(24, 0.1), within(5ms))),
              of_level +
                  " must arrive within 5000 us, but 11000 us of that are its every(...) and the deadline by "
                  "which the wire is served; shorten those, or write a longer within(...)");
    EXPECT_EQ(refusal(both_nodes, wire("wire", bit_rate(500'000), beats(20ms), silent_after(41ms)),
                      crossings(level_row)),
              "lane: wire \"wire\": a node must survive one lost beat, and the next one may then come after "
              "43352 us; write silent_after(...) of more than that");
    EXPECT_EQ(
        refusal(both_nodes, wire("wire", bit_rate(500'000), identifiers_from(0x7FE)), crossings(level_row)),
        "lane: wire \"wire\": 3 frames from identifier 2046 on go beyond the last of 11 bits; begin lower");
    EXPECT_EQ(refusal(both_nodes, good_wire, crossings(level_row, sent_row),
                      promises(reaction("a.giver.sent", "b.taker.level", within(1s),
                                        via("b.taker.take", "a.giver.level")))),
              "reaction \"a.giver.sent\" -> \"b.taker.level\": via(\"b.taker.take\", \"a.giver.level\") does "
              "not name two facets of one component of one node");
}

TEST(SystemRefusals, name_broken_promises_and_a_wire_that_is_too_slow) {
    EXPECT_EQ(
        refusal(both_nodes, good_wire, crossings(level_row, sent_row),
                promises(reaction("a.giver.sent", "b.taker.take", within(5ms)))),
        "reaction \"a.giver.sent\" -> \"b.taker.take\" may take 13622 us, but is promised within 5000 "
        "us; the largest part, 5000 us, is the period of activity \"taking\" at node \"b\"; shorten that, or "
        "promise less");
    EXPECT_EQ(refusal(both_nodes, good_wire, crossings(level_row),
                      promises(reaction("a.giver.sent", "b.taker.take", within(50ms)))),
              "reaction \"a.giver.sent\" -> \"b.taker.take\": no row leads from \"a.giver.sent\" to "
              "\"b.taker.take\"; add it, or name what lies between with via(\"in\", \"out\")");
    EXPECT_EQ(refusal(both_nodes, good_wire, crossings(level_row),
                      promises(stops("b", "a.giver.other_is_there", within(1s)))),
              "stops \"b\" -> \"a.giver.other_is_there\": nothing of node \"b\" reaches "
              "\"a.giver.other_is_there\"; add presence(\"b\", \"a.giver.other_is_there\")");
    EXPECT_EQ(
        refusal(both_nodes, wire("wire", bit_rate(10'000), beats(20ms), silent_after(70ms)),
                crossings(level_row)),
        "lane: the beat of node \"a\": a frame of it may never be sent on wire \"wire\", which all frames "
        "together load by 240 % at 10000 bit/s; send less, or less often, or run the wire faster");
    constexpr auto slow = wire("wire", bit_rate(125'000), beats(20ms), silent_after(70ms));
    EXPECT_EQ(refusal(both_nodes, slow, crossings(level_row, sent(at_most(1, 40ms), within(12ms)))),
              of_sent + ": a frame of it may still wait for wire \"wire\" when the next one follows, 6000 us "
                        "later; send less, or less often, run the wire faster, or give it more time");
    EXPECT_EQ(refusal(level_row, sent(at_most(1, 40ms), within(12ms))),
              of_sent + ": a frame of it may take 2832 us on wire \"wire\" and has 1000 us; send less, or "
                        "less often, run the wire faster, or give it more time");
}

} // namespace
} // namespace tappet::pair
