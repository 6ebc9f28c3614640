// The values of a signal by their names: constants of a machine's enumerations, and safe values.
#include "drivers/can/from_dbc.hpp"
#include "drivers/can/signal_store.hpp"
#include "drivers/can/value_names.hpp"
#include "tests/drivers/can/gearbox.dbc.hpp"
#include "tests/drivers/can/press.dbc.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

constexpr auto controller =
    node("controller", receive("gearbox", every(10ms)),
         transmit("gear_command", every(10ms), signal("gear").called("wanted").safe("Reverse gear"),
                  signal("most").safe("not available")));
constexpr auto map = from_dbc<files::gearbox_dbc, controller>;
TAPPET_ACCEPTED(map.fault);

enum class Gear : std::int64_t {
    neutral = value_of<map, "gearbox.gear", "Neutral">,
    first = value_of<map, "gearbox.gear", "First">,
    reverse = value_of<map, "gearbox.gear", "Reverse gear">,
};
static_assert(values_called<map, "gearbox.gear"> == 3 && values_called<map, "gearbox.oil"> == 1);
static_assert(Gear::neutral == Gear{0} && Gear::first == Gear{1} && Gear::reverse == Gear{-1});
static_assert(value_of<map, "gear_command.wanted", "First"> == 1, "by the facet's name");
// As the facet has it.
static_assert(std::same_as<const std::int64_t, decltype(value_of<map, "gearbox.gear", "First">)>);
static_assert(std::same_as<const double, decltype(value_of<map, "gearbox.oil", "not available">)>);
static_assert(value_of<map, "gearbox.oil", "not available"> == 87.5);
// A safe value may be named, also one beyond the range.
static_assert(map.safe_frames().size() == 1 && map.safe_frames()[0].data == Payload{0xFF, 0xFF});

constexpr auto press_node =
    node("controller",
         transmit("drive_command", signal("controlword").safe(2), signal("speed").safe(0)).called("command"),
         transmit("lamps", on_demand(10ms)).safe_by_silence(), receive("service", on_demand(20ms)));
constexpr auto press = from_dbc<files::press_dbc, press_node>;
static_assert(value_of<press, "drive.statusword", "läuft"> == 15,
              "the file is of cp1252, its names here are not");
static_assert(value_of<press, "drive.statusword", "on, \"ready\""> == 1);

constexpr std::size_t gear = map.signal("gearbox.gear"), oil = map.signal("gearbox.oil");
constexpr std::size_t wanted = map.signal("gear_command.wanted"), most = map.signal("gear_command.most");
constexpr std::size_t command = map.frame("gear_command");

TEST(ValueNames, match_received_values) {
    SignalStore store{map};
    Frame frame{.id = 385, .length = 2, .data = {0xFF, 0xFF}};
    ASSERT_EQ(store.decode(frame), Decoded::yes);
    EXPECT_EQ(Gear{store.integer(gear)}, Gear::reverse);
    EXPECT_EQ(store.physical(oil), (value_of<map, "gearbox.oil", "not available">));
    frame.data = {1, 254};
    ASSERT_EQ(store.decode(frame), Decoded::yes);
    EXPECT_EQ(Gear{store.integer(gear)}, Gear::first);
    EXPECT_NE(store.physical(oil), (value_of<map, "gearbox.oil", "not available">));
}

TEST(ValueNames, encode_sent_values) {
    SignalStore store{map};
    store.set_integer(wanted, std::to_underlying(Gear::reverse));
    store.set_physical(most, value_of<map, "gear_command.most", "not available">);
    EXPECT_EQ(store.encode(command, {}).data, (Payload{0xFF, 0xFF}));
    EXPECT_EQ(store.count.saturated, 0u);
}

} // namespace
} // namespace tappet::can
