// A DBC file says that the machine sends a message, and the machine does not say how that becomes safe.
// refused: wrong-file: component "can": press.dbc:5:9: message "command" is sent by "controller" but has no safe values; write transmit("command", signal("..").safe(..)) into its node, or .safe_by_silence() behind that
#include "drivers/can/bus.hpp"
#include "drivers/can/from_dbc.hpp"
#include "tests/diagnostics/small_machine.hpp"

using namespace tappet;

constexpr char press_text[] = R"(BU_: controller drive
BO_ 385 drive: 3 drive
 SG_ speed : 0|16@1- (0.1,0) [0|0] "rpm" controller
 SG_ status : 16|8@1+ (1,0) [0|0] "" controller
BO_ 513 command: 2 controller
)";
constexpr SourceText file{"press.dbc", {press_text, sizeof press_text - 1}};
constexpr auto controller = can::node("controller", can::receive("drive", can::every(10ms)));
constexpr auto signals = can::from_dbc<file, controller>;
constexpr auto table =
    machine("wrong-file", components(component<can::Bus<signals>>("can", device("bus"))),
            activities(activity("can", on_device("can"), at_most(4, 1ms), runs("can"), budget(30us))),
            connections(), reactions(), behaviours());
template struct tappet::Firmware<table, small::good_board>;
