// A box that differs from its board: the firmware names the missing part and the cure, and moves nothing.
#include "tests/bench/loom/loom_rig.hpp"

#include <cstring>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace tappet::bench {
namespace {

constexpr int wrong_set_up = 2;
constexpr int refused_to_arm = 3;

/// Runs the firmware until it ends; returns its output.
struct Attempt {
    explicit Attempt(const std::string& options = {})
        : firmware{"carpet_loom " + options}, code{firmware.wait()}, said{firmware.output()} {}
    Foreign firmware;
    int code;
    std::string said;
};

void ask_interface(unsigned long request, ifreq& what) {
    const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
    EXPECT_EQ(::ioctl(fd, request, &what), 0) << std::strerror(errno);
    ::close(fd);
}
void set_up(std::string_view name, bool up) {
    ifreq request{};
    name.copy(request.ifr_name, IFNAMSIZ - 1);
    ask_interface(SIOCGIFFLAGS, request);
    request.ifr_flags = static_cast<short>(up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP);
    ask_interface(SIOCSIFFLAGS, request);
}
void rename_interface(std::string_view from, std::string_view to) {
    ifreq request{};
    from.copy(request.ifr_name, IFNAMSIZ - 1);
    to.copy(request.ifr_newname, IFNAMSIZ - 1);
    ask_interface(SIOCSIFNAME, request);
}

TEST(LoomSetUp, names_a_can_interface_that_is_down) {
    set_up("can0", false);
    const Attempt attempt;
    set_up("can0", true);
    EXPECT_EQ(attempt.code, wrong_set_up);
    EXPECT_NE(attempt.said.find("device \"loom-can\" at \"can0\": CAN interface \"can0\" is down: set it up"),
              std::string::npos)
        << attempt.said;
}

TEST(LoomSetUp, names_a_missing_can_interface) {
    set_up("can0", false);
    rename_interface("can0", "can7");
    const Attempt attempt;
    rename_interface("can7", "can0");
    set_up("can0", true);
    EXPECT_EQ(attempt.code, wrong_set_up);
    EXPECT_NE(attempt.said.find("board \"bench\", device \"loom-can\" at \"can0\": "), std::string::npos)
        << attempt.said;
}

TEST(LoomSetUp, names_a_missing_gpio_chip) {
    ASSERT_EQ(::rename("/dev/io", "/dev/elsewhere"), 0);
    const Attempt attempt;
    EXPECT_EQ(::rename("/dev/elsewhere", "/dev/io"), 0);
    EXPECT_EQ(attempt.code, wrong_set_up);
    EXPECT_NE(attempt.said.find("board \"bench\", device \"loom-io\" at \"/dev/io\": "), std::string::npos)
        << attempt.said;
}

TEST(LoomSetUp, names_a_line_missing_on_the_chip) {
    ASSERT_EQ(::rename("/dev/io", "/dev/elsewhere"), 0);
    ASSERT_EQ(::symlink("/dev/small", "/dev/io"), 0);
    const Attempt attempt;
    EXPECT_EQ(::rename("/dev/elsewhere", "/dev/io"), 0);
    EXPECT_EQ(attempt.code, wrong_set_up);
    EXPECT_NE(
        attempt.said.find("line 8 of chip \"/dev/io\", does not exist: correct the offset in the board"),
        std::string::npos)
        << attempt.said;
}

TEST(LoomSetUp, names_lines_held_by_another_program) {
    Foreign holder{"gpiomon -c /dev/io 3"};
    std::this_thread::sleep_for(200ms);
    const Attempt attempt;
    EXPECT_EQ(attempt.code, wrong_set_up);
    EXPECT_NE(attempt.said.find("device \"loom-io\""), std::string::npos) << attempt.said;
}

TEST(LoomSetUp, refuses_an_unknown_option) {
    const Attempt attempt{"--fast"};
    EXPECT_EQ(attempt.code, wrong_set_up);
    EXPECT_NE(attempt.said.find("option --fast is unknown"), std::string::npos) << attempt.said;
}

TEST(LoomSetUp, refuses_to_arm_while_real_time_threads_are_throttled) {
    constexpr const char* limit = "/proc/sys/kernel/sched_rt_runtime_us";
    std::ofstream{limit} << 950000;
    const Attempt attempt;
    std::ofstream{limit} << -1;
    EXPECT_EQ(attempt.code, refused_to_arm);
    EXPECT_NE(attempt.said.find("rt-throttling"), std::string::npos) << attempt.said;
    EXPECT_NE(attempt.said.find("write -1 to /proc/sys/kernel/sched_rt_runtime_us"), std::string::npos)
        << attempt.said;
}

TEST(LoomSetUp, arms_without_its_modbus_device_but_does_not_become_ready) {
    Loom loom{"--stop-servers-at 0s/1h"};
    EXPECT_TRUE(loom.says("waits_for=oil-pressure")) << loom.machine->output();
    std::this_thread::sleep_for(2s);
    EXPECT_EQ(loom.last("state"), "preparing");
    EXPECT_EQ(loom.last("waits_for"), "oil-pressure");
    EXPECT_TRUE(loom.machine->runs());
    EXPECT_EQ(loom.end(), 0) << loom.machine->output();
    expect_undisturbed(loom);
}

} // namespace
} // namespace tappet::bench
