// The guardian's frames on CAN. This file stands in for the kernel: its bus confirms each frame to the socket
// that sent it.
#include "drivers/can/link.hpp"
#include "drivers/hardware/open.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <deque>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <linux/can.h>
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
    bool has_sockets = true;
    int next_socket = first_socket;
    std::vector<canid_t> sent{};
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
int bind(int fd, const sockaddr* address, socklen_t size) noexcept {
    return is_socket(fd) ? 0 : own<int (*)(int, const sockaddr*, socklen_t)>("bind")(fd, address, size);
}
int close(int fd) { return is_socket(fd) ? 0 : own<int (*)(int)>("close")(fd); }
ssize_t write(int fd, const void* bytes, size_t size) {
    if (!is_socket(fd)) return own<ssize_t (*)(int, const void*, size_t)>("write")(fd, bytes, size);
    if (size != sizeof(can_frame)) return -1;
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

namespace {

TEST(SafeFrames, are_all_sent_once_more_when_they_are_asked_for_again) {
    std::array<can::Frame, 2> frames{};
    frames[0].id = 0x201;
    frames[1].id = 0x202;
    std::array<can::SafeSender, 1> buses;
    ASSERT_TRUE(buses[0].open("can0", frames));
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

TEST_F(SafeFrame, is_not_confirmed_by_that_of_before) {
    EXPECT_EQ(sender.left(), 1u);
    send(); // the first one still waits at the bus
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 1u);
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 0u);
}

TEST_F(SafeFrame, is_confirmed_though_the_kernel_dropped_that_of_before) {
    kernel.unconfirmed.clear();
    send();
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 0u);
}

TEST_F(SafeFrame, is_confirmed_though_the_bus_sent_it_before_that_of_before) {
    send();
    std::swap(kernel.unconfirmed[0], kernel.unconfirmed[1]);
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 0u);
}

TEST_F(SafeFrame, is_sent_and_never_confirmed_while_the_kernel_has_no_socket_for_it) {
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

} // namespace
} // namespace tappet
