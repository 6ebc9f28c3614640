// The real SocketCAN device on a real kernel's virtual bus, with can-utils as peers. Runs on the bench:
// interface can0.
#include "board/init/devices.hpp"
#include "drivers/can/safe_sender.hpp"
#include "tests/drivers/can/bench_bus.hpp"
#include "tests/drivers/can/hex.hpp"

#include <cstring>
#include <malloc.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace tappet::can {
namespace {

TEST_F(RealCan, receives_only_filtered_frames_with_the_time_stamp_of_the_kernel) {
    open();
    const Time before = now();
    for (const char* one :
         {"123#DEADBEEF", "124#00", "00000123#00", "123#R", "18FF0102#0102030405060708", "18FF0103#00"})
        ASSERT_EQ(run_foreign(std::string{"cansend can0 "} + one), 0);
    const Time after = now();
    const auto got = run_for(20ms);
    ASSERT_EQ(got.size(), 2u);
    EXPECT_EQ(got[0].id, 0x123u);
    EXPECT_EQ(got[0].length, 4);
    EXPECT_EQ(got[0].data, (Payload{0xDE, 0xAD, 0xBE, 0xEF}));
    EXPECT_EQ(got[1].id, 0x18FF0102u);
    EXPECT_TRUE(got[1].extended);
    for (const Frame& f : got) {
        EXPECT_GE(f.stamp, before);
        EXPECT_LE(f.stamp, after) << "stamped when it arrived, not when it was read";
    }
    EXPECT_LT(got[0].stamp, got[1].stamp);
}

TEST_F(RealCan, sends_frames_that_a_foreign_listener_sees_and_confirms_them) {
    open();
    const Dump dump;
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    EXPECT_TRUE(run_for(10ms).empty()) << "its own frame is a confirmation only";
    EXPECT_TRUE(dump.says("can0 201#ABCD"));
    EXPECT_EQ(can.counters().sent, 1u);
    EXPECT_EQ(can.state(), State::active);
}

TEST_F(RealCan, sends_a_burst_in_the_order_of_identifiers_with_few_frames_in_flight) {
    open();
    const Dump dump;
    for (std::uint32_t i = 64; i > 0; --i) ASSERT_EQ(can.send(frame(0x200 + i)), Send::queued);
    run_for(50ms);
    EXPECT_EQ(can.counters().sent, 64u);
    EXPECT_EQ(can.counters().dropped_stale, 0u);
    ASSERT_TRUE(dump.says("240#ABCD"));
    const std::string seen = dump.output();
    std::size_t last = 0;
    for (std::uint32_t i = 1; i <= 64; ++i) {
        char id[16];
        std::snprintf(id, sizeof id, " %X#", 0x200 + i);
        const std::size_t at = seen.find(id);
        ASSERT_NE(at, std::string::npos) << id;
        EXPECT_GT(at, last) << id;
        last = at;
    }
}

TEST_F(RealCan, reports_how_many_frames_an_overflow_lost) {
    settings.receive_buffer_bytes = 8192;
    open();
    ASSERT_EQ(run_foreign("cangen can0 -g 0 -n 500 -I 123 -L 8"), 0);
    std::uint64_t got = run_for(50ms).size();
    EXPECT_LT(got, 500u);
    ASSERT_EQ(run_foreign("cansend can0 123#00"), 0);
    got += run_for(10ms).size();
    EXPECT_GT(can.counters().lost_in_kernel, 0u);
    EXPECT_EQ(got + can.counters().lost_in_kernel, 501u);
}

TEST_F(RealCan, treats_bus_off_as_a_fault_until_an_explicit_restart) {
    settings.restarts_allowed = 1;
    open();
    const Dump dump;
    ASSERT_EQ(run_foreign("cansend can0 20000040#0000000000000000"), 0);
    EXPECT_EQ(can.send(frame(0x201)), Send::queued) << "the machine does not know yet";
    Frame f;
    ASSERT_EQ(can.receive(f).what, Received::error_frame);
    EXPECT_EQ(can.state(), State::bus_off);
    EXPECT_EQ(can.send(frame(0x202)), Send::refused_fault);
    run_for(100ms);
    EXPECT_EQ(can.state(), State::bus_off);
    EXPECT_EQ(can.counters().sent, 0u);

    const Time made_before = now();
    EXPECT_EQ(can.restart(), Restart::done);
    run_for(5ms);
    EXPECT_EQ(can.state(), State::active);
    EXPECT_EQ(can.send(frame(0x203, made_before)), Send::refused_stale);
    EXPECT_EQ(can.send(frame(0x204)), Send::queued);
    run_for(20ms);
    EXPECT_EQ(can.counters().sent, 1u);
    EXPECT_EQ(can.counters().restarts, 1u);

    ASSERT_EQ(run_foreign("cansend can0 20000040#0000000000000000"), 0);
    run_for(20ms);
    EXPECT_EQ(can.state(), State::bus_off);
    EXPECT_EQ(can.restart(), Restart::exhausted);
    for (const char* never_sent : {" 201#", " 202#", " 203#"})
        EXPECT_EQ(dump.output().find(never_sent), std::string::npos) << never_sent;
}

TEST_F(RealCan, detects_an_interface_that_goes_down_and_idles_meanwhile) {
    open();
    set_up(false);
    run_for(10ms);
    EXPECT_EQ(can.state(), State::down);
    std::uint64_t wakes = 0;
    for (const Time end = now() + 200ms; now() < end;) {
        Frame f;
        EXPECT_EQ(can.receive(f).what, Received::none);
        can.service(now());
        std::this_thread::sleep_for(10ms);
        ++wakes;
    }
    EXPECT_LE(wakes, 25u);
    EXPECT_EQ(can.counters().faults, 1u) << "one fault, however often it is looked at";
    EXPECT_EQ(can.next_service(), never);
    EXPECT_EQ(can.restart(), Restart::done);
    run_for(5ms);
    EXPECT_EQ(can.state(), State::active);
    EXPECT_EQ(can.send(frame(0x205)), Send::queued);
    run_for(20ms);
    EXPECT_EQ(can.counters().sent, 1u);
}

TEST_F(RealCan, reports_error_passive_and_active_and_keeps_sending) {
    open();
    ASSERT_EQ(run_foreign("cansend can0 20000004#0020000000008000"), 0); // transmit error passive
    run_for(10ms);
    EXPECT_EQ(can.state(), State::passive);
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    ASSERT_EQ(run_foreign("cansend can0 20000004#0040000000000000"), 0);
    run_for(10ms);
    EXPECT_EQ(can.state(), State::active);
    EXPECT_EQ(can.counters().sent, 1u);
}

TEST_F(RealCan, is_not_woken_by_a_storm_of_bus_errors) {
    open();
    for (int i = 0; i < 20; ++i) ASSERT_EQ(run_foreign("cansend can0 20000088#0000000000000000"), 0);
    run_for(10ms);
    EXPECT_EQ(can.counters().error_frames, 0u);
}

TEST_F(RealCan, accepts_its_own_frame_as_confirmation_though_it_receives_that_identifier) {
    static constexpr std::array both{standard(0x123), standard(0x201)};
    settings.receive = both;
    open();
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    EXPECT_TRUE(run_for(10ms).empty());
    EXPECT_EQ(can.counters().sent, 1u);
    EXPECT_EQ(can.counters().impostors, 0u);
}

TEST_F(RealCan, counts_an_impostor) {
    open();
    ASSERT_EQ(run_foreign("cansend can0 201#11"), 0);
    EXPECT_TRUE(run_for(10ms).empty());
    EXPECT_EQ(can.counters().impostors, 1u);
}

TEST_F(RealCan, allocates_nothing_while_it_runs) {
    open();
    ASSERT_EQ(run_foreign("cangen can0 -g 0 -n 100 -I 123 -L 8"), 0);
    const auto before = ::mallinfo2().uordblks;
    Frame f;
    std::uint64_t got = 0;
    for (int i = 0; i < 1000; ++i) {
        can.send(frame(0x200));
        if (can.receive(f).what == Received::frame) ++got;
        can.service(now());
    }
    EXPECT_EQ(::mallinfo2().uordblks, before);
    EXPECT_EQ(got, 100u);
}

TEST_F(RealCan, receives_no_can_fd_frame_without_can_fd_in_its_map) {
    open();
    ASSERT_EQ(run_foreign("cansend can0 123##1DEADBEEF"), 0);
    ASSERT_EQ(run_foreign("cansend can0 123#DEADBEEF"), 0);
    const auto got = run_for(20ms);
    ASSERT_EQ(got.size(), 1u);
    EXPECT_FALSE(got[0].fd);
    Frame fast = frame(0x201);
    fast.fd = true;
    EXPECT_EQ(can.send(fast), Send::refused_invalid);
}

struct RealCanFd : RealCan {
    RealCanFd() {
        settings.takes_fd = true;
        settings.data_bit_rate = 2'000'000;
    }
    /// Returns the flags shown for that frame; newer kernels add one for CAN FD (4). -1: the frame is not
    /// shown.
    static int flags_of(const Foreign& dump, const Frame& f) {
        char head[16];
        std::snprintf(head, sizeof head, " %X##", f.id);
        if (!dump.says(digits(f))) return -1;
        const std::string seen = dump.output();
        const std::size_t at = seen.find(head);
        const std::size_t flags = at == seen.npos ? at : at + std::strlen(head);
        if (flags == seen.npos || seen.substr(flags + 1, 2u * f.length) != digits(f)) return -1;
        return (seen[flags] - '0') & ~4;
    }
    static std::string digits(const Frame& f) { return hex_of(f, "0123456789ABCDEF"); }
};

TEST_F(RealCanFd, receives_foreign_frames_of_every_length_and_format) {
    open();
    const auto sent = [](Format format, std::uint8_t length) {
        return numbered(standard(0x123), format, length);
    };
    const std::array all{sent(Format::flexible_faster, 64), sent(Format::flexible, 48),
                         sent(Format::flexible_faster, 12), sent(Format::flexible_faster, 0),
                         sent(Format::classical, 8)};
    for (const Frame& f : all)
        ASSERT_EQ(run_foreign("cansend can0 123" +
                              std::string{f.fd ? (f.bit_rate_switch ? "##1" : "##0") : "#"} + digits(f)),
                  0);
    const auto got = run_for(20ms);
    ASSERT_EQ(got.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(format_of(got[i]), format_of(all[i])) << i;
        EXPECT_EQ(got[i].length, all[i].length);
        EXPECT_EQ(got[i].data, all[i].data);
    }
    ASSERT_EQ(run_foreign("cansend can0 123##300"), 0);
    const auto passive = run_for(20ms);
    ASSERT_EQ(passive.size(), 1u);
    EXPECT_TRUE(passive[0].error_state_indicator);
}

TEST_F(RealCanFd, sends_frames_that_a_foreign_listener_sees_and_confirms_them) {
    open();
    const Dump dump;
    const Frame fast = numbered(standard(0x201), Format::flexible_faster),
                slow = numbered(standard(0x202), Format::flexible, 32);
    EXPECT_EQ(can.send(fast), Send::queued);
    EXPECT_EQ(can.send(slow), Send::queued);
    EXPECT_EQ(can.send(frame(0x203)), Send::queued);
    EXPECT_TRUE(run_for(10ms).empty()) << "its own frames are confirmations only";
    EXPECT_EQ(flags_of(dump, fast), CANFD_BRS);
    EXPECT_EQ(flags_of(dump, slow), 0);
    EXPECT_TRUE(dump.says("can0 203#ABCD"));
    EXPECT_EQ(can.counters().sent, 3u);
    EXPECT_EQ(can.send(numbered(standard(0x201), Format::flexible, 13)), Send::refused_invalid);
}

TEST_F(RealCanFd, confirms_its_safe_frames_after_the_end_of_the_machine) {
    const std::array safe{numbered(standard(0x201), Format::flexible_faster), frame(0x202)};
    SafeSender sender;
    const auto opened = sender.open("can0", safe);
    ASSERT_TRUE(opened) << opened.error().view();
    const Dump dump;
    sender.send(SafeSender::Purpose::rehearsal);
    EXPECT_EQ(sender.left(), 2u);
    for (int n = 0; n < 2; ++n) {
        sender.begin();
        EXPECT_EQ(sender.left(), 2u);
        sender.send(SafeSender::Purpose::earnest);
        EXPECT_EQ(sender.left(), 0u);
        EXPECT_EQ(flags_of(dump, safe[0]), CANFD_BRS);
        EXPECT_TRUE(dump.says("can0 202#ABCD"));
    }
}

TEST_F(RealCanFd, refuses_a_classical_interface_and_says_the_cure) {
    const auto set_mtu = [](int mtu) {
        const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
        ifreq request{};
        std::strcpy(request.ifr_name, "can0");
        request.ifr_mtu = mtu;
        set_up(false);
        ASSERT_EQ(::ioctl(fd, SIOCSIFMTU, &request), 0);
        set_up(true);
        ::close(fd);
    };
    set_mtu(16);
    const std::string cure =
        "CAN interface \"can0\" carries classical frames only (mtu 16, of CAN FD 72), and its "
        "bus has CAN FD: set it down, and up again after ip link set can0 mtu 72";
    const auto opened = can.open(settings);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().view(), cure);
    const std::array safe{numbered(standard(0x201), Format::flexible_faster)};
    SafeSender sender;
    const auto rehearsed = sender.open("can0", safe);
    ASSERT_FALSE(rehearsed);
    EXPECT_EQ(rehearsed.error().view(), cure);
    settings.takes_fd = false;
    open();
    set_mtu(72);
}

TEST_F(RealCan, refuses_an_interface_that_is_down_and_says_the_cure) {
    set_up(false);
    const auto opened = can.open(settings);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().view(), "CAN interface \"can0\" is down: set it up (ip link set can0 up)");
    set_up(true);
    open();
}

} // namespace
} // namespace tappet::can
