// DBC files of some seeds as the compiler read them, beside the same reader at run time.
#include "tests/drivers/can/dbc_on_host.hpp"
#include "tests/drivers/can/generated_dbc.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

template <std::size_t F, std::size_t S, class Node>
void expect_same(const SignalMap<F, S>& compiled, std::string_view text, const Node& node) {
    ASSERT_EQ(compiled.fault.view(), "");
    const DbcMap read{text, node.view()};
    ASSERT_EQ(read.map.fault.view(), "");
    ASSERT_EQ(read.sizes.frames, F);
    ASSERT_EQ(read.sizes.signals, S);
    for (std::size_t f = 0; f < F; ++f) {
        EXPECT_EQ(compiled.frames[f].identifier, read.map.frames[f].identifier);
        EXPECT_EQ(compiled.frames[f].name, read.map.frames[f].name);
        EXPECT_EQ(compiled.frames[f].direction, read.map.frames[f].direction);
        EXPECT_EQ(compiled.frames[f].length, read.map.frames[f].length);
        EXPECT_EQ(compiled.frames[f].every, read.map.frames[f].every);
        EXPECT_EQ(compiled.frames[f].multiplexed, read.map.frames[f].multiplexed);
    }
    for (std::size_t s = 0; s < S; ++s) {
        const Signal& ours = compiled.signals[s];
        const Signal& theirs = read.map.signals[s];
        EXPECT_EQ(ours.name, theirs.name);
        EXPECT_EQ(ours.start, theirs.start);
        EXPECT_EQ(ours.bits, theirs.bits);
        EXPECT_EQ(ours.order, theirs.order);
        EXPECT_EQ(ours.kind, theirs.kind);
        EXPECT_EQ(ours.factor, theirs.factor);
        EXPECT_EQ(ours.offset, theirs.offset);
        EXPECT_EQ(ours.unit, theirs.unit);
        EXPECT_EQ(ours.has_range, theirs.has_range);
        EXPECT_EQ(ours.least, theirs.least);
        EXPECT_EQ(ours.most, theirs.most);
        EXPECT_EQ(compiled.multiplexor_of[s], read.map.multiplexor_of[s]);
        ASSERT_EQ(ours.selections.size(), theirs.selections.size());
        for (std::size_t i = 0; i < ours.selections.size(); ++i) {
            EXPECT_EQ(ours.selections[i].from, theirs.selections[i].from);
            EXPECT_EQ(ours.selections[i].to, theirs.selections[i].to);
        }
        ASSERT_EQ(ours.names.size(), theirs.names.size());
        for (std::size_t i = 0; i < ours.names.size(); ++i) {
            EXPECT_EQ(ours.names[i].value, theirs.names[i].value);
            EXPECT_EQ(ours.names[i].name, theirs.names[i].name);
        }
    }
}

TEST(DbcCompiled, is_what_the_reader_gives_at_run_time) {
    expect_same(generated::map_1, generated::file_1.text, generated::node_1);
    expect_same(generated::map_2, generated::file_2.text, generated::node_2);
    expect_same(generated::map_3, generated::file_3.text, generated::node_3);
    expect_same(generated::map_4, generated::file_4.text, generated::node_4);
    expect_same(generated::map_5, generated::file_5.text, generated::node_5);
    expect_same(generated::map_6, generated::file_6.text, generated::node_6);
}

} // namespace
} // namespace tappet::can
