// Two signals of a frame share bits.
// refused: wrong-map: component "can": signal "drive.status" overlaps "speed" at bit 12: move one of them
#include "drivers/can/bus.hpp"
#include "tests/diagnostics/small_machine.hpp"

using namespace tappet;

constexpr auto signals =
    can::signal_map(can::receive(can::standard(0x181), "drive", can::bytes(3), can::every(10ms),
                                 can::signal("speed", 0, 16), can::signal("status", 12, 8)));
constexpr auto table =
    machine("wrong-map", components(component<can::Bus<signals>>("can", device("bus"))),
            activities(activity("can", on_device("can"), at_most(4, 1ms), runs("can"), budget(30us))),
            connections(), reactions(), behaviours());
template struct tappet::Firmware<table, small::good_board>;
