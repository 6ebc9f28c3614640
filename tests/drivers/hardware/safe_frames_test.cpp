// What the guardian sends to its buses. The kernel's side of them is this file's own: a socket that confirms
// each frame that is written to it.
#include "drivers/can/link.hpp"
#include "drivers/hardware/open.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <deque>
#include <vector>

#include <dlfcn.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

namespace {

constexpr int bus = 777;

struct Kernel {
    std::deque<can_frame> unconfirmed{};
    std::size_t confirms = 1000; // so many more
    std::vector<canid_t> sent{};
} kernel;

template <class Function>
Function own(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

} // namespace

extern "C" {
int socket(int domain, int type, int protocol) noexcept {
    return domain == PF_CAN ? bus : own<int (*)(int, int, int)>("socket")(domain, type, protocol);
}
int setsockopt(int fd, int level, int name, const void* value, socklen_t size) noexcept {
    if (fd == bus) return 0;
    return own<int (*)(int, int, int, const void*, socklen_t)>("setsockopt")(fd, level, name, value, size);
}
int bind(int fd, const sockaddr* address, socklen_t size) noexcept {
    return fd == bus ? 0 : own<int (*)(int, const sockaddr*, socklen_t)>("bind")(fd, address, size);
}
int close(int fd) { return fd == bus ? 0 : own<int (*)(int)>("close")(fd); }
ssize_t write(int fd, const void* bytes, size_t size) {
    if (fd != bus) return own<ssize_t (*)(int, const void*, size_t)>("write")(fd, bytes, size);
    if (size != sizeof(can_frame)) return -1;
    std::memcpy(&kernel.unconfirmed.emplace_back(), bytes, sizeof(can_frame));
    kernel.sent.push_back(kernel.unconfirmed.back().can_id);
    return static_cast<ssize_t>(size);
}
ssize_t recvmsg(int fd, msghdr* message, int flags) {
    if (fd != bus) return own<ssize_t (*)(int, msghdr*, int)>("recvmsg")(fd, message, flags);
    if (kernel.unconfirmed.empty() || kernel.confirms == 0) {
        errno = EAGAIN;
        return -1;
    }
    std::memcpy(message->msg_iov->iov_base, &kernel.unconfirmed.front(), sizeof(can_frame));
    message->msg_flags = MSG_CONFIRM;
    kernel.unconfirmed.pop_front();
    --kernel.confirms;
    return sizeof(can_frame);
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

TEST(SafeFrames, are_not_confirmed_by_those_of_before) {
    std::array<can::Frame, 1> frame{};
    frame[0].id = 0x201;
    can::SafeSender sender;
    ASSERT_TRUE(sender.open("can0", frame));
    kernel.confirms = 0;
    sender.begin();
    sender.send(can::SafeSender::Purpose::earnest);
    EXPECT_EQ(sender.left(), 1u);
    sender.begin(); // the first one still waits at the bus
    sender.send(can::SafeSender::Purpose::earnest);
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 1u);
    kernel.confirms = 1;
    EXPECT_EQ(sender.left(), 0u);
}

} // namespace
} // namespace tappet
