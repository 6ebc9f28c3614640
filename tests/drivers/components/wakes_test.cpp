// A driver runs only where something wakes it often enough: each driver says whether its device does, and its
// map how often.
#include "drivers/camera/sensor.hpp"
#include "drivers/can/bus.hpp"
#include "drivers/can/restarter.hpp"
#include "drivers/gpio/line_port.hpp"
#include "drivers/modbus/client.hpp"
#include "drivers/udp/peer_clock.hpp"
#include "kernel/machine/accept.hpp"
#include "tests/drivers/components/board.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tappet::test {
namespace {

constexpr auto registers =
    modbus::register_map(modbus::read("unit", modbus::input_registers(0, 1), modbus::every(100ms),
                                      modbus::word("pressure", 0).times(0.01).in("bar")));
constexpr auto lines = gpio::line_map(gpio::sensor("guard"), gpio::sensor("door"));
constexpr auto orders = can::signal_map(can::receive(can::standard(0x181), "part", can::bytes(2),
                                                     can::on_demand(50ms), can::signal("number", 0, 16)),
                                        can::transmit(can::standard(0x201), "order", can::bytes(2),
                                                      can::on_demand(10ms), can::signal("number", 0, 16))
                                            .safe_by_silence());
constexpr auto parts = can::signal_map(can::receive(can::standard(0x181), "part", can::bytes(2),
                                                    can::on_demand(50ms), can::signal("number", 0, 16)));
constexpr auto bare = can::signal_map(
    can::transmit(can::standard(0x80), "sync", can::bytes(0), can::every(20ms)).safe_by_silence());
using Client = modbus::Client<registers>;
using Port = gpio::LinePort<lines>;

static_assert(component_type<Port>.woken_by_device && component_type<can::Bus<orders>>.woken_by_device &&
              component_type<camera::Sensor<8, 8>>.woken_by_device);
static_assert(!component_type<Client>.woken_by_device && !component_type<udp::PeerClock>.woken_by_device &&
              !component_type<udp::ClockAnswers>.woken_by_device &&
              !component_type<can::Restarter>.woken_by_device);

std::string refusal(const auto& table) { return std::string{Accepted{table.view(), board}.refusal().view()}; }

template <class Driver> std::string refusal_of(const ActivityRow& activity) {
    return refusal(machine("m", components(component<Driver>("driver", device("wire"))), activities(activity),
                           connections(), reactions(), behaviours()));
}
/// In the activity of a line that wakes it.
template <class Driver> std::string refusal_beside_a_line() {
    return refusal(machine(
        "m", components(component<Port>("io", device("io")), component<Driver>("driver", device("wire"))),
        activities(activity("a", on_device("io"), not_real_time, runs("io", "driver"))), connections(),
        reactions(), behaviours()));
}
constexpr auto on_its_device = activity("a", on_device("driver"), not_real_time, runs("driver"));
constexpr auto on_rows = activity("a", on_work(), not_real_time, runs("driver"));
constexpr ActivityRow in(Duration period) {
    return activity("a", every(period), not_real_time, runs("driver"));
}

TEST(DriverWakes, a_modbus_client_is_refused_where_it_is_not_polled) {
    const std::string refused = refusal_of<Client>(on_its_device);
    EXPECT_TRUE(
        refused.starts_with("m: activity \"a\": component \"driver\" polls its modbus device, which wakes "
                            "nobody; run it every(...)"))
        << refused;
    EXPECT_EQ(refusal_of<Client>(on_rows), "m: activity \"a\" runs on_work(), but \"driver.unit.pressure\" "
                                           "crosses the wire every 100000 us by its "
                                           "map, which wakes nobody; run it every(...)");
    EXPECT_EQ(refusal_beside_a_line<Client>(), "m: activity \"a\" runs on_device(\"io\"), but "
                                               "\"driver.unit.pressure\" crosses the wire every 100000 us "
                                               "by its map, which wakes nobody; run it every(...)");
    EXPECT_EQ(refusal_of<Client>(in(100ms)), "");
}

TEST(DriverWakes, a_receiver_of_datagrams_is_refused_where_it_is_not_polled) {
    EXPECT_NE(refusal_of<udp::ClockAnswers>(on_its_device).find("polls its udp device, which wakes nobody"),
              std::string::npos);
    EXPECT_NE(refusal_of<udp::ClockAnswers>(on_rows).find("no row wakes it"), std::string::npos);
    EXPECT_EQ(refusal_beside_a_line<udp::ClockAnswers>(),
              "m: activity \"a\" is woken by no row but by another driver's device, and component \"driver\" "
              "polls its "
              "udp device, which wakes nobody; run it every(...)");
    EXPECT_NE(refusal_of<udp::PeerClock>(on_rows), "");
    EXPECT_EQ(refusal_of<udp::ClockAnswers>(in(10ms)), "");
}

TEST(DriverWakes, a_bus_is_refused_that_is_served_more_slowly_than_its_map_sends_and_receives) {
    EXPECT_EQ(refusal_of<can::Bus<orders>>(in(100ms)),
              "m: activity \"a\" runs every 100000 us, but \"driver.order\" may cross the wire every 10000 "
              "us by its "
              "map; shorten the activity's period, or lengthen the every(...) or on_demand(...) of the map");
    EXPECT_NE(
        refusal_of<can::Bus<parts>>(in(100ms)).find("\"driver.part\" may cross the wire every 50000 us"),
        std::string::npos);
    EXPECT_NE(refusal_of<can::Bus<bare>>(in(100ms)).find("\"driver.sync\" may cross the wire every 20000 us"),
              std::string::npos)
        << "it has no signal";
    EXPECT_EQ(refusal_of<can::Bus<parts>>(in(50ms)), "");
    EXPECT_EQ(refusal_of<can::Bus<bare>>(in(20ms)), "");
}

} // namespace
} // namespace tappet::test
