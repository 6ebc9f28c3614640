// A DBC file says that the machine sends a message, and the machine does not say how that becomes safe.
// refused: wrong-file: component "can": tests/diagnostics/cases/dbc_not_safe.dbc:5:9: message "command" is sent by "controller" but has no safe values; write transmit("command", signal("..").safe(..)) into its node, or .safe_by_silence() behind that
#include "drivers/can/bus.hpp"
#include "drivers/can/from_dbc.hpp"
#include "tests/diagnostics/cases/dbc_not_safe.dbc.hpp"
#include "tests/diagnostics/small_machine.hpp"

using namespace tappet;

constexpr auto controller = can::node("controller", can::receive("drive", can::every(10ms)));
constexpr auto signals = can::from_dbc<files::dbc_not_safe_dbc, controller>;
constexpr auto table =
    machine("wrong-file", components(component<can::Bus<signals>>("can", device("bus"))),
            activities(activity("can", on_device("can"), at_most(4, 1ms), runs("can"), budget(30us))),
            connections(), reactions(), behaviours());
template struct tappet::Firmware<table, small::good_board>;
