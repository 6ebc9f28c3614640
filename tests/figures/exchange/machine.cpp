// Starts the machine, whose outputs stay disabled; no engine steps, because the measuring threads call each
// operation.
#include "tests/figures/exchange/machine.hpp"

#include "kernel/machine/accept.hpp"
#include "tests/figures/measure/world.hpp"

#include <string>

namespace tappet::figures {

namespace {

template <std::size_t bytes>
void find_ends(MachineInstance& instance) {
    using Out = Writer<Packet<bytes>>;
    using In = Reader<Packet<bytes>>;
    const std::string size = std::to_string(bytes);
    Ends<bytes>::writer = instance.find<Out>("writer_" + size);
    Ends<bytes>::near = instance.find<In>("near_" + size);
    Ends<bytes>::far = instance.find<In>("far_" + size);
}

} // namespace

void start_machine() {
    static os::Clock clock{os::Clock::Kind::virtual_time};
    static MachineInstance instance{AtRunTime<exchange_machine, exchange_board>::machine(), clock};
    static VirtualWorld world{instance};
    const auto configured = instance.configure({});
    exit_if(configured ? world.start() : configured.error());
    find_ends<8>(instance);
    find_ends<160>(instance);
    find_ends<4096>(instance);
}

} // namespace tappet::figures
