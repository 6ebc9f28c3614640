// The frames of a system's wire, read by canmatrix from the exported DBC file.
#include "drivers/can/dbc/writer.hpp"
#include "tests/drivers/can/hex.hpp"
#include "tests/drivers/system/pair_run.hpp"
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

namespace tappet::pair {
namespace {

using testing::HasSubstr;

TEST(SystemDbc, is_read_with_its_frames_by_a_foreign_tool) {
    const auto& plan = systems::plan_of<pair>;
    PairRun both;
    std::array<can::Identifier, plan.frames.size()> all{};
    for (std::size_t f = 0; f < all.size(); ++f) all[f] = {plan.frames[f].id, false};
    can::Twin ear;
    ASSERT_TRUE(ear.open({.interface = "ear", .receive = all}));
    ASSERT_TRUE(both.run.wire().attach(ear));
    both.start();
    both.giver().tells = -123.44;
    both.giver().to_send = {77};
    both.run.run_for(60ms);
    std::string orders;
    const std::string file = testing::TempDir() + "pair_test.dbc";
    using Rows = systems::StationRows<pair, 0>;
    using Frames = can::AllFrames<systems::no_signals, Rows::services>;
    std::ofstream{file} << can::dbc::to_dbc("a", Frames::value.frames, Frames::value.signals);
    orders += "file " + file + "\\n";
    const std::uint32_t level = plan.frames[plan.place[0].frame].id,
                        sent = plan.frames[plan.place[1].frame].id;
    can::Frame frame, of_level, of_event;
    while (ear.receive(frame).what != can::Received::none) {
        if (frame.id == level) of_level = frame;
        if (frame.id == sent) of_event = frame;
    }
    orders += "decode " + std::to_string(level) + " 0 " + can::hex_of(of_level) + "\\n";
    orders += "decode " + std::to_string(sent) + " 0 " + can::hex_of(of_event) + "\\n";
    const Ended read = run_line("printf '" + orders + "' | /usr/bin/python3 " TAPPET_DBC_ORACLE);
    EXPECT_EQ(read.exit_code, 0) << read.text;
    EXPECT_THAT(read.text, HasSubstr("data_of_a_giver_level"));
    EXPECT_THAT(read.text, HasSubstr("end\t\n")) << "canmatrix has nothing to complain of";
    EXPECT_THAT(read.text, HasSubstr("a_giver_level=-1234;" + can::bits_of(-123.4)));
    EXPECT_THAT(read.text, HasSubstr("value=77;"));
    std::remove(file.c_str());
}

} // namespace
} // namespace tappet::pair
