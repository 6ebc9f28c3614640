// A plant sets a line that the machine drives.
// refused by name: this_name_is_not_in_the_map_or_goes_the_other_way
#include "drivers/gpio/far_end.hpp"

using namespace tappet;

constexpr auto io = gpio::line_map(gpio::sensor("start"), gpio::output("lamp", gpio::safe(false)));

void turn_on(gpio::FarEnd<io>& far) { far.set("lamp", true); }
