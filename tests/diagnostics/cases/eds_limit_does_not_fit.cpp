// The electronic data sheet gives a byte with a sign the limits of one without, and a row writes it.
// refused: node 5 "drive": tests/diagnostics/cases/eds_limit_does_not_fit.eds:11: HighLimit 0xFF of 6060h:0 is under its LowLimit; believe the device: canopen::dictionary<.., canopen::despite(0x6060, canopen::DataType::integer8)>
#include "drivers/canopen/eds.hpp"
#include "drivers/canopen/manager.hpp"
#include "tests/diagnostics/cases/eds_limit_does_not_fit.eds.hpp"

using namespace tappet;

constexpr auto signals = can::signal_map(
    can::receive(can::extended(0x1234), "other", can::bytes(1), can::every(5ms), can::signal("value", 0, 8)));
constexpr auto net =
    canopen::network(signals, canopen::manager(127),
                     canopen::node(5, "drive", canopen::dictionary<files::eds_limit_does_not_fit_eds>)
                         .heartbeat(100ms)
                         .write(0x6060, 3));
template struct canopen::Manager<net>;
