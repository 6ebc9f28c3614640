// A frame of the signal map is shorter than the objects that the network's table maps into it.
// refused: node 5 "drive": frame "drive" has 2 bytes, but its objects take 32 bits; correct one of them
#include "drivers/canopen/eds.hpp"
#include "drivers/canopen/manager.hpp"
#include "tests/diagnostics/cases/network_pdo_does_not_fit.eds.hpp"

using namespace tappet;

constexpr auto signals =
    can::signal_map(can::receive(can::standard(0x185), "drive", can::bytes(2), can::every(5ms),
                                 can::signal("velocity", 0, 16).as_signed()));
constexpr auto net =
    canopen::network(signals, canopen::manager(127),
                     canopen::node(5, "drive", canopen::dictionary<files::network_pdo_does_not_fit_eds>)
                         .heartbeat(100ms)
                         .pdo("drive", {0x606C}));
template struct canopen::Manager<net>;
