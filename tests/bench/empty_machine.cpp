// SPDX-License-Identifier: Apache-2.0
// The smallest program for the bench: a static one that checks what every machine there relies on, and names
// missing parts.

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>

#include <fcntl.h>
#include <gpiod.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace {

int failures = 0;

void check(bool good, const char* what) {
    std::printf("%s: %s\n", what, good ? "yes" : "no");
    failures += good ? 0 : 1;
}

bool kernel_is_realtime() {
    std::FILE* file = std::fopen("/sys/kernel/realtime", "r");
    const bool yes = file != nullptr && std::fgetc(file) == '1';
    if (file != nullptr) {
        std::fclose(file);
    }
    return yes;
}

// A frame sent on one socket arrives at another.
bool can_works(const char* interface) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(interface));
    if (address.can_ifindex == 0) {
        return false;
    }
    std::array<int, 2> sockets{};
    for (int& socket : sockets) {
        socket = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
        // The interface of sockaddr is C's: one type stands for all.
        if (socket < 0 || ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
            return false;
        }
    }
    can_frame sent{};
    sent.can_id = 0x123;
    sent.can_dlc = 4;
    sent.data[0] = 0xA5;
    can_frame received{};
    const bool exchanged = ::write(sockets[0], &sent, sizeof sent) == sizeof sent &&
                           ::read(sockets[1], &received, sizeof received) == sizeof received;
    ::close(sockets[0]);
    ::close(sockets[1]);
    return exchanged && received.can_id == sent.can_id && received.data[0] == 0xA5;
}

std::size_t gpio_lines(const char* path) {
    gpiod_chip* chip = gpiod_chip_open(path);
    if (chip == nullptr) {
        return 0;
    }
    gpiod_chip_info* info = gpiod_chip_get_info(chip);
    const std::size_t lines = info != nullptr ? gpiod_chip_info_get_num_lines(info) : 0;
    gpiod_chip_info_free(info);
    gpiod_chip_close(chip);
    return lines;
}

// The worst lateness of a thread of the highest priority class that wakes every millisecond.
long worst_lateness_ns(int cycles) {
    timespec due{};
    ::clock_gettime(CLOCK_MONOTONIC, &due);
    long worst = 0;
    for (int i = 0; i < cycles; ++i) {
        due.tv_nsec += 1'000'000;
        if (due.tv_nsec >= 1'000'000'000) {
            due.tv_nsec -= 1'000'000'000;
            ++due.tv_sec;
        }
        ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
        timespec now{};
        ::clock_gettime(CLOCK_MONOTONIC, &now);
        worst = std::max(worst, (now.tv_sec - due.tv_sec) * 1'000'000'000 + now.tv_nsec - due.tv_nsec);
    }
    return worst;
}

} // namespace

int main() {
    utsname system{};
    ::uname(&system);
    std::printf("kernel: %s\n", system.release);
    check(kernel_is_realtime(), "real-time kernel");
    check(can_works("can0"), "CAN interface can0 carries frames");
    check(gpio_lines("/dev/panel") == 8, "GPIO chip panel has 8 lines");

    const sched_param priority{.sched_priority = 80};
    check(::sched_setscheduler(0, SCHED_FIFO, &priority) == 0, "first-in-first-out scheduling");
    check(::mlockall(MCL_CURRENT | MCL_FUTURE) == 0, "memory locked");
    // Held open: the processor leaves its deeper sleep states only while a process holds it.
    const int latency = ::open("/dev/cpu_dma_latency", O_WRONLY);
    const std::int32_t zero = 0;
    check(latency >= 0 && ::write(latency, &zero, sizeof zero) == sizeof zero, "wake-up latency held at 0");

    const long worst = worst_lateness_ns(1000);
    std::printf("worst lateness of 1000 cycles of 1 ms: %ld us\n", worst / 1000);
    check(worst < 200'000, "every cycle within 200 us");
    return failures == 0 ? 0 : 1;
}
