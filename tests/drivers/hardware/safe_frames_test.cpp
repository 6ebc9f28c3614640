// The guardian's frames on CAN. This file stands in for the kernel: frames wait in a queue, and its bus
// confirms each frame to the socket that sent it.
#include "drivers/can/link.hpp"
#include "drivers/can/safe_sender.hpp"
#include "drivers/hardware/opened.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/sleep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <linux/can.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>
#include <unistd.h>

namespace {

constexpr int first_socket = 7770, last_socket = 7799;
constexpr bool is_socket(int fd) { return fd >= first_socket && fd <= last_socket; }

struct Kernel {
    struct Sent {
        int from;
        can_frame frame;
    };
    std::deque<Sent> unconfirmed{};
    std::size_t confirms = 1000; // so many more
    std::size_t room = 1000;
    bool has_sockets = true;
    int next_socket = first_socket;
    std::vector<canid_t> sent{};
    tappet::Time now{};
    tappet::Duration wire_time = tappet::Duration::max(), busy{};
    void pass(tappet::Duration time) {
        now += time;
        for (busy += time; busy >= wire_time; busy -= wire_time)
            confirms = std::min(confirms + 1, unconfirmed.size());
    }
} kernel;

template <class Function>
Function own(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

} // namespace

extern "C" {
int socket(int domain, int type, int protocol) noexcept {
    if (domain != PF_CAN) return own<int (*)(int, int, int)>("socket")(domain, type, protocol);
    if (kernel.has_sockets) return kernel.next_socket++;
    errno = ENFILE;
    return -1;
}
int setsockopt(int fd, int level, int name, const void* value, socklen_t size) noexcept {
    if (is_socket(fd)) return 0;
    return own<int (*)(int, int, int, const void*, socklen_t)>("setsockopt")(fd, level, name, value, size);
}
int getsockopt(int fd, int level, int name, void* value, socklen_t* size) noexcept {
    if (!is_socket(fd))
        return own<int (*)(int, int, int, void*, socklen_t*)>("getsockopt")(fd, level, name, value, size);
    std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
    memory[SK_MEMINFO_WMEM_ALLOC] =
        static_cast<std::uint32_t>(768 * std::ranges::count(kernel.unconfirmed, fd, &Kernel::Sent::from));
    std::memcpy(value, memory.data(), std::min<std::size_t>(*size, sizeof memory));
    return 0;
}
int bind(int fd, const sockaddr* address, socklen_t size) noexcept {
    return is_socket(fd) ? 0 : own<int (*)(int, const sockaddr*, socklen_t)>("bind")(fd, address, size);
}
int close(int fd) { return is_socket(fd) ? 0 : own<int (*)(int)>("close")(fd); }
ssize_t write(int fd, const void* bytes, size_t size) {
    if (!is_socket(fd)) return own<ssize_t (*)(int, const void*, size_t)>("write")(fd, bytes, size);
    if (size != sizeof(can_frame)) return -1;
    if (kernel.unconfirmed.size() >= kernel.room) {
        errno = ENOBUFS;
        return -1;
    }
    kernel.unconfirmed.push_back({.from = fd, .frame = {}});
    std::memcpy(&kernel.unconfirmed.back().frame, bytes, sizeof(can_frame));
    kernel.sent.push_back(kernel.unconfirmed.back().frame.can_id);
    return static_cast<ssize_t>(size);
}
// The bus confirms its next frames when a socket is read. A confirmation for another socket is dropped.
ssize_t recvmsg(int fd, msghdr* message, int flags) {
    if (!is_socket(fd)) return own<ssize_t (*)(int, msghdr*, int)>("recvmsg")(fd, message, flags);
    while (!kernel.unconfirmed.empty() && kernel.confirms > 0) {
        const Kernel::Sent next = kernel.unconfirmed.front();
        kernel.unconfirmed.pop_front();
        --kernel.confirms;
        if (next.from != fd) continue;
        std::memcpy(message->msg_iov->iov_base, &next.frame, sizeof next.frame);
        message->msg_flags = MSG_CONFIRM;
        return sizeof next.frame;
    }
    errno = EAGAIN;
    return -1;
}
}

namespace tappet {

namespace can {
std::expected<Link, Sentence> find_link(std::string_view) { return Link{}; }
} // namespace can
namespace os {
Time Clock::monotonic() noexcept { return kernel.now; }
void sleep_for(Duration time) noexcept { kernel.pass(time); }
} // namespace os

namespace {

/// A bus with only the part that makes it safe.
struct SafeBus : RealDevice {
    can::SafeSender sender{};
    std::expected<void, Sentence> open(const DevicePlace&) override { return {}; }
    ProvidedDevice provided(std::string_view) noexcept override { return {}; }
    void begin_safe_frames() noexcept override { sender.begin(); }
    void send_safe_frames() noexcept override { sender.send(can::SafeSender::Purpose::earnest); }
    std::size_t safe_frames_left() noexcept override { return sender.left(); }
};

TEST(SafeFrames, are_all_sent_again_on_a_second_request) {
    std::array<can::Frame, 2> frames{};
    frames[0].id = 0x201;
    frames[1].id = 0x202;
    SafeBus bus;
    ASSERT_TRUE(bus.sender.open("can0", frames));
    std::array<OpenedDevice, 1> buses{};
    buses[0].device = &bus;
    const std::vector<canid_t> all{0x201, 0x202};
    for (int n = 0; n < 2; ++n) {
        EXPECT_EQ(send_safe_frames(buses, 1h), 0u);
        EXPECT_EQ(std::exchange(kernel.sent, {}), all);
    }
}

class SafeFrame : public testing::Test {
protected:
    SafeFrame() {
        kernel = {};
        kernel.confirms = 0;
        frame[0].id = 0x201;
        EXPECT_TRUE(sender.open("can0", frame));
        send();
    }
    void send() {
        sender.begin();
        sender.send(can::SafeSender::Purpose::earnest);
    }
    std::array<can::Frame, 1> frame{};
    can::SafeSender sender;
};

TEST_F(SafeFrame, is_not_confirmed_by_the_confirmation_of_an_earlier_copy) {
    EXPECT_EQ(sender.left(), 1u);
    send(); // the first one still waits at the bus
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 1u);
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 0u);
}

TEST_F(SafeFrame, is_confirmed_though_the_kernel_dropped_an_earlier_copy) {
    kernel.unconfirmed.clear();
    send();
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 0u);
}

