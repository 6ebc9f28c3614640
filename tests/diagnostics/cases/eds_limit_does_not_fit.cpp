// The electronic data sheet gives a byte with a sign the limits of one without, and a row writes it.
// refused: node 5 "drive": servo.eds:11: HighLimit 0xFF of 6060h:0 is under its LowLimit; believe the device: canopen::dictionary<.., canopen::despite(0x6060, canopen::DataType::integer8)>
#include "drivers/canopen/eds.hpp"
#include "drivers/canopen/manager.hpp"

using namespace tappet;

inline constexpr SourceText servo{"servo.eds", R"([1000]
DataType=7
AccessType=ro
[1017]
DataType=6
AccessType=rw
[6060]
DataType=2
AccessType=rw
LowLimit=0x00
HighLimit=0xFF
)"};
constexpr auto signals = can::signal_map(
    can::receive(can::extended(0x1234), "other", can::bytes(1), can::every(5ms), can::signal("value", 0, 8)));
constexpr auto net =
    canopen::network(signals, canopen::manager(127),
                     canopen::node(5, "drive", canopen::dictionary<servo>).heartbeat(100ms).write(0x6060, 3));
template struct canopen::Manager<net>;
