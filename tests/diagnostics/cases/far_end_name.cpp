// A plant names a signal that the map has not.
// refused by name: this_name_is_not_in_the_map_or_goes_the_other_way
// and by clang: did_you_mean<char>(&"command"[0], &"speed"[0])
#include "drivers/can/far_end.hpp"

using namespace tappet;

constexpr auto signals = can::signal_map(
    can::receive(can::standard(0x181), "drive", can::bytes(2), can::every(10ms), can::signal("speed", 0, 16)),
    can::transmit(can::standard(0x201), "command", can::bytes(2), can::every(10ms),
                  can::signal("speed", 0, 16).safe(0)));

double told_speed(can::FarEnd<signals>& far) { return far.get("command.sped"); }
