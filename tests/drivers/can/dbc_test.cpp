// DBC files as signal maps: the compiled map, and the frames that a node sends and receives with it.
#include "drivers/can/bus.hpp"
#include "drivers/can/from_dbc.hpp"
#include "tests/drivers/can/files.hpp"
#include "tests/drivers/can/press.dbc.hpp"
#include "tests/drivers/can/same_map.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

constexpr auto controller =
    node("controller", transmit("drive_command", signal("controlword").safe(2), signal("speed").safe(0)),
         transmit("lamps", on_demand(10ms), signal("Which").safe(0),
                  signal("Brightness").called("level").safe(50), signal("Colour").safe(4))
             .called("panel_lamps"),
         receive("service", on_demand(20ms)), receive("diagnosis", on_demand(1s), signal("code").in("min")));
constexpr auto map = from_dbc<files::press_dbc, controller>;
TAPPET_ACCEPTED(map.fault);

constexpr Signal found(std::string_view path) { return map.signals[map.signal(path)]; }

// The same type of map as by hand, in the file's order.
static_assert(map.frames.size() == 5 && map.signals.size() == 15);
static_assert(map.receives().size() == 3 && map.transmits().size() == 2);
static_assert(map.frame(standard(385)) == 0 && map.frame(extended(2566844962 & 0x1FFF'FFFF)) == 1);
static_assert(map.frames[0].every == 10ms && map.frames[1].every == 0ms && map.frames[1].apart == 20ms);
static_assert(map.frames[2].name == "drive_command" && map.frames[2].every == 5ms);
static_assert(map.frame("panel_lamps") == 3 && map.frames[3].apart == 10ms);
static_assert(found("drive.load").order == Order::motorola && found("drive.load").unit == "%");
static_assert(found("drive.torque_of_the_shaft").kind == Kind::signed_integer);
static_assert(found("drive.torque_of_the_shaft").unit == "N m" && found("drive_command.speed").unit == "rpm");
static_assert(found("service.oil").unit == "degC" && found("service.oil").factor == -0.1);
static_assert(found("service.flow").kind == Kind::float32 && found("diagnosis.code").unit == "min");
static_assert(found("drive.statusword").names.size() == 3 && found("drive.statusword").names[2].value == 15);
static_assert(found("drive.statusword").names[1].name == "on, \"ready\"");
static_assert(found("drive.statusword").names[2].name == "läuft");
// Multiplexors stand before the signals that they select.
static_assert(map.signal("service.page") < map.signal("service.pressure"));
static_assert(map.signal("service.detail") < map.signal("service.flow"));
// All pages of a sent frame become safe, the selected one last.
static_assert(map.safe_frames().size() == 3);
static_assert(map.safe_frames()[0].data == Payload{2, 0, 0, 0});
static_assert(map.safe_frames()[1].data == Payload{1, 4} && map.safe_frames()[2].data == Payload{0, 100});

constexpr auto panel = node("panel", receive("lamps", on_demand(10ms)));
constexpr auto panel_map = from_dbc<files::press_dbc, panel>;
static_assert(panel_map.frames.size() == 2 && panel_map.signals.size() == 4);
static_assert(panel_map.signal("drive.torque_of_the_shaft") == 0 && panel_map.signal("lamps.Which") == 1);
static_assert(panel_map.frames[0].length == 6, "of a frame it takes its own signals only");

Frame service(Payload data) {
    return {.id = 2566844962 & 0x1FFF'FFFF, .extended = true, .length = 8, .data = data};
}

TEST(Dbc, decodes_only_signals_that_the_multiplexors_select) {
    SignalStore store{map};
    const auto is = [&](std::string_view name) {
        return store.physical(map.signal(std::string{"service."} + std::string{name}));
    };
    ASSERT_EQ(store.decode(service({5, 0, 0x10, 0x27})), Decoded::yes);
    EXPECT_EQ(is("pressure"), 100.0);
    EXPECT_EQ(is("oil"), -40.0);
    ASSERT_EQ(store.decode(service({1, 0, 0x0A, 0x00})), Decoded::yes);
    EXPECT_EQ(is("oil"), -41.0) << "a negative factor";
    EXPECT_EQ(is("pressure"), 100.0);
    ASSERT_EQ(store.decode(service({3, 0, 0x00, 0x00, 0xC0, 0x3F})), Decoded::yes);
    EXPECT_EQ(is("flow"), 1.5);
    EXPECT_EQ(is("hours"), 0.0);
    ASSERT_EQ(store.decode(service({2, 2, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF})), Decoded::yes);
    EXPECT_EQ(is("hours"), 1099511627775.0);
    EXPECT_EQ(is("flow"), 1.5);
    ASSERT_EQ(store.decode(service({9, 2, 1, 1, 1, 1, 1})), Decoded::yes) << "a page that nobody knows";
    EXPECT_EQ(is("hours"), 1099511627775.0);
    EXPECT_EQ(is("pressure"), 100.0);
}

TEST(Dbc, sends_the_selected_page_and_keeps_within_the_range) {
    SignalStore store{map};
    store.set_physical(map.signal("panel_lamps.level"), 30);
    store.set_integer(map.signal("panel_lamps.Colour"), 3);
    store.set_integer(map.signal("panel_lamps.Which"), 0);
    EXPECT_EQ(store.encode(map.frame("panel_lamps"), {}).data, (Payload{0, 60}));
    store.set_integer(map.signal("panel_lamps.Which"), 1);
    EXPECT_EQ(store.encode(map.frame("panel_lamps"), {}).data, (Payload{1, 3}));
    store.set_integer(map.signal("panel_lamps.Which"), 2);
    EXPECT_EQ(store.encode(map.frame("panel_lamps"), {}).data, (Payload{2, 0}));
    EXPECT_EQ(store.count.saturated, 0u);
    store.set_integer(map.signal("panel_lamps.Colour"), 300);
    store.set_physical(map.signal("panel_lamps.level"), 120);
    EXPECT_EQ(store.integer(map.signal("panel_lamps.Colour")), 7);
    EXPECT_EQ(store.physical(map.signal("panel_lamps.level")), 100.0);
    EXPECT_EQ(store.count.saturated, 2u);
}

constexpr ValueName temperature_names[] = {{255, "not available"}};

TEST(Signals, send_a_named_value_beyond_their_range) {
    const Signal s = signal("t", 0, 8).plus(-40).range(-40, 200).named(temperature_names);
    EXPECT_EQ(to_raw(s, 215).bits, 255u);
    EXPECT_FALSE(to_raw(s, 215).saturated);
    EXPECT_EQ(to_raw(s, 214).bits, 240u);
    EXPECT_TRUE(to_raw(s, 214).saturated);
    EXPECT_EQ(to_raw_integer(signal("n", 0, 8).as_bits(), 0x17F).bits, 0x7Fu) << "a set of bits is cut";
    EXPECT_EQ(to_raw_integer(signal("n", 0, 8).range(0, 300), 0x1FF).bits, 0xFFu);
    EXPECT_TRUE(to_raw_integer(signal("n", 0, 8).range(0, 300), 0x1FF).saturated);
}

// The same rows written by hand make the same map.
constexpr auto by_hand = signal_map(
    transmit(standard(514), "lamps", bytes(2), on_demand(10ms), signal("Which", 0, 4).range(0, 3).safe(0),
             signal("Brightness", 8, 8).times(0.5).range(0, 100).in("%").when("Which", 0).safe(50),
             signal("Colour", 8, 8).range(0, 7).when("Which", 1).safe(4)));
TAPPET_ACCEPTED(by_hand.fault);
static_assert(by_hand.safe_frames().size() == 2 && by_hand.safe_frames()[0].data == Payload{1, 4});

/// The format of message 1 after these attributes.
Format format_in(const std::string& attributes) {
    static constexpr auto nobody = node("", receive("one", every(10ms)));
    const DbcMap read{"BU_: us\nBO_ 1 one: 8 us\n SG_ a : 0|8@1+ (1,0) [0|0] \"\" us\n" + attributes,
                      nobody.view()};
    EXPECT_EQ(read.map.fault.view(), "");
    return read.map.frames[0].format;
}
const std::string formats =
    "BA_DEF_ BO_ \"VFrameFormat\" ENUM \"ExtendedCAN_FD\",\"StandardCAN\",\"StandardCAN_FD\";\n";

TEST(Dbc, recognizes_can_fd_by_the_number_or_name_of_the_format) {
    EXPECT_EQ(format_in(""), Format::classical);
    EXPECT_EQ(format_in("BA_ \"VFrameFormat\" BO_ 1 14;"), Format::flexible_faster)
        << "as CANdb++ counts them";
    EXPECT_EQ(format_in("BA_ \"VFrameFormat\" BO_ 1 0;"), Format::classical);
    EXPECT_EQ(format_in("BA_ \"VFrameFormat\" BO_ 1 3;"), Format::classical) << "J1939";
    EXPECT_EQ(format_in("BA_ \"VFrameFormat\" BO_ 1 \"StandardCAN_FD\";"), Format::flexible_faster);
    EXPECT_EQ(format_in(formats + "BA_ \"VFrameFormat\" BO_ 1 2;"), Format::flexible_faster);
    EXPECT_EQ(format_in(formats + "BA_ \"VFrameFormat\" BO_ 1 1;"), Format::classical);
    EXPECT_EQ(format_in(formats + "BA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN_FD\";"),
              Format::flexible_faster);
    EXPECT_EQ(format_in(formats +
                        "BA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN_FD\";\nBA_ \"VFrameFormat\" BO_ 1 1;"),
              Format::classical);
}

TEST(Dbc, reads_whether_the_bit_rate_switches) {
    const std::string fd = formats + "BA_ \"VFrameFormat\" BO_ 1 2;\n";
    EXPECT_EQ(format_in(fd + "BA_ \"CANFD_BRS\" BO_ 1 0;"), Format::flexible);
    EXPECT_EQ(format_in(fd + "BA_ \"CANFD_BRS\" BO_ 1 1;"), Format::flexible_faster);
    EXPECT_EQ(format_in(fd + "BA_DEF_ BO_ \"CANFD_BRS\" ENUM \"0\",\"1\";\nBA_DEF_DEF_ \"CANFD_BRS\" \"0\";"),
              Format::flexible);
    EXPECT_EQ(format_in("BA_ \"CANFD_BRS\" BO_ 1 1;"), Format::classical) << "of no CAN FD message";
}

TEST(Dbc, reads_at_run_time_the_same_map_as_at_compile_time) {
    expect_same(map, {contents_of("press.dbc"), controller.view()});
}

} // namespace
} // namespace tappet::can
