// Any datagrams at any times: to the camera of the tool's robot and its estimator, and between two machines
// that ask for each other's time. Each datagram is accepted or refused, and counted; accepted places and
// times are valid; and a correct peer is soon accepted again.
//
// Each step is a byte that selects the action, followed by the bytes that the action consumes.
#include "tests/fuzz/asked_clock.hpp"
#include "tests/fuzz/followed_camera.hpp"

namespace {

using namespace tappet::fuzz;

template <class Rig> void run(Script script) {
    Rig rig;
    for (int steps = 0; !script.rest.empty() && steps < 300; ++steps) rig.take(script.next(1)[0], script);
    rig.come_back();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const Script script{{data + 1, size - 1}};
    switch (data[0] % 3) {
    case 0: run<AskedClock>(script); break;
    case 1: run<FollowedCamera<BodyEstimator>>(script); break;
    default: run<FollowedCamera<KalmanBodyEstimator>>(script);
    }
    return 0;
}
