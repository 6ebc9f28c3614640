// The examples of a machine's wires. The bytes expected here were computed by hand from the documents: CAN
// signals by the numbering of DBC files, registers by the Modbus application protocol 1.1b3, section 4.2.
#include "drivers/can/bus.hpp"
#include "drivers/modbus/client.hpp"
#include "kernel/machine/table/machine.hpp"
#include "toolchain/machine/wires_text.hpp"

#include <gmock/gmock.h>

namespace tappet {
namespace {

using testing::HasSubstr;

constexpr auto signals = can::signal_map(
    can::receive(can::standard(0x181), "drive", can::bytes(8), can::every(10ms), can::signal("status", 0, 16),
                 can::signal("speed", 16, 16).as_signed().times(0.1).in("rpm"),
                 can::signal("load", 39, 16).big_endian().times(0.01).in("%"),
                 can::signal("oil", 48, 8).plus(-40).in("degC"),
                 can::signal("coarse", 56, 8).times(10).in("N")),
    can::transmit(can::extended(0x18FF0102), "command", can::bytes(4), can::on_demand(10ms),
                  can::signal("axis", 0, 32).as_float().range(-1, 1).in("m/s").safe(0)),
    can::transmit(can::standard(0x301), "pages", can::fd_bytes(12), can::every(1ms),
                  can::signal("page", 0, 8).safe(0),
                  can::signal("level", 8, 16).times(0.5).in("mm").when("page", 3).safe(0)),
    can::receive(can::standard(0x302), "kinds", can::bytes(8), can::every(1ms),
                 can::signal("kind", 0, 8).as_signed().range(-5, 100),
                 can::signal("depth", 8, 16).as_signed().range(-200, 0).when("kind", 255)),
    can::receive(can::standard(0x304), "far", can::bytes(4), can::every(1ms),
                 can::signal("far_page", 0, 8).range(0, 2),
                 can::signal("far_level", 8, 8).when("far_page", 5)),
    can::receive(can::standard(0x303), "total", can::bytes(8), can::every(1ms),
                 can::signal("total", 0, 64).range(0, 18446744073709551615.0)));
constexpr auto registers = modbus::register_map(
    modbus::read("unit", modbus::input_registers(4, 7), modbus::every(250ms),
                 modbus::word("pressure", 0).times(0.01).in("bar"), modbus::float_word("flow", 1).in("l/min"),
                 modbus::float_word("swapped", 3).swapped(), modbus::double_word("count", 5).bytes_swapped()),
    modbus::write("pump", modbus::coils(9, 1), modbus::every(1s), modbus::stale_after(3s),
                  modbus::bit("on", 0).safe(0)));

constexpr auto table = machine("wires",
                               components(component<can::Bus<signals>>("can", device("w-can")),
                                          component<modbus::Client<registers>>("unit", device("w-unit"))),
                               activities(), connections(), reactions(), behaviours());

std::string line_with(std::string_view name) {
    const std::string all = describe_wires(table.view());
    const std::size_t at = all.find("    " + std::string{name} + " ");
    return at == all.npos ? "no line" : all.substr(at, all.find('\n', at) - at);
}

TEST(WiresText, shows_each_signal_as_its_frame_carries_it) {
    EXPECT_THAT(
        describe_wires(table.view()),
        HasSubstr("can: CAN bus \"w-can\"\n  0x181 standard, 8 bytes, received every 10 ms: drive\n"));
    EXPECT_THAT(line_with("status"), HasSubstr("1               01 00 -- -- -- -- -- --"));
    EXPECT_THAT(line_with("speed"), HasSubstr("1.5 rpm         -- -- 0F 00 -- -- -- --"));
    EXPECT_THAT(line_with("load"), HasSubstr("1.5 %           -- -- -- -- 00 96 -- --")); // Motorola
    EXPECT_THAT(line_with("oil"), HasSubstr("2 degC          -- -- -- -- -- -- 2A --"));  // the nearest
    EXPECT_THAT(line_with("coarse"), HasSubstr("10 N            -- -- -- -- -- -- -- 01"));
}
TEST(WiresText, shows_the_upper_end_of_a_range) {
    EXPECT_THAT(describe_wires(table.view()), HasSubstr("0x18FF0102 extended, 4 bytes, sent on demand"));
    EXPECT_THAT(line_with("axis"), HasSubstr("1 m/s           00 00 80 3F")); // IEEE 754
}
TEST(WiresText, sets_the_multiplexor_that_selects_a_signal) {
    EXPECT_THAT(describe_wires(table.view()), HasSubstr("0x301 standard, 12 bytes CAN FD, sent every 1 ms"));
    EXPECT_THAT(line_with("level"),
                HasSubstr("1.5 mm          03 03 00 -- -- -- -- -- -- -- -- --  while page is 3"));
    EXPECT_THAT(line_with("depth"), HasSubstr("-200            FF 38 FF -- -- -- -- --  while kind is 255"));
}
TEST(WiresText, sets_a_multiplexor_as_its_sender_does) {
    EXPECT_THAT(line_with("far_level"), HasSubstr("1               05 01 -- --"))
        << "another node has no range";
    // The check of the map refuses this page, since its driver sends page 2 instead, without the level.
    static constexpr auto pages = can::signal_map(can::transmit(
        can::standard(0x201), "pages", can::bytes(4), can::every(10ms),
        can::signal("page", 0, 8).range(0, 2).safe(0), can::signal("level", 8, 8).when("page", 5).safe(0)));
    static constexpr auto wrong =
        machine("wires", components(component<can::Bus<pages>>("can", device("w-can"))), activities(),
                connections(), reactions(), behaviours());
    EXPECT_THAT(describe_wires(wrong.view()),
                HasSubstr("level                   1               02 00 -- --"));
}
TEST(WiresText, shows_a_value_that_is_not_zero_and_that_a_double_holds) {
    EXPECT_THAT(line_with("total"), HasSubstr("00 00 00 00 00 00 20 00"));
}
TEST(WiresText, shows_each_register_with_its_address_and_words) {
    EXPECT_THAT(describe_wires(table.view()),
                HasSubstr("  function 4, reads 7 input registers from address 4, every 250 ms: unit\n"));
    EXPECT_THAT(line_with("pressure"), HasSubstr("1.5 bar         4: 0096"));
    EXPECT_THAT(line_with("flow"), HasSubstr("1.5 l/min       5: 3FC0 0000"));
    EXPECT_THAT(line_with("swapped"), HasSubstr("7: 0000 3FC0"));
    EXPECT_THAT(line_with("count"), HasSubstr("2               9: 0000 0200"));
    EXPECT_THAT(describe_wires(table.view()), HasSubstr("  function 15, writes 1 coils from address 9"));
    EXPECT_THAT(line_with("on"), HasSubstr("1               9: 1"));
}

} // namespace
} // namespace tappet
