// Any frames on a network, to its manager and to its nodes: nothing breaks, and nodes that boot afterwards
// become operational.
//
// Each step is a byte with the receiver, three quarters of a frame's identifier and its length, followed by
// the data.
#include "tests/drivers/canopen/network_machine.hpp"
#include "tests/fuzz/input.hpp"

#include <algorithm>

namespace {

using namespace tappet;
using tappet::fuzz::demand;

constexpr std::array<std::uint32_t, 10> to_machine{0x585, 0x587, 0x705, 0x707, 0x085,
                                                   0x087, 0x185, 0x187, 0x585, 0x705};
constexpr std::array<std::uint32_t, 9> to_nodes{0x605, 0x607, 0x000, 0x080, 0x100,
                                                0x205, 0x77F, 0x605, 0x607};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    test::NetworkRig rig;
    demand(rig.good);
    rig.run(50ms);
    std::size_t at = 0;
    for (int steps = 0; at + 2 <= size && steps < 200; ++steps) {
        const std::uint8_t what = data[at], length = std::min<std::uint8_t>(data[at + 1] & 0xF, 8);
        at += 2;
        can::Frame frame;
        frame.length = length;
        for (std::size_t i = 0; i < length && at < size; ++i) frame.data[i] = data[at++];
        if ((what & 0x80) != 0) {
            frame.id = to_nodes[what % to_nodes.size()];
            for (canopen::SimulatedNode* node : rig.all) node->receive(frame, rig.clock.now(), rig);
        } else {
            frame.id = to_machine[what % to_machine.size()];
            rig.send(frame);
        }
        if ((what & 0x40) != 0) rig.run(std::chrono::milliseconds{what & 0x1F});
    }
    rig.run(20ms);
    // A node that boots again is configured again, whatever came before.
    rig.drive.power_on(rig.clock.now() + 10ms);
    rig.encoder.power_on(rig.clock.now() + 10ms);
    rig.run(2s);
    demand(rig.operational() && rig.reason().empty());
    demand(rig.drive.get({0x1A00, 0}) == 2 && rig.encoder.get({0x1800, 2}) == 1);
    demand(rig.good);
    return 0;
}
