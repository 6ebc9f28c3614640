// A generated machine as a static firmware: arms, runs for a moment, and reports when it was armed and when
// every activity had started.
#include "tests/figures/scale/probe.hpp"

#include "kernel/machine/worlds/real_world.hpp"
#include "kernel/os/heap.hpp"
#include "kernel/os/terminal.hpp"

#include <array>

TAPPET_HEAP_ARENA(256 * 1024)

namespace {

using namespace tappet;

void tell(const char* what, Time when) {
    static_cast<void>(os::write_all(1, Sentence{what, " ", to_ns(when), "\n"}.view()));
}

/// A build host is not a box; starting takes as long on it.
constexpr std::array<std::string_view, 2> only_warned{"realtime-kernel", "rt-throttling"};
constinit os::Clock machine_clock{os::Clock::Kind::real};

} // namespace

int main() {
    static MachineInstance instance{figures::accepted(), machine_clock};
    if (const auto configured = instance.configure({}); !configured) {
        static_cast<void>(os::write_all(2, configured.error().view()));
        return 2;
    }
    static RealWorld world{instance};
    static os::ArmingReport report{only_warned};
    const auto armed = world.arm(report, 2);
    if (!armed) return 3;
    const Time armed_at = os::Clock::monotonic();
    if (!world.start(*armed)) {
        static_cast<void>(os::write_all(2, world.refusal().view()));
        return 4;
    }
    const Time started = os::Clock::monotonic();
    static_cast<void>(world.supervise(100ms));
    static_cast<void>(world.stop());
    tell("armed", armed_at);
    tell("started", started);
    return 0;
}
