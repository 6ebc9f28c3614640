// A DBC file of 1.5 MB is read once, in little time, and a map looks at its own messages only.
#include "tests/drivers/can/dbc_on_host.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace tappet::can {
namespace {

constexpr int messages = 546, signals_of_each = 7;

std::string large_file() {
    std::string text = "BU_: a b us\nBA_DEF_DEF_ \"GenMsgCycleTime\" 10;\n", comments;
    for (int m = 0; m < messages; ++m) {
        const std::string id = std::to_string(100 + m);
        text += "BO_ " + id + " message_" + id + ": 8 " + (m % 2 == 0 ? "a" : "b") + "\n";
        for (int s = 0; s < signals_of_each; ++s) {
            const std::string name = "signal_" + std::to_string(s), place = std::to_string(8 * s);
            text += " SG_ " + name + " : " + place + "|8@1+ (0.5,0) [0|0] \"rpm\" " + (m == 5 ? "us" : "b") +
                    "\n";
            comments += "CM_ SG_ " + id + " " + name + " \"" + std::string(300, 'x') + "\";\nVAL_ " + id +
                        " " + name + " 0 \"standing\" 1 \"running\" 255 \"not available\" ;\n";
        }
    }
    return text + comments;
}

TEST(DbcLarge, is_read_once_and_looked_up) {
    const std::string text = large_file();
    ASSERT_GT(text.size(), 1'500'000u);
    const auto before = std::chrono::steady_clock::now();
    const tables::OwnTable own{dbc::read("t.dbc", text)};
    EXPECT_LT(std::chrono::steady_clock::now() - before, 2s);
    ASSERT_EQ(own.table.fault, "");
    ASSERT_EQ(own.table.messages.size(), std::size_t{messages});
    constexpr auto us = node("us", receive("message_100"), receive("message_600"));
    std::array<bool, messages> marks{};
    const dbc::Room room = dbc::mark_candidates(own.table, us.view(), marks.data());
    EXPECT_EQ(room.messages, 3u) << "two by their rows, one by its receivers";
    EXPECT_EQ(room.signals, 3u * signals_of_each);
    EXPECT_TRUE(marks[0] && marks[5] && marks[500]);
    const DbcMap read{text, us.view()};
    EXPECT_EQ(read.map.fault.view(), "");
    EXPECT_EQ(read.sizes.frames, 3u);
    EXPECT_EQ(read.map.signals[6].names[2].name, "not available");
}

} // namespace
} // namespace tappet::can
