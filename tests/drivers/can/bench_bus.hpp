// The real SocketCAN device on the bench's interface can0, whose frames can-utils show.
#pragma once

#include "board/init/devices.hpp"
#include "tests/drivers/can/bench_frames.hpp"
#include "tests/drivers/foreign.hpp"

#include <gtest/gtest.h>

namespace tappet::can {

inline constexpr std::array receives{standard(0x123), extended(0x18FF0102)};
inline constexpr auto& sends = from_200<65>;

inline Frame frame(std::uint32_t id, Time made = now()) {
    return {.id = id, .length = 2, .data = {0xAB, 0xCD}, .stamp = made};
}

inline void set_up(bool up) { ASSERT_TRUE(init::set_link("can0", up)); }

struct Dump : Foreign {
    Dump() : Foreign{"candump -L can0"} { std::this_thread::sleep_for(200ms); }
};

struct RealCan : testing::Test {
    Settings settings{.interface = "can0", .receive = receives, .transmit = sends, .bit_rate = 500'000};
    SocketCan can;
    void open() {
        const auto opened = can.open(settings);
        ASSERT_TRUE(opened) << opened.error().view();
    }
    std::vector<Frame> run_for(Duration how_long) { return heard_by(can, how_long); }
};

} // namespace tappet::can
