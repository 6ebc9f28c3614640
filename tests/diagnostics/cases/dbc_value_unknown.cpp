// An enumeration takes its values from a DBC file, in which one is called otherwise now.
// refused: signal "gearbox.gear" has no value "Reverse"; did you mean "Reversed"?
#include "drivers/can/from_dbc.hpp"
#include "drivers/can/value_names.hpp"

using namespace tappet;

constexpr char gearbox_text[] = R"(BU_: controller gearbox
BO_ 385 gearbox: 1 gearbox
 SG_ gear : 0|8@1- (1,0) [0|0] "" controller
VAL_ 385 gear 0 "Neutral" -1 "Reversed" ;
)";
constexpr SourceText file{"gearbox.dbc", {gearbox_text, sizeof gearbox_text - 1}};
constexpr auto controller = can::node("controller", can::receive("gearbox", can::every(10ms)));
constexpr auto signals = can::from_dbc<file, controller>;

enum class Gear : std::int64_t {
    neutral = can::value_of<signals, "gearbox.gear", "Neutral">,
    reverse = can::value_of<signals, "gearbox.gear", "Reverse">,
};
