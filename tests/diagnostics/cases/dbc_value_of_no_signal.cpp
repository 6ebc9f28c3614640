// An enumeration takes its values from a signal that the map has not.
// refused: the map has no signal "gearbox.gaer"; did you mean "gearbox.gear"?
#include "drivers/can/value_names.hpp"

using namespace tappet;

constexpr can::ValueName gears[]{{0, "Neutral"}, {1, "First"}};
constexpr auto signals = can::signal_map(can::receive(
    can::standard(385), "gearbox", can::bytes(1), can::every(10ms), can::signal("gear", 0, 8).named(gears)));

enum class Gear : std::int64_t { neutral = can::value_of<signals, "gearbox.gaer", "Neutral"> };
