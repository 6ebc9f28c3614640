// Faults of EDS and DCF files as makers write them, which leave no doubt whose they are: each is a note, and
// is refused only in a row that needs what is wrong, with a cure in that row.
#include "drivers/canopen/eds.hpp"
#include "drivers/canopen/eds_faults.hpp"
#include "drivers/canopen/eds_reader.hpp"
#include "drivers/canopen/network.hpp"
#include "drivers/canopen/simulated_node.hpp"
#include "tests/drivers/canopen/configured.dcf.hpp"
#include "tests/drivers/canopen/contradictory.eds.hpp"
#include "tests/drivers/canopen/crowded.eds.hpp"
#include "tests/drivers/canopen/flawed.eds.hpp"
#include "tests/drivers/canopen/unidentified.eds.hpp"
#include "tests/drivers/canopen/untyped.dcf.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace tappet::canopen {
namespace {

std::string contents_of(const std::string& name) {
    std::ifstream file{TAPPET_EDS_FILES "/" + name, std::ios::binary};
    EXPECT_TRUE(file) << name;
    return {std::istreambuf_iterator<char>{file}, {}};
}
std::string faults_of(const std::string& text) {
    std::string all;
    for (const EdsFault& each : eds_faults({"x.eds", text}))
        all += std::to_string(each.line) + ": " + each.meaning + " -> " + each.affects + "\n";
    return all;
}
const std::string device = "[1000]\nDataType=7\nAccessType=ro\n";
std::string with(const std::string& more) { return faults_of(device + more); }
/// The faults of object 2000h, whose section is line 4.
std::string variable(const std::string& entries) { return with("[2000]\n" + entries + "\n"); }

TEST(EdsFaults, files_without_faults_have_no_notes) {
    EXPECT_EQ(with(""), "");
    EXPECT_EQ(variable("DataType=6\nAccessType=rw\nLowLimit=-0"), "");
    EXPECT_EQ(variable("DataType=6\nAccessType=rw\nLowLimit=-0x0"), "");
    EXPECT_EQ(variable("DataType=8\nAccessType=rw\nLowLimit=-3.4028235E+38\nHighLimit=3.4028235E+38\n"
                       "DefaultValue=0.1"),
              "");
    EXPECT_EQ(variable("DataType=0x11\nAccessType=rw\nDefaultValue=0.10000000000000001"), "");
    EXPECT_EQ(variable("DataType=2\nAccessType=ro\nDefaultValue=0xC8"), "") << "a bit pattern";
    EXPECT_EQ(variable("DataType=2\nAccessType=rw\nLowLimit=0x80\nHighLimit=0xFF"), "") << "-128 to -1";
    EXPECT_EQ(
        with("[0040]\nParameterName=Record\nObjectType=6\nSubNumber=1\n"
             "[2000]\nObjectType=9\nDataType=0x40\nSubNumber=1\n[2000sub0]\nDataType=5\nAccessType=ro\n"),
        "")
        << "a record of a type of the file";
}

TEST(EdsFaults, that_nobody_needs_are_notes) {
    EXPECT_EQ(variable("DataType=2\nAccessType=ro\nLowLimit=0x00\nHighLimit=0xFF"),
              "8: HighLimit 0xFF of 2000h:0 is under its LowLimit -> nobody\n")
        << "nobody writes it";
    EXPECT_EQ(variable("DataType=6\nAccessType=rw\nHighLimit=65536"),
              "7: HighLimit 65536 of 2000h:0 lies beyond its DataType and bounds nothing -> nobody\n");
    EXPECT_EQ(variable("DataType=6\nAccessType=rw\nLowLimit=-1"),
              "7: LowLimit -1 of 2000h:0 lies beyond its DataType and bounds nothing -> nobody\n");
    EXPECT_EQ(variable("DataType=8\nAccessType=rw\nHighLimit=1e39"),
              "7: HighLimit 1e39 of 2000h:0 lies beyond its DataType and bounds nothing -> nobody\n");
    EXPECT_EQ(variable("DataType=5\nAccessType=ro\nDefaultValue=256"),
              "7: DefaultValue 256 of 2000h:0 does not fit its DataType -> nobody\n");
    EXPECT_EQ(variable("DataType=2\nAccessType=ro\nLowLimit=-3\nHighLimit=3\nDefaultValue=-4"),
              "4: the value -4 of 2000h:0 is outside of its own limits -> nobody\n");
    EXPECT_EQ(with("[1016]\nObjectType=8\nSubNumber=3\n[1016sub0]\nDataType=5\nAccessType=ro\n"),
              "6: SubNumber of 1016h is 3, and 1 sub-index is there -> nobody\n");
    EXPECT_EQ(with("[1016]\nObjectType=8\n"),
              "4: SubNumber of 1016h is not written, and 0 sub-indices are there -> nobody\n");
    EXPECT_EQ(with("[OptionalObjects]\nSupportedObjects=1\n1=0x1017\n2=0x21000\n"),
              "6: a list names object 0x1017, which has no section -> nobody\n"
              "7: a list names object 0x21000, which has no section -> nobody\n");
    EXPECT_EQ(
        with("[DeviceInfo]\nNrOfRXPDO=1\nCompactPDO=23\n[1400]\nObjectType=9\nSubNumber=1\n[1400sub1]\n"
             "DataType=7\nAccessType=rw\n"),
        "6: CompactPDO 23 stands for PDO objects without sections; only those with sections are read -> "
        "rows that map one of those PDOs\n");
}

TEST(EdsFaults, name_the_rows_that_they_affect) {
    const std::string maps = " -> rows that map or write 2000h:0\n", writes = " -> rows that write 2000h:0\n";
    const std::string no_meaning = "\" has no meaning there (CiA 301, CiA 306)" + maps;
    EXPECT_EQ(variable("DataType=0x40\nAccessType=ro"), "5: DataType \"0x40" + no_meaning);
    EXPECT_EQ(variable("DataType=2\nAccessType=rw\nLowLimit=0x00\nHighLimit=0xFF"),
              "8: HighLimit 0xFF of 2000h:0 is under its LowLimit" + writes);
    EXPECT_EQ(variable("DataType=2\nAccessType=rw\nLowLimit=-5\nHighLimit=0xFF"),
              "8: HighLimit 0xFF of 2000h:0 is a negative number for its DataType, or one beyond it" +
                  writes);
    EXPECT_EQ(variable("DataType=2\nAccessType=rw\nHighLimit=0xFF"),
              "7: HighLimit 0xFF of 2000h:0 is a negative number for its DataType, or one beyond it" +
                  writes);
    EXPECT_EQ(variable("DataType=5\nAccessType=rw\nLowLimit=9\nHighLimit=3"),
              "8: HighLimit 3 of 2000h:0 is under its LowLimit" + writes);
    EXPECT_EQ(variable("DataType=5\nAccessType=rw\nLowLimit=256"),
              "7: LowLimit 256 of 2000h:0 does not fit its DataType" + writes);
    EXPECT_EQ(variable("DataType=5\nAccessType=rw\nParameterValue=256"),
              "7: ParameterValue 256 of 2000h:0 does not fit its DataType -> nodes of this file without "
              ".write(2000h:0, ..)\n");
}

TEST(EdsFaults, are_listed_all_at_once_in_order) {
    const std::string all = " -> every node of this file\n";
    EXPECT_EQ(
        with("[2000]\nDataType=0x40\nAccessType=r\nDefaultValue=x\n[2001]\nAccessType=ro\n<xml>\n"),
        "5: DataType \"0x40\" has no meaning there (CiA 301, CiA 306) -> rows that map or write 2000h:0\n"
        "6: AccessType \"r\" has no meaning there (CiA 301, CiA 306)" +
            all + "8: [2001] has no DataType" + all +
            "10: \"<xml>\" is neither a [section] nor an entry Key=Value" + all);
    EXPECT_EQ(faults_of(""), "1: it has no object; is it an EDS or DCF file of CiA 306?" + all);
    EXPECT_EQ(faults_of("[2000]\nDataType=5\nAccessType=ro\n"),
              "1: object 1000h (device type), which each device has, is missing" + all);
    std::string many = device;
    for (int i = 0x2000; i < 0x2100; ++i)
        many += "[" + std::string{hex(static_cast<unsigned>(i), 4).view().substr(0, 4)} + "]\n";
    EXPECT_EQ(eds_faults({"x.eds", many}).size(), 2u * 256);
}

/// A device with its faults, as a network's rows see it.
constexpr auto map = can::signal_map(can::transmit(can::standard(0x205), "out", can::bytes(2),
                                                   can::every(5ms), can::signal("value", 0, 16).safe(0)));
constexpr auto none = can::signal_map(
    can::receive(can::extended(0x1234), "other", can::bytes(1), can::every(5ms), can::signal("value", 0, 8)));
constexpr NodeRow node_of_flawed = node(5, "own", dictionary<files::flawed_eds>).heartbeat(100ms);

template <class Map> std::string fault_of(const Map& frames, const NodeRow& row) {
    return std::string{network(frames, manager(127), row).fault.view()};
}

TEST(EdsFaults, in_objects_without_rows_are_no_fault_of_the_network) {
    EXPECT_EQ(fault_of(none, node_of_flawed), "");
    EXPECT_EQ(fault_of(none, node_of_flawed.write(0x2001, 65535)), "") << "a limit beyond the type";
}

TEST(EdsFaults, in_limits_leave_those_of_the_next_object) {
    const detail::EdsReader read{{"x.eds", "[1000]\nDataType=7\nAccessType=ro\n"
                                           "[2000]\nDataType=2\nAccessType=rw\nLowLimit=0\nHighLimit=0xFF\n"
                                           "[2001]\nDataType=5\nAccessType=rw\nHighLimit=9\n"}};
    ASSERT_EQ(read.objects.size(), 3u);
    EXPECT_EQ(read.objects[1].flaws, flaw::limits);
    EXPECT_EQ(read.objects[2].flaws, 0);
    EXPECT_TRUE(read.objects[2].high.given);
    EXPECT_EQ(read.objects[2].high.bits, 9u);
}

TEST(EdsFaults, in_a_written_object_are_refused_with_a_cure_in_its_row) {
    EXPECT_EQ(fault_of(none, node_of_flawed.write(0x2000, 5)),
              "node 5 \"own\": tests/drivers/canopen/flawed.eds:31: HighLimit 0xFF of 2000h:0 is under its "
              "LowLimit; believe the "
              "device: canopen::dictionary<.., canopen::despite(0x2000, canopen::DataType::integer8)>");
    constexpr NodeRow believed =
        node(5, "own", dictionary<files::flawed_eds, despite(0x2000, DataType::integer8)>).heartbeat(100ms);
    EXPECT_EQ(fault_of(none, believed.write(0x2000, 5)), "");
    EXPECT_EQ(fault_of(none, believed.write(0x2000, 128)), "") << "a bit pattern, as elsewhere";
    EXPECT_NE(fault_of(none, believed.write(0x2000, 256)), "");
    EXPECT_NE(fault_of(none, believed.write(0x2002, 1)), "") << "another object";
}

TEST(EdsFaults, in_mapped_objects_are_told_together) {
    EXPECT_EQ(fault_of(map, node_of_flawed.pdo("out", {{0x2003, 1}}).write(0x2000, 5).write(0x2002, 1)),
              "node 5 \"own\": tests/drivers/canopen/flawed.eds:44: DataType \"0x41\" has no meaning there "
              "(CiA 301, CiA 306); "
              "believe the device: canopen::dictionary<.., canopen::despite({0x2003, 1}, "
              "canopen::DataType::..)>; tests/drivers/canopen/flawed.eds:31: HighLimit 0xFF of 2000h:0 is "
              "under its "
              "LowLimit; believe the device: canopen::dictionary<.., canopen::despite(0x2000, "
              "canopen::DataType::integer8)>; and 1 more of its faults");
    EXPECT_EQ(fault_of(map, node_of_flawed.pdo("out", {0x2002})),
              "node 5 \"own\": tests/drivers/canopen/flawed.eds:37: DataType \"0x40\" has no meaning there "
              "(CiA 301, CiA 306); "
              "believe the device: canopen::dictionary<.., canopen::despite(0x2002, canopen::DataType::..)>");
    constexpr auto& believed = dictionary<files::flawed_eds, despite(0x2002, DataType::unsigned16),
                                          despite({0x1A00, 1}, DataType::unsigned32, Access::read_only)>;
    static_assert(std::ranges::is_sorted(believed.objects, {}, &Object::at));
    EXPECT_EQ(believed.objects.size(), dictionary<files::flawed_eds>.objects.size() + 1);
    ASSERT_NE(believed.find({0x1A00, 1}), nullptr) << "an object that the file lacks";
    EXPECT_EQ(believed.find({0x1A00, 1})->access, Access::read_only);
    constexpr auto net =
        network(map, manager(127), node(5, "own", believed).heartbeat(100ms).pdo("out", {0x2002}));
    ASSERT_EQ(net.fault.view(), "");
    bool mapped = false;
    for (const ConfigurationStep& step : net.steps)
        mapped |= step.at == Address{0x1600, 1} && step.value == 0x2002'0010 && step.bytes == 4;
    EXPECT_TRUE(mapped) << "with the bits of the believed type";
}

template <const Dictionary& of> SdoAbort maps_2002() {
    SimulatedDevice<of> twin{5};
    twin.set({0x1400, 1}, pdo_invalid);
    std::array<std::uint8_t, 4> entry{};
    to_bytes(0x2002'0010, entry);
    return twin.write_object({0x1600, 1}, entry);
}

TEST(EdsFaults, are_cured_for_the_simulated_device_too) {
    EXPECT_EQ(maps_2002<dictionary<files::flawed_eds>>(), SdoAbort::not_mappable);
    constexpr auto& believed = dictionary<files::flawed_eds, despite(0x2002, DataType::unsigned16)>;
    EXPECT_EQ(maps_2002<believed>(), SdoAbort::none);
}

TEST(EdsFaults, in_the_values_of_a_dcf_are_refused_unless_a_row_writes_them) {
    constexpr NodeRow row = node(5, "own", dictionary<files::configured_dcf>).heartbeat(100ms);
    EXPECT_EQ(fault_of(none, row), "node 5 \"own\": tests/drivers/canopen/configured.dcf:7: the value 11 of "
                                   "2000h:0 is outside of its own "
                                   "limits; write the value meant: "
                                   ".write(0x2000, ..)");
    EXPECT_EQ(fault_of(none, row.write(0x2000, 10)), "");
}

TEST(EdsFaults, of_a_type_make_its_value_unknown_until_it_is_believed) {
    const auto fault = fault_of(none, node(5, "own", dictionary<files::untyped_dcf>).heartbeat(100ms));
    EXPECT_NE(fault.find("tests/drivers/canopen/untyped.dcf:8: DataType"), fault.npos) << fault;
    constexpr auto net =
        network(none, manager(127),
                node(5, "own", dictionary<files::untyped_dcf, despite(0x2000, DataType::unsigned16)>)
                    .heartbeat(100ms));
    ASSERT_EQ(net.fault.view(), "");
    bool written = false;
    for (const ConfigurationStep& step : net.steps)
        written |= step.kind == ConfigurationStep::Kind::write && step.at == Address{0x2000} &&
                   step.value == 700 && step.bytes == 2;
    EXPECT_TRUE(written);
    EXPECT_NE(
        fault_of(none, node(5, "own", dictionary<files::untyped_dcf, despite(0x2000, DataType::unsigned8)>)
                           .heartbeat(100ms)),
        "")
        << "700 does not fit";
}

TEST(EdsFaults, of_compact_pdos_are_cured_by_their_objects) {
    constexpr auto second = can::signal_map(can::transmit(
        can::standard(0x305), "out", can::bytes(2), can::every(5ms), can::signal("value", 0, 16).safe(0)));
    const auto row = [](const Dictionary& of) {
        return node(5, "own", of).heartbeat(100ms).pdo("out", {0x2002});
    };
    constexpr Belief word = despite(0x2002, DataType::unsigned16);
    EXPECT_EQ(
        fault_of(second, row(dictionary<files::flawed_eds, word>)),
        "node 5 \"own\": frame \"out\" is a PDO that the device does not have: "
        "tests/drivers/canopen/flawed.eds has no 1401h or no "
        "1601h; take another identifier, or believe that CompactPDO stands for them: a canopen::despite(..) "
        "for "
        "each");
    EXPECT_EQ(
        fault_of(
            second,
            row(dictionary<files::flawed_eds, word, despite({0x1401, 1}, DataType::unsigned32),
                           despite({0x1401, 2}, DataType::unsigned8), despite(0x1601, DataType::unsigned8),
                           despite({0x1601, 1}, DataType::unsigned32)>)),
        "");
}

TEST(EdsFaults, of_an_identity_are_cured_in_the_row_of_the_node) {
    EXPECT_EQ(
        faults_of(contents_of("contradictory.eds")),
        "13: 1018h:1 is 17, but [DeviceInfo] (line 1) says 0x10 -> nodes of this file without .identity(..)\n"
        "17: 1018h:3 is 2, but [DeviceInfo] (line 1) says 1 -> nodes of this file without .identity(..)\n");
    constexpr NodeRow row = node(5, "own", dictionary<files::contradictory_eds>).heartbeat(100ms);
    EXPECT_EQ(fault_of(none, row),
              "node 5 \"own\": tests/drivers/canopen/contradictory.eds:13: 1018h:1 is 17, but [DeviceInfo] "
              "(line 1) says 0x10; state the device's: "
              ".identity(vendor, product, revision); tests/drivers/canopen/contradictory.eds:17: 1018h:3 is "
              "2, but [DeviceInfo] (line 1) says 1; "
              "state "
              "the device's: .identity(vendor, product, revision)");
    EXPECT_NE(fault_of(none, row.of_any_revision()), "");
    constexpr auto net = network(none, manager(127), row.identity(0x11, 0, 2));
    ASSERT_EQ(net.fault.view(), "");
    EXPECT_EQ(net.steps[0].at, (Address{0x1018, 1}));
    EXPECT_EQ(net.steps[0].value, 0x11u);
}

TEST(EdsFaults, of_an_identity_are_found_behind_many_notes) {
    constexpr NodeRow row = node(5, "own", dictionary<files::crowded_eds>).heartbeat(100ms);
    ASSERT_GT(row.dictionary.notes.size(), 64u);
    const std::string told = fault_of(none, row);
    EXPECT_NE(told.find("1018h:1 is 17, but [DeviceInfo] (line 1) says 0x10"), told.npos) << told;
    EXPECT_EQ(fault_of(none, row.identity(0x11, 0, 2)), "");
}

TEST(EdsFaults, of_an_identity_that_could_not_be_compared_are_refused) {
    constexpr NodeRow row = node(5, "own", dictionary<files::unidentified_eds>).heartbeat(100ms);
    EXPECT_EQ(fault_of(none, row), "");
    EXPECT_EQ(
        fault_of(none, row.identity(0x11, 0x22)),
        "node 5 \"own\" states an identity(..), but tests/drivers/canopen/unidentified.eds has no 1018h:1, "
        "so that the device's "
        "number would not be compared; believe that the device has it: canopen::dictionary<.., "
        "canopen::despite({0x1018, 1}, canopen::DataType::unsigned32, canopen::Access::read_only)>, or take "
        "identity(..) away");
    EXPECT_EQ(fault_of(none, row.identity(0, 0)), "");
    constexpr NodeRow believed =
        node(5, "own",
             dictionary<files::unidentified_eds,
                        despite({0x1018, 1}, DataType::unsigned32, Access::read_only)>)
            .heartbeat(100ms);
    constexpr auto net = network(none, manager(127), believed.identity(0x11, 0));
    ASSERT_EQ(net.fault.view(), "");
    EXPECT_EQ(net.steps[0], (ConfigurationStep{ConfigurationStep::Kind::identity, 4, {0x1018, 1}, 0x11}));
}

} // namespace
} // namespace tappet::canopen
