// An enumeration takes its values from a DBC file, in which one is called otherwise now.
// refused: signal "gearbox.gear" has no value "Reverse"; did you mean "Reversed"?
#include "drivers/can/from_dbc.hpp"
#include "drivers/can/value_names.hpp"
#include "tests/diagnostics/cases/dbc_value_unknown.dbc.hpp"

using namespace tappet;

constexpr auto controller = can::node("controller", can::receive("gearbox", can::every(10ms)));
constexpr auto signals = can::from_dbc<files::dbc_value_unknown_dbc, controller>;

enum class Gear : std::int64_t {
    neutral = can::value_of<signals, "gearbox.gear", "Neutral">,
    reverse = can::value_of<signals, "gearbox.gear", "Reverse">,
};
