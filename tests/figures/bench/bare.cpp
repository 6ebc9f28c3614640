// System calls and nothing else: ppoll, recvmsg with the kernel's stamp, write; ppoll, read, ioctl.
#include "tests/figures/bench/bare.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <linux/gpio.h>
#include <net/if.h>
#include <poll.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::figures::bench {

namespace {

struct CanTask {
    int socket = -1;
    std::uint32_t answer = 0;
} can_task;

struct LineTask {
    int lines = -1;
} line_task;

bool refuse(const char* what) {
    std::printf("%s: %s\n", what, std::strerror(errno));
    return false;
}

void* answer_frames(void*) {
    while (true) {
        pollfd polled{can_task.socket, POLLIN, 0};
        ppoll(&polled, 1, nullptr, nullptr);
        can_frame frame{};
        alignas(cmsghdr) char control[128];
        iovec place{&frame, sizeof frame};
        msghdr message{};
        message.msg_iov = &place;
        message.msg_iovlen = 1;
        message.msg_control = control;
        message.msg_controllen = sizeof control;
        if (recvmsg(can_task.socket, &message, MSG_DONTWAIT) != sizeof frame) continue;
        frame.can_id = can_task.answer;
        if (write(can_task.socket, &frame, sizeof frame) != sizeof frame) refuse("write");
    }
}

void* answer_edges(void*) {
    while (true) {
        pollfd polled{line_task.lines, POLLIN, 0};
        ppoll(&polled, 1, nullptr, nullptr);
        gpio_v2_line_event edge{};
        if (read(line_task.lines, &edge, sizeof edge) != sizeof edge) continue;
        gpio_v2_line_values values{};
        values.mask = 2; // the second of the request
        values.bits = edge.id == GPIO_V2_LINE_EVENT_RISING_EDGE ? 2 : 0;
        if (ioctl(line_task.lines, GPIO_V2_LINE_SET_VALUES_IOCTL, &values) != 0) refuse("set values");
    }
}

bool start(void* (*body)(void*), int priority) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
    sched_param parameters{};
    parameters.sched_priority = priority;
    pthread_attr_setschedparam(&attributes, &parameters);
    pthread_t thread{};
    errno = pthread_create(&thread, &attributes, body, nullptr);
    pthread_attr_destroy(&attributes);
    return errno == 0 || refuse("a thread");
}

} // namespace

int open_can(const char* interface, std::uint32_t one, std::uint32_t other) {
    const int made = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    const can_filter wanted[] = {{one, CAN_SFF_MASK}, {other, CAN_SFF_MASK}};
    const int on = 1;
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex(interface));
    // The interface of sockaddr is C's: one type stands for all.
    if (made >= 0 && setsockopt(made, SOL_CAN_RAW, CAN_RAW_FILTER, wanted, sizeof wanted) == 0 &&
        setsockopt(made, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) == 0 &&
        bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
        return made;
    refuse("a CAN socket");
    return -1;
}

bool start_bare_can(const char* interface, std::uint32_t request, std::uint32_t answer, int priority) {
    can_task = {open_can(interface, request, request), answer};
    return can_task.socket >= 0 && start(&answer_frames, priority);
}

bool start_bare_lines(const char* chip, unsigned in, unsigned out, int priority) {
    const int file = open(chip, O_RDWR | O_CLOEXEC);
    gpio_v2_line_request request{};
    request.offsets[0] = in;
    request.offsets[1] = out;
    request.num_lines = 2;
    std::strcpy(request.consumer, "bare");
    request.config.flags =
        GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING | GPIO_V2_LINE_FLAG_EDGE_FALLING;
    request.config.num_attrs = 1;
    request.config.attrs[0].mask = 2;
    request.config.attrs[0].attr.id = GPIO_V2_LINE_ATTR_ID_FLAGS;
    request.config.attrs[0].attr.flags = GPIO_V2_LINE_FLAG_OUTPUT;
    if (file < 0 || ioctl(file, GPIO_V2_GET_LINE_IOCTL, &request) != 0) return refuse("GPIO lines");
    close(file);
    line_task.lines = request.fd;
    return start(&answer_edges, priority);
}

} // namespace tappet::figures::bench
