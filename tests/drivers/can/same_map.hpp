// A signal map compared with the one read from a DBC text.
#pragma once

#include "tests/drivers/can/dbc_on_host.hpp"

#include <gtest/gtest.h>

namespace tappet::can {

enum class Places { the_same, any }; ///< of signals in the map

template <std::size_t F, std::size_t S>
void expect_same(const SignalMap<F, S>& map, const DbcMap& text, Places places = Places::the_same) {
    const auto& read = text.map;
    ASSERT_EQ(map.fault.view(), "");
    ASSERT_EQ(read.fault.view(), "");
    ASSERT_EQ(text.sizes.frames, F);
    ASSERT_EQ(text.sizes.signals, S);
    for (std::size_t f = 0; f < F; ++f) {
        EXPECT_EQ(read.frames[f].identifier, map.frames[f].identifier);
        EXPECT_EQ(read.frames[f].name, map.frames[f].name);
        EXPECT_EQ(read.frames[f].direction, map.frames[f].direction);
        EXPECT_EQ(read.frames[f].length, map.frames[f].length);
        EXPECT_EQ(read.frames[f].format, map.frames[f].format);
        EXPECT_EQ(read.frames[f].every, map.frames[f].every);
        EXPECT_EQ(read.frames[f].multiplexed, map.frames[f].multiplexed);
    }
    for (std::size_t s = 0; s < S; ++s) {
        const Signal& ours = map.signals[s];
        const std::size_t place =
            read.signal(std::string{map.frames[map.row_of[s]].name} + "." + std::string{ours.name});
        ASSERT_NE(place, no_such) << ours.name;
        if (places == Places::the_same) {
            EXPECT_EQ(place, s) << ours.name;
            EXPECT_EQ(read.multiplexor_of[s], map.multiplexor_of[s]);
        }
        const Signal& theirs = read.signals[place];
        EXPECT_EQ(theirs.start, ours.start);
        EXPECT_EQ(theirs.bits, ours.bits);
        EXPECT_EQ(theirs.order, ours.order);
        EXPECT_EQ(theirs.kind, ours.kind);
        EXPECT_EQ(theirs.factor, ours.factor);
        EXPECT_EQ(theirs.offset, ours.offset);
        EXPECT_EQ(theirs.unit, ours.unit);
        EXPECT_EQ(theirs.has_range, ours.has_range);
        EXPECT_EQ(theirs.least, ours.least);
        EXPECT_EQ(theirs.most, ours.most);
        EXPECT_EQ(theirs.multiplexor, ours.multiplexor);
        ASSERT_EQ(theirs.selections.size(), ours.selections.size());
        for (std::size_t i = 0; i < ours.selections.size(); ++i) {
            EXPECT_EQ(theirs.selections[i].from, ours.selections[i].from);
            EXPECT_EQ(theirs.selections[i].to, ours.selections[i].to);
        }
        ASSERT_EQ(theirs.names.size(), ours.names.size());
        for (std::size_t i = 0; i < ours.names.size(); ++i) {
            EXPECT_EQ(theirs.names[i].value, ours.names[i].value);
            EXPECT_EQ(theirs.names[i].name, ours.names[i].name);
        }
    }
}

} // namespace tappet::can
