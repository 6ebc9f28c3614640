// Two signals of a frame share bits.
// refused: signal "drive.status" overlaps "speed" at bit 12: move one of them
#include "drivers/can/bus.hpp"
#include "tests/diagnostics/small_machine.hpp"

using namespace tappet;

constexpr auto signals = can::signal_map(can::receive(
    can::standard(0x181), "drive", can::bytes(3), can::signal("speed", 0, 16), can::signal("status", 12, 8)));
template struct tappet::can::Bus<signals>;
