// A frame of the signal map is shorter than the objects that the network's table maps into it.
// refused: node 5 "drive": frame "drive" has 2 bytes, but its objects take 32 bits; correct one of them
#include "drivers/canopen/eds.hpp"
#include "drivers/canopen/manager.hpp"

using namespace tappet;

inline constexpr SourceText servo{"servo.eds", R"([1000]
DataType=7
AccessType=ro
[1017]
DataType=6
AccessType=rw
[1800]
ObjectType=9
SubNumber=1
[1800sub1]
DataType=7
AccessType=rw
[1A00]
ObjectType=9
SubNumber=1
[1A00sub0]
DataType=5
AccessType=rw
[606C]
DataType=4
AccessType=ro
PDOMapping=1
)"};
constexpr auto signals =
    can::signal_map(can::receive(can::standard(0x185), "drive", can::bytes(2), can::every(5ms),
                                 can::signal("velocity", 0, 16).as_signed()));
constexpr auto net = canopen::network(
    signals, canopen::manager(127),
    canopen::node(5, "drive", canopen::dictionary<servo>).heartbeat(100ms).pdo("drive", {0x606C}));
template struct canopen::Manager<net>;