TEST_F(SafeFrame, is_confirmed_though_the_bus_sent_it_before_an_earlier_copy) {
    send();
    std::swap(kernel.unconfirmed[0], kernel.unconfirmed[1]);
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 0u);
}

TEST_F(SafeFrame, is_sent_but_unconfirmed_while_the_kernel_has_no_socket) {
    kernel.has_sockets = false;
    send();
    EXPECT_EQ(kernel.sent.size(), 2u);
    kernel.confirms = 2;
    EXPECT_EQ(sender.left(), 1u);
    kernel.has_sockets = true;
    send();
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 0u);
}

/// Behind the queue of a CAN interface.
struct QueuedFrames : testing::Test {
    QueuedFrames() {
        kernel = {};
        kernel.confirms = 0;
        kernel.room = 10;
    }
    void open(std::size_t count) {
        ids.clear();
        for (std::size_t i = 0; i < count; ++i) {
            frames[i].id = static_cast<canid_t>(0x200 + i);
            ids.push_back(frames[i].id);
        }
        EXPECT_TRUE(bus.sender.open("can0", std::span{frames}.first(count)));
    }
    std::array<can::Frame, can::SafeSender::most_frames> frames{};
    std::vector<canid_t> ids{};
    SafeBus bus{};
};

TEST_F(QueuedFrames, are_each_sent_once_on_a_slow_bus) {
    open(can::SafeSender::most_frames);
    for (const Duration wire_time : {540us, 1080us, 2700us, 5400us}) { // from 250 to 25 kbit/s
        kernel.wire_time = wire_time;
        std::array<OpenedDevice, 1> buses{};
        buses[0].device = &bus;
        EXPECT_EQ(send_safe_frames(buses, 500ms), 0u);
        EXPECT_EQ(std::exchange(kernel.sent, {}), ids);
    }
}

struct TwoFrames : QueuedFrames {
    TwoFrames() {
        open(2);
        bus.sender.begin();
    }
    std::size_t look(std::size_t confirms) {
        bus.sender.send(can::SafeSender::Purpose::earnest);
        kernel.confirms = confirms;
        return bus.sender.left();
    }
};

TEST_F(TwoFrames, are_not_repeated_while_they_are_queued) {
    EXPECT_EQ(look(0), 2u);
    for (int n = 0; n < 2; ++n) {
        os::sleep_for(can::SafeSender::repeat_after);
        EXPECT_EQ(look(0), 2u);
    }
    EXPECT_EQ(kernel.sent, ids);
    EXPECT_EQ(look(2), 0u);
}

TEST_F(TwoFrames, are_repeated_only_as_far_as_they_were_lost) {
    EXPECT_EQ(look(1), 1u);
    kernel.unconfirmed.clear(); // an interface that went down
    EXPECT_EQ(look(1), 1u);
    EXPECT_EQ(kernel.sent, ids) << "it may still stand in the controller";
    os::sleep_for(can::SafeSender::repeat_after);
    EXPECT_EQ(look(1), 0u);
    EXPECT_EQ(kernel.sent, (std::vector<canid_t>{0x200, 0x201, 0x201}));
}

} // namespace
} // namespace tappet
