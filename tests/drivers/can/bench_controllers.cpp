// The real SocketCAN device on controllers with Linux's own drivers, which QEMU emulates: two on one bus, of
// classical CAN (SJA1000) and of CAN FD (CTU CAN FD). Bit rates are set as a box's init sets them. An
// emulated bus has no bit times, always acknowledges and spoils nothing, so no controller turns passive or
// goes off it.
#include "board/init/devices.hpp"
#include "drivers/can/safe_sender.hpp"
#include "tests/drivers/can/bench_frames.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sched.h>
#include <string>
#include <thread>
#include <vector>

namespace tappet::can {
namespace {

constexpr auto& machine_sends = from_200<64>;
constexpr std::array node_sends{standard(0x181), extended(0x18FF0102)};

/// In the order of their names.
std::vector<std::string> interfaces_of(std::string_view driver) {
    std::vector<std::string> found;
    for (const auto& each : std::filesystem::directory_iterator{"/sys/class/net"}) {
        std::error_code none;
        const auto link = std::filesystem::read_symlink(each.path() / "device/driver", none);
        if (!none && link.filename() == driver) found.push_back(each.path().filename());
    }
    std::ranges::sort(found);
    return found;
}

Frame frame(Identifier id, std::uint8_t length = 8, Format format = Format::classical) {
    return numbered(id, format, length);
}

struct Controllers : testing::Test {
    explicit Controllers(std::string_view driver, std::uint32_t data_bit_rate = 0) {
        const auto found = interfaces_of(driver);
        EXPECT_EQ(found.size(), 2u) << "is the card there? --can-card";
        if (found.size() != 2) return;
        at_machine = found[0], at_node = found[1];
        set(500'000, data_bit_rate);
        settings.interface = at_machine;
        settings.data_bit_rate = data_bit_rate;
        settings.takes_fd = data_bit_rate != 0;
    }
    void set(std::uint32_t bit_rate, std::uint32_t data_bit_rate) {
        for (const std::string& each : {at_machine, at_node}) {
            EXPECT_TRUE(init::set_link(each, false));
            const auto rates = init::set_bit_rates(each, bit_rate, data_bit_rate);
            EXPECT_TRUE(rates) << rates.error();
            EXPECT_TRUE(init::set_link(each, true));
        }
    }
    virtual std::expected<void, Sentence> open(SocketCan& end, const Settings& its) { return end.open(its); }
    void open() {
        Settings other = settings;
        other.interface = at_node;
        std::swap(other.receive, other.transmit);
        for (const auto& [end, its] : {std::pair{&machine, settings}, {&node, other}}) {
            const auto opened = open(*end, its);
            ASSERT_TRUE(opened) << opened.error().view();
        }
    }
    std::string refusal() {
        const auto opened = open(machine, settings);
        EXPECT_FALSE(opened);
        return opened ? "" : std::string{opened.error().view()};
    }
    /// Omits the stamp and what only a receiver learns of a frame.
    static void expect_same(const Frame& got, const Frame& sent) {
        EXPECT_EQ(got.id, sent.id);
        EXPECT_EQ(got.extended, sent.extended);
        EXPECT_EQ(got.length, sent.length);
        EXPECT_EQ(format_of(got), format_of(sent));
        EXPECT_EQ(got.data, sent.data);
    }

    std::string at_machine, at_node;
    Settings settings{
        .receive = node_sends, .transmit = machine_sends, .max_age = 500ms, .bit_rate = 500'000};
    SocketCan machine, node;
};

struct Sja1000 : Controllers {
    Sja1000() : Controllers{"kvaser_pci"} {}
};

TEST_F(Sja1000, runs_at_the_bit_rate_set_by_the_box) {
    open();
    EXPECT_EQ(machine.found().view(),
              "CAN interface \"" + at_machine + "\" runs at 500000 bit/s, error active");
    settings.bit_rate = 250'000;
    EXPECT_EQ(refusal(),
              "CAN interface \"" + at_machine +
                  "\" runs at 500000 bit/s, the board says 250000: correct one of them (ip link set " +
                  at_machine + " type can bitrate ...)");
    set(250'000, 0);
    open();
}

TEST_F(Sja1000, refuses_bit_rates_that_its_clock_cannot_make_and_can_fd) {
    EXPECT_TRUE(init::set_link(at_machine, false));
    const auto slow = init::set_bit_rates(at_machine, 7, 0);
    ASSERT_FALSE(slow);
    EXPECT_TRUE(slow.error().contains("set 7 bit/s on CAN interface " + at_machine)) << slow.error();
    const auto fast = init::set_bit_rates(at_machine, 500'000, 2'000'000);
    ASSERT_FALSE(fast);
    EXPECT_TRUE(fast.error().contains("CAN FD at 2000000 bit/s, on CAN interface " + at_machine))
        << fast.error();
    EXPECT_TRUE(init::set_link(at_machine, true)) << "as it was set before";
}

TEST_F(Sja1000, carries_frames_both_ways_and_confirms_them) {
    open();
    std::vector<Frame> sent;
    for (std::size_t i = machine_sends.size(); i > 0; --i) {
        sent.push_back(frame(machine_sends[i - 1], static_cast<std::uint8_t>(i % 9)));
        ASSERT_EQ(machine.send(sent.back()), Send::queued);
    }
    for (const Identifier& each : node_sends) ASSERT_EQ(node.send(frame(each)), Send::queued);
    std::vector<Frame> at_machine_end, at_node_end;
    const auto add = [](std::vector<Frame>& all, const std::vector<Frame>& more) {
        all.insert(all.end(), more.begin(), more.end());
    };
    for (int i = 0; i < 50 && machine.counters().sent < sent.size(); ++i) {
        add(at_machine_end, heard_by(machine, 2ms));
        add(at_node_end, heard_by(node, 2ms));
    }
    add(at_machine_end, heard_by(machine, 5ms));
    add(at_node_end, heard_by(node, 5ms));
    EXPECT_EQ(machine.counters().sent, sent.size());
    EXPECT_EQ(node.counters().sent, node_sends.size());
    std::ranges::reverse(sent); // the most urgent one first
    ASSERT_EQ(at_node_end.size(), sent.size());
    for (std::size_t i = 0; i < sent.size(); ++i) expect_same(at_node_end[i], sent[i]);
    ASSERT_EQ(at_machine_end.size(), node_sends.size());
    for (std::size_t i = 0; i < node_sends.size(); ++i) expect_same(at_machine_end[i], frame(node_sends[i]));
    EXPECT_EQ(machine.counters().impostors + node.counters().impostors, 0u);
}

TEST_F(Sja1000, restarts_by_down_and_up_with_its_bit_rate) {
    open();
    EXPECT_TRUE(init::set_link(at_machine, false));
    heard_by(machine, 5ms);
    EXPECT_EQ(machine.state(), State::down);
    EXPECT_EQ(machine.send(frame(machine_sends[0])), Send::refused_fault);
    EXPECT_EQ(machine.restart(), Restart::done);
    heard_by(machine, 5ms);
    EXPECT_EQ(machine.state(), State::active);
    EXPECT_EQ(machine.send(frame(machine_sends[1])), Send::queued);
    heard_by(machine, 10ms);
    EXPECT_EQ(machine.counters().sent, 1u);
    EXPECT_EQ(heard_by(node, 5ms).size(), 1u);
    const auto link = find_link(at_machine);
    ASSERT_TRUE(link);
    EXPECT_EQ(link->bit_rate, 500'000u);
}

/// While it lives, interrupts of an interface delay everything else.
class LateInterrupts {
public:
    explicit LateInterrupts(const std::string& interface) {
        for (const auto& each : std::filesystem::directory_iterator{"/proc"}) {
            const std::string name = init::read_line((each.path() / "comm").string());
            if (name.starts_with("irq/") && name.ends_with("-" + interface))
                thread_ = std::atoi(each.path().filename().c_str());
        }
        EXPECT_NE(thread_, 0) << "no interrupt thread of " << interface;
        set(thread_, 1);
        set(0, 10); // below that of the other interface
    }
    ~LateInterrupts() {
        set(thread_, 50);
        const sched_param usual{};
        ::sched_setscheduler(0, SCHED_OTHER, &usual);
    }
    LateInterrupts(const LateInterrupts&) = delete;
    LateInterrupts& operator=(const LateInterrupts&) = delete;

private:
    static void set(pid_t thread, int priority) {
        const sched_param parameter{priority};
        EXPECT_EQ(::sched_setscheduler(thread, SCHED_FIFO, &parameter), 0);
    }
    pid_t thread_ = 0;
};

TEST_F(Sja1000, reports_frames_lost_in_the_controller_by_an_error_frame) {
    open();
    {
        const LateInterrupts late{at_machine};
        for (int i = 0; i < 20; ++i) {
            EXPECT_EQ(node.send(frame(node_sends[0]), Keep::every), Send::queued);
            node.service(now());
            Frame f;
            for (int n = 0; n < 10'000 && node.counters().sent <= static_cast<std::uint64_t>(i); ++n) {
                static_cast<void>(node.receive(f));
                node.service(now());
            }
        }
        EXPECT_EQ(node.counters().sent, 20u);
    }
    std::size_t frames = 0, overruns = 0;
    for (const Time until = now() + 50ms; now() < until;) {
        Frame f;
        const Receive got = machine.receive(f);
        frames += got.what == Received::frame;
        overruns += got.what == Received::error_frame && f.error.overrun;
        machine.service(now());
        if (got.what == Received::none) std::this_thread::sleep_for(1ms);
    }
    EXPECT_GT(frames, 0u);
    EXPECT_LT(frames, 20u) << "its 64 bytes hold a few";
    EXPECT_GT(overruns, 0u);
    EXPECT_EQ(machine.counters().error_frames, overruns);
    EXPECT_EQ(machine.state(), State::active) << "the bus is well";
    EXPECT_EQ(node.send(frame(node_sends[0])), Send::queued);
    heard_by(node, 5ms);
    EXPECT_EQ(heard_by(machine, 5ms).size(), 1u);
}

TEST_F(Sja1000, is_refused_for_a_map_with_can_fd_frames) {
    settings.takes_fd = true;
    settings.data_bit_rate = 2'000'000;
    EXPECT_EQ(refusal(),
              "CAN interface \"" + at_machine +
                  "\" carries classical frames only (mtu 16, of CAN FD 72), and its bus has CAN FD: set "
                  "it down, and up again after ip link set " +
                  at_machine +
                  " type can bitrate ... dbitrate ... fd on; its controller must be one for CAN FD");
}

struct CtuCanFd : Controllers {
    CtuCanFd() : Controllers{"ctucanfd", 2'000'000} {}
    using Controllers::open;
    /// Linux's driver reports "active" when the controller says so, which the emulated one never does.
    std::expected<void, Sentence> open(SocketCan& end, const Settings& its) override {
        auto link = find_link(its.interface);
        if (!link) return std::unexpected{link.error()};
        if (link->up && link->state == State::down) link->state = State::active;
        return end.open(its, *link);
    }
};

TEST_F(CtuCanFd, runs_at_both_bit_rates_set_by_the_box) {
    open();
    EXPECT_EQ(machine.found().view(), "CAN interface \"" + at_machine +
                                          "\" runs at 500000 bit/s, CAN FD at 2000000 bit/s, error active");
    settings.data_bit_rate = 4'000'000;
    EXPECT_EQ(refusal(),
              "CAN interface \"" + at_machine +
                  "\" runs at 2000000 bit/s in CAN FD's data phase, the board says 4000000: correct one "
                  "of them (ip link set " +
                  at_machine + " type can dbitrate ... fd on)");
}

TEST_F(CtuCanFd, carries_frames_of_every_format_both_ways_and_confirms_them) {
    open();
    std::vector<Frame> sent;
    std::size_t i = 0;
    for (const int length : {0, 8, 12, 16, 20, 24, 32, 48, 64})
        for (const Format format : {Format::flexible, Format::flexible_faster})
            sent.push_back(frame(machine_sends[i++], static_cast<std::uint8_t>(length), format));
    sent.push_back(frame(machine_sends[i++]));
    std::vector<Frame> got;
    for (const Frame& each : sent) {
        Frame fresh = each;
        fresh.stamp = now();
        ASSERT_EQ(machine.send(fresh), Send::queued);
        heard_by(machine, 2ms);
        for (const Frame& one : heard_by(node, 2ms)) got.push_back(one);
    }
    EXPECT_EQ(machine.counters().sent, sent.size());
    ASSERT_EQ(got.size(), sent.size());
    for (std::size_t n = 0; n < sent.size(); ++n) expect_same(got[n], sent[n]);
    const Frame answer = frame(node_sends[1], 64, Format::flexible_faster);
    ASSERT_EQ(node.send(answer), Send::queued);
    heard_by(node, 5ms);
    const auto back = heard_by(machine, 5ms);
    ASSERT_EQ(back.size(), 1u);
    expect_same(back[0], answer);
    EXPECT_EQ(node.counters().sent, 1u);
}

TEST_F(CtuCanFd, confirms_its_safe_frames_after_the_end_of_the_machine) {
    open();
    const std::array safe{frame(machine_sends[0], 64, Format::flexible_faster), frame(machine_sends[1])};
    SafeSender sender;
    const auto opened = sender.open(at_machine, safe);
    ASSERT_TRUE(opened) << opened.error().view();
    sender.send(SafeSender::Purpose::earnest);
    const auto got = heard_by(node, 10ms);
    ASSERT_EQ(got.size(), 2u);
    expect_same(got[0], safe[0]);
    expect_same(got[1], safe[1]);
    // The emulated controller's driver may notice the second loss only with the next frame; that one is sent
    // again.
    for (int i = 0; i < 10 && sender.left() != 0; ++i) {
        sender.send(SafeSender::Purpose::earnest);
        std::this_thread::sleep_for(SafeSender::repeat_after);
    }
    EXPECT_EQ(sender.left(), 0u);
}

} // namespace
} // namespace tappet::can
