// A network's table: the configuration that it derives for a node, and each refusal.
#include "apps/carpet_loom/nodes/drive.eds.hpp"
#include "apps/carpet_loom/nodes/encoder.eds.hpp"
#include "drivers/canopen/network.hpp"
#include "tests/drivers/canopen/fifth.eds.hpp"
#include "tests/drivers/canopen/servo.eds.hpp"
#include "tests/drivers/canopen/values.dcf.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tappet::canopen {
namespace {

constexpr const Dictionary& drive = dictionary<files::drive_eds>;
constexpr const Dictionary& encoder = dictionary<files::encoder_eds>;

constexpr can::Signal statusword = can::signal("statusword", 0, 16);
constexpr can::Signal velocity = can::signal("velocity", 16, 32).as_signed();
constexpr auto drive_frame =
    can::receive(can::standard(0x185), "drive", can::bytes(6), can::every(5ms), statusword, velocity);
constexpr auto command_frame = can::transmit(can::standard(0x205), "command", can::bytes(2), can::every(2ms),
                                             can::signal("word", 0, 16).safe(0));
constexpr auto map = can::signal_map(drive_frame, command_frame);

constexpr NodeRow bare = node(5, "drive", drive).heartbeat(100ms);
constexpr NodeRow whole = bare.pdo("drive", on_event(5ms), {0x6041, 0x606C}).pdo("command", {0x6040});
constexpr ManagerRow boss = manager(127);

TEST(NetworkTable, configures_in_the_order_of_the_standard) {
    constexpr auto table = network(map, boss, whole.write(0x6060, -1));
    ASSERT_EQ(table.fault.view(), "");
    using enum ConfigurationStep::Kind;
    const std::vector<ConfigurationStep> wanted{
        {identity, 4, 0x1000, 0x00020192},
        {identity, 4, {0x1018, 1}, 0x3E7},
        {identity, 4, {0x1018, 2}, 0x402},
        {identity, 4, {0x1018, 3}, 0x00010002},
        {write, 1, 0x6060, 0xFF},
        {write, 2, 0x1017, 100},
        {confirm, 1, 0x6060, 0xFF},
        {confirm, 2, 0x1017, 100},
        {write, 4, {0x1800, 1}, 0xC0000185},
        {write, 1, {0x1800, 2}, 255},
        {write, 2, {0x1800, 3}, 0},
        {write, 2, {0x1800, 5}, 5},
        {write, 1, {0x1A00, 0}, 0},
        {write, 4, {0x1A00, 1}, 0x60410010},
        {write, 4, {0x1A00, 2}, 0x606C0020},
        {write, 1, {0x1A00, 0}, 2},
        {write, 4, {0x1800, 1}, 0x40000185},
        {confirm, 4, {0x1800, 1}, 0x40000185},
        {confirm, 1, {0x1800, 2}, 255},
        {confirm, 1, {0x1A00, 0}, 2},
        {confirm, 4, {0x1A00, 1}, 0x60410010},
        {confirm, 4, {0x1A00, 2}, 0x606C0020},
        {write, 4, {0x1400, 1}, 0x80000205},
        {write, 1, {0x1400, 2}, 255},
        {write, 1, {0x1600, 0}, 0},
        {write, 4, {0x1600, 1}, 0x60400010},
        {write, 1, {0x1600, 0}, 1},
        {write, 4, {0x1400, 1}, 0x205},
        {confirm, 4, {0x1400, 1}, 0x205},
        {confirm, 1, {0x1400, 2}, 255},
        {confirm, 1, {0x1600, 0}, 1},
        {confirm, 4, {0x1600, 1}, 0x60400010},
    };
    const std::vector<ConfigurationStep> steps{table.steps.begin(), table.steps.end()};
    EXPECT_EQ(steps, wanted);
}

TEST(NetworkTable, disables_unmapped_pdos) {
    constexpr auto alone = can::signal_map(drive_frame);
    const auto table = network(alone, boss, bare.pdo("drive", {0x6041, 0x606C}));
    ASSERT_EQ(table.fault.view(), "");
    EXPECT_EQ(table.steps[table.steps.size() - 1],
              (ConfigurationStep{ConfigurationStep::Kind::write, 4, {0x1400, 1}, 0x80000205}));
}

TEST(NetworkTable, disables_pdos_beyond_the_fourth_that_the_file_enables) {
    constexpr auto other = can::signal_map(can::receive(can::extended(0x185), "no PDO", can::bytes(1),
                                                        can::every(5ms), can::signal("byte", 0, 8)));
    const auto table = network(other, boss, node(5, "own", dictionary<files::fifth_eds>).heartbeat(100ms));
    ASSERT_EQ(table.fault.view(), "");
    std::string writes;
    for (const ConfigurationStep& step : table.steps)
        if (step.kind == ConfigurationStep::Kind::write && step.at.index != 0x1017)
            writes += std::string{to_text(step.at).view()} + (step.value == 0x8000'01C5 ? " off " : " ? ");
    EXPECT_EQ(writes, "1804h:1 off ");
}

TEST(NetworkTable, uses_the_values_of_a_dcf_unless_a_row_overrides_them) {
    constexpr auto none = can::signal_map(can::receive(can::extended(0x185), "no PDO", can::bytes(1),
                                                       can::every(5ms), can::signal("byte", 0, 8)));
    const auto table =
        network(none, boss, node(5, "own", dictionary<files::values_dcf>).heartbeat(100ms).write(0x2001, 15));
    ASSERT_EQ(table.fault.view(), "");
    std::string writes;
    for (const ConfigurationStep& step : table.steps)
        if (step.kind == ConfigurationStep::Kind::write)
            writes += std::string{to_text(step.at).view()} + "=" + std::to_string(step.value) + " ";
    EXPECT_EQ(writes, "2000h:0=12 2001h:0=15 1017h:0=100 ");
    const auto other = network(none, boss, node(6, "own", dictionary<files::values_dcf>).heartbeat(100ms));
    EXPECT_EQ(other.fault.view(), "node 6 \"own\": tests/drivers/canopen/values.dcf is the configuration of "
                                  "node 5; take the one of this node");
}

std::string in_file(Address at) {
    return "apps/carpet_loom/nodes/drive.eds:" + std::to_string(drive.find(at)->line);
}
template <class Map, class... Nodes>
std::string fault_of(const Map& signals, const ManagerRow& by, const Nodes&... nodes) {
    return std::string{network(signals, by, nodes...).fault.view()};
}
/// The part of a sentence about the drive that follows its name.
std::string of_drive(const std::string& said) {
    constexpr std::string_view name = "node 5 \"drive\"";
    EXPECT_TRUE(said.empty() || said.starts_with(name)) << said;
    return said.substr(std::min(name.size(), said.size()));
}
std::string of_row(const NodeRow& row) { return of_drive(fault_of(map, boss, row)); }
/// With another frame in place of the drive's.
template <class Frame> std::string of_frame(const Frame& frame, const NodeRow& row) {
    return of_drive(fault_of(can::signal_map(frame), boss, row));
}

TEST(NetworkTable, refuses_a_heartbeat_of_the_manager_that_nodes_cannot_monitor) {
    for (const Duration beats : {Duration{20s}, Duration{18725ms}, Duration{1500us}, Duration{-1ms}})
        EXPECT_EQ(
            fault_of(map, manager(127).sync(10ms).heartbeat(beats), node(5, "drive", drive).heartbeat(100ms)),
            "manager: its heartbeat must be a whole number of ms up to 18724, since its nodes wait for three "
            "and a half "
            "of "
            "them; shorten it");
}

TEST(NetworkTable, refuses_indistinguishable_or_unmonitored_nodes) {
    EXPECT_EQ(fault_of(map, boss, node(0, "drive", drive)),
              "node 0 \"drive\" has no identifier from 1 to 127; give it one");
    EXPECT_EQ(fault_of(map, boss, node(127, "drive", drive)),
              "node 127 \"drive\" has the identifier of the manager; give one of them another");
    EXPECT_EQ(of_row(node(5, "drive", drive)),
              " has no heartbeat, so that its loss would not be detected; write .heartbeat(100ms)");
    EXPECT_EQ(of_row(bare.heartbeat(1500us)),
              " has a heartbeat that is not a whole number of ms up to 65535; round it");
    EXPECT_EQ(of_row(bare.heartbeat(100ms, 100ms)),
              " would be lost before its next heartbeat comes; let heartbeat(every, lost) wait longer");
    EXPECT_EQ(fault_of(map, boss, whole, node(5, "other", encoder).heartbeat(1s)),
              "node 5 \"other\" has the identifier or the name of node 5 \"drive\"; give it its own");
    EXPECT_EQ(fault_of(map, manager(128), whole),
              "manager(128): its identifier is from 1 to 127; give it one");
    EXPECT_EQ(fault_of(map, boss.sync(1ms, 241), whole),
              "manager: SYNC counts to 241; the standard allows 2 to 240");
    EXPECT_EQ(of_row(node(5, "drive", Dictionary{}).heartbeat(1s)),
              " has no dictionary; name it: canopen::dictionary<files::..>");
}

TEST(NetworkTable, refuses_pdos_missing_in_the_device_or_the_map) {
    EXPECT_EQ(of_row(bare),
              ": frame \"drive\" is one of its PDOs, but no row configures it; write .pdo(\"drive\", {..})");
    EXPECT_EQ(of_row(bare.pdo("drives", {0x6041})),
              ": frame \"drives\" is not in the signal map; write its row there");
    EXPECT_EQ(
        fault_of(map, boss, node(6, "drive", drive).heartbeat(1s).pdo("drive", {0x6041})),
        "node 6 \"drive\": frame \"drive\" has the identifier 185h, which is not one of the node's PDOs; "
        "its first "
        "are 186h (it sends) and 206h (it receives)");
    EXPECT_EQ(of_frame(can::receive(can::standard(0x185), "drive", can::fd_bytes(6), can::every(5ms),
                                    statusword, velocity),
                       bare.pdo("drive", {0x6041, 0x606C})),
              ": frame \"drive\" is CAN FD, and CANopen has classical frames; write bytes(8) or less");
    EXPECT_EQ(of_frame(can::receive(can::standard(0x205), "drive", can::bytes(2), can::every(5ms),
                                    can::signal("word", 0, 16)),
                       bare.pdo("drive", {0x6040})),
              ": frame \"drive\" is one that the node receives, by its identifier; exchange can::receive and "
              "can::transmit");
    EXPECT_EQ(
        of_frame(can::receive(can::standard(0x285), "drive", can::bytes(2), can::every(5ms), statusword),
                 bare.pdo("drive", {0x6041})),
        ": frame \"drive\" is a PDO that the device does not have: apps/carpet_loom/nodes/drive.eds has no "
        "1801h "
        "or no 1A01h; take another identifier");
    EXPECT_EQ(of_row(whole.pdo("drive", {0x6041})),
              ": frame \"drive\" has 6 bytes, but its objects take 16 bits; correct one of them");
    EXPECT_EQ(of_row(whole.pdo("drive", {0x6041, 0x606C})),
              ": frame \"drive\" is mapped twice; keep one row");
    EXPECT_EQ(of_row(bare.pdo("drive", synchronous(), {0x6041, 0x606C})),
              ": frame \"drive\" is synchronous, but nothing produces SYNC; write manager(..).sync(..)");
    EXPECT_EQ(of_row(bare.pdo("drive", synchronous(245), {0x6041, 0x606C})),
              ": frame \"drive\" is synchronous(245); the standard ends at 240");
    EXPECT_EQ(of_row(bare.pdo("drive", on_event(2500us), {0x6041, 0x606C})),
              ": frame \"drive\" has an event timer that is not a multiple of 1 ms, or an inhibit time that "
              "is not one of 100 us, up to 65535; round it");
    EXPECT_EQ(of_frame(command_frame, bare.pdo("command", on_event(5ms), {0x6040})),
              ": frame \"command\" has an event timer, which the device does not have: "
              "apps/carpet_loom/nodes/drive.eds has no 1400h:5; let it be synchronous, or send by itself");
}

TEST(NetworkTable, refuses_objects_that_do_not_fit_the_frame) {
    EXPECT_EQ(of_row(bare.pdo("drive", {0x6041, 0x606D})),
              ": frame \"drive\" holds object 606Dh:0, which apps/carpet_loom/nodes/drive.eds does not have; "
              "correct one of them");
    EXPECT_EQ(of_row(bare.pdo("drive", {0x605A, 0x606C})),
              ": frame \"drive\" holds object 605Ah:0, which may not be mapped into a PDO (" +
                  in_file(0x605A) + "); take another one");
    EXPECT_EQ(of_row(bare.pdo("drive", {0x6041, 0x60FF})),
              ": frame \"drive\" holds object 60FFh:0, which the device only receives (" + in_file(0x60FF) +
                  "); map it in the other direction");
    EXPECT_EQ(of_row(bare.pdo("command", {0x6041})),
              ": frame \"command\" holds object 6041h:0, which the device only sends (" + in_file(0x6041) +
                  "); map it in the other direction");
    const auto with = [](auto... signals) {
        return of_frame(
            can::receive(can::standard(0x185), "drive", can::bytes(6), can::every(5ms), signals...),
            bare.pdo("drive", {0x6041, 0x606C}));
    };
    EXPECT_EQ(with(can::signal("speed", 16, 32)), ": signal \"drive.speed\" is unsigned, but object 606Ch:0 "
                                                  "\"Velocity actual value\" is signed; write as_signed()");
    EXPECT_EQ(with(can::signal("word", 0, 16).as_signed()),
              ": signal \"drive.word\" is signed, but object 6041h:0 \"Statusword\" is unsigned; take "
              "as_signed() or as_float() away");
    EXPECT_EQ(with(can::signal("speed", 8, 32).as_signed()),
              ": signal \"drive.speed\" reaches from bit 8 to 39, but object 6041h:0 \"Statusword\" from 0 "
              "to 15; move it or shorten it");
    EXPECT_EQ(
        with(can::signal("word", 7, 16).big_endian()),
        ": signal \"drive.word\" is big-endian, and CANopen has no such values; take big_endian() away");
    EXPECT_EQ(with(can::signal("ready", 0, 1), can::signal("on", 1, 1)), "") << "bits of an object";
}

TEST(NetworkTable, refuses_values_that_the_device_does_not_accept) {
    const auto written = [](Address at, std::int64_t value) { return of_row(whole.write(at, value)); };
    EXPECT_EQ(
        written(0x2000, 1),
        ": write(2000h:0, 1): apps/carpet_loom/nodes/drive.eds has no such object; correct one of them");
    EXPECT_EQ(written(0x6041, 1),
              ": write(6041h:0, 1): the object is only read (" + in_file(0x6041) + "); take it away");
    EXPECT_EQ(written(0x6060, 11), ": write(6060h:0, 11): the value is outside of the range of the object (" +
                                       in_file(0x6060) + "); correct it");
    EXPECT_EQ(written(0x6040, -1), ": write(6040h:0, -1): the value is outside of the range of the object (" +
                                       in_file(0x6040) + "); correct it");
    EXPECT_EQ(written(0x1017, 5),
              ": write(1017h:0, 5) is written by heartbeat(), pdo() and sync(); set it there");
    EXPECT_EQ(of_row(whole.write(0x6060, 1).write(0x6060, 3)), " writes 6060h:0 twice; keep one row");
}

TEST(NetworkTable, reserves_its_own_identifiers) {
    for (const std::uint32_t id : {0x000u, 0x080u, 0x0FFu, 0x100u, 0x585u, 0x605u, 0x705u}) {
        const auto own = can::signal_map(can::receive(can::standard(id), "mine", can::bytes(1),
                                                      can::every(5ms), can::signal("byte", 0, 8)));
        EXPECT_EQ(fault_of(own, boss, bare),
                  "frame \"mine\" has the identifier " + std::string{hex(id, 3).view()} +
                      ", which is the network's own; take it out of the signal map");
    }
}

TEST(NetworkTable, refuses_a_statusword_and_its_mode_in_different_frames) {
    constexpr auto apart =
        can::signal_map(can::receive(can::standard(0x185), "word", can::bytes(2), can::every(5ms),
                                     can::signal("word", 0, 16)),
                        can::receive(can::standard(0x285), "mode", can::bytes(1), can::every(5ms),
                                     can::signal("mode", 0, 8).as_signed()));
    constexpr NodeRow servo = node(5, "servo", dictionary<files::servo_eds>).heartbeat(100ms);
    constexpr ManagerRow beats = manager(127).sync(1ms);
    EXPECT_EQ(
        fault_of(apart, beats, servo.pdo("word", on_event(), {0x6041}).pdo("mode", synchronous(), {0x6061})),
        "node 5 \"servo\": its status word (6041) comes with frame \"word\" and the mode that it belongs to "
        "(6061) with frame \"mode\", at other times; map both into one frame, or let both be synchronous()");
    EXPECT_EQ(fault_of(apart, beats,
                       servo.pdo("word", synchronous(), {0x6041}).pdo("mode", synchronous(), {0x6061})),
              "");
}

} // namespace
} // namespace tappet::canopen
