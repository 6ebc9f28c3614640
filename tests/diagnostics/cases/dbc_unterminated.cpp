// A text of a DBC file has no end.
// refused: wrong-file: component "can": tests/diagnostics/cases/dbc_unterminated.dbc:3:36: a text is unclosed or out of place, expected the unit between quotes
#include "drivers/can/bus.hpp"
#include "drivers/can/from_dbc.hpp"
#include "tests/diagnostics/cases/dbc_unterminated.dbc.hpp"
#include "tests/diagnostics/small_machine.hpp"

using namespace tappet;

constexpr auto controller = can::node("controller");
constexpr auto signals = can::from_dbc<files::dbc_unterminated_dbc, controller>;
constexpr auto table =
    machine("wrong-file", components(component<can::Bus<signals>>("can", device("bus"))),
            activities(activity("can", on_device("can"), at_most(4, 1ms), runs("can"), budget(30us))),
            connections(), reactions(), behaviours());
template struct tappet::Firmware<table, small::good_board>;
