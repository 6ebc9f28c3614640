// Damaged DCF files: a network's start-up is that of the undamaged file, or the file or the network is
// refused. No object takes another's value, no value of the identity or of a PDO is lost.
#include "drivers/canopen/eds_reader.hpp"
#include "drivers/canopen/network.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace tappet::canopen {
namespace {

/// A DCF of all kinds of sections.
const std::string sample = R"([FileInfo]
FileName=servo.dcf
[DeviceInfo]
VendorName=ACME
VendorNumber=0x3E7
ProductName=Servo
ProductNumber=0x402
RevisionNumber=0x10002
NrOfRXPDO=1
CompactPDO=0
[Comments]
Lines=1
Line1=made by hand
[DeviceComissioning]
NodeID=0x5
[DummyUsage]
Dummy0001=0
[MandatoryObjects]
SupportedObjects=2
1=0x1000
2=0x1018
[0040]
ParameterName=A record of the device
ObjectType=0x6
SubNumber=1
; the objects
[1000]
ParameterName=Device type
ObjectType=0x7
DataType=0x7
AccessType=ro
DefaultValue=0x20192
[1017]
ParameterName=Heartbeat
ObjectType=0x7
DataType=0x6
AccessType=rw
DefaultValue=0
[1018]
ParameterName=Identity
ObjectType=0x9
SubNumber=4
[1018sub0]
ParameterName=Number
DataType=0x5
AccessType=ro
DefaultValue=3
[1018sub1]
ParameterName=Vendor
DataType=0x7
AccessType=ro
[1018sub2]
ParameterName=Product
DataType=0x7
AccessType=ro
DefaultValue=0x402
[1018sub3]
ParameterName=Revision
DataType=0x7
AccessType=ro
[1400]
ParameterName=RPDO1
ObjectType=0x9
SubNumber=3
[1400sub0]
DataType=0x5
AccessType=ro
DefaultValue=2
[1400sub1]
ParameterName=COB-ID
DataType=0x7
AccessType=rw
DefaultValue=$NODEID+0x200
[1400sub2]
ParameterName=Type
DataType=0x5
AccessType=rw
DefaultValue=255
[2001]
ParameterName=Gains
ObjectType=0x8
DataType=0x6
AccessType=rw
CompactSubObj=3
[2001Value]
NrOfEntries=2
1=11
3=13
[6065]
ParameterName=Following error window
ObjectType=0x7
DataType=0x7
AccessType=rww
LowLimit=0
HighLimit=100000
DefaultValue=10
ParameterValue=2000
PDOMapping=1
ObjFlags=0
[6083]
ParameterName=Acceleration
DataType=0x7
AccessType=rw
DefaultValue=50
[6084]
ParameterName=Deceleration
DataType=0x7
AccessType=rw
DefaultValue=50
ParameterValue=90000
[6086]
ParameterName=Gain
DataType=0x11
AccessType=rw
ParameterValue=1.5e2
)";

constexpr auto none = can::signal_map(
    can::receive(can::extended(0x1234), "other", can::bytes(1), can::every(5ms), can::signal("value", 0, 8)));

/// Returns the start-up of a node as "1018h:1 = 999" and so on; "refused: " and why.
std::vector<std::string> start_of(const std::string& text) {
    const auto read = std::make_unique<detail::EdsReader>(SourceText{"x.dcf", text});
    const auto refused = [](const Sentence& why) {
        return std::vector{"refused: " + std::string{why.view()}};
    };
    if (!read->fault.empty()) return refused(read->fault);
    const Dictionary dictionary{"x.dcf",
                                read->product,
                                read->node,
                                read->identity,
                                read->doubted,
                                {read->objects.begin(), read->objects.size()},
                                {read->notes.begin(), read->notes.size()}};
    const auto net = network(none, manager(127), node(5, "own", dictionary).heartbeat(100ms));
    if (!net.fault.empty()) return refused(net.fault);
    std::vector<std::string> steps;
    for (const ConfigurationStep& step : net.steps) {
        Sentence told = to_text(step.at);
        told.add(step.kind == ConfigurationStep::Kind::identity ? " is "
                 : step.kind == ConfigurationStep::Kind::write  ? " = "
                                                                : " confirms ");
        steps.emplace_back(told.add(step.value).add(" of ").add(unsigned{step.bytes}).view());
    }
    return steps;
}
bool is_refused(const std::vector<std::string>& steps) { return steps.at(0).starts_with("refused"); }

/// Returns the line of the text with this character.
std::string line_at(const std::string& text, std::size_t at) {
    const std::size_t begin = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
    return text.substr(begin, text.find('\n', at) - begin);
}
/// Returns the damage that nothing in a file shows: a number is another number, or an entry has none.
bool is_another_number(const std::string& line, const std::string& damaged) {
    const std::size_t sign = line.find('=');
    if (sign == line.npos || line.substr(0, sign + 1) != damaged.substr(0, sign + 1)) return false;
    const std::set<std::string> numbers{
        "VendorNumber", "ProductNumber", "RevisionNumber", "DefaultValue", "ParameterValue", "1", "3",
        "DataType"};
    if (!numbers.contains(line.substr(0, sign))) return false;
    const std::string_view value = trimmed(std::string_view{damaged}.substr(sign + 1));
    return value.empty() || to_number(value, DataType::real64).fault == NumberFault::none ||
           to_number(value, DataType::unsigned32).fault == NumberFault::none;
}

/// Damages the sample at each character, and tells starts that differ in more than another number.
void damage_each(const std::function<std::string(std::string, std::size_t)>& damage) {
    const std::vector<std::string> whole = start_of(sample);
    ASSERT_FALSE(is_refused(whole)) << whole[0];
    std::size_t refused = 0;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        const std::string text = damage(sample, i);
        const std::vector<std::string> steps = start_of(text);
        if (is_refused(steps)) ++refused;
        if (is_refused(steps) || steps == whole) continue;
        // Another number takes no step away but its own, and changes none of another object.
        const std::string line = line_at(sample, i), now = line_at(text, i);
        EXPECT_TRUE(is_another_number(line, now)) << line << " -> " << now;
        std::size_t lost = 0, of_identity = 0, new_ones = 0;
        for (const std::string& each : whole) lost += std::ranges::find(steps, each) == steps.end() ? 1u : 0u;
        for (const std::string& each : steps) {
            new_ones += std::ranges::find(whole, each) == whole.end() ? 1u : 0u;
            of_identity += each.find(" is ") != each.npos ? 1u : 0u;
        }
        EXPECT_EQ(of_identity, 4u) << line << " -> " << now << " opens the gate";
        EXPECT_LE(lost, 2u) << line << " -> " << now << ": the write and its confirmation";
        EXPECT_LE(new_ones, lost) << line << " -> " << now;
    }
    EXPECT_GT(refused, sample.size() / 2);
}

TEST(EdsDamage, of_a_deleted_character_starts_the_same_or_is_refused) {
    damage_each([](std::string text, std::size_t at) { return text.erase(at, 1); });
}
TEST(EdsDamage, of_another_character_starts_the_same_or_is_refused) {
    for (const char wrong : {'Z', '#', ' ', '\r'})
        damage_each([wrong](std::string text, std::size_t at) {
            if (text[at] == '\n' || (text[at] == '[' && wrong == '\r')) return text.replace(at, 1, 1, '#');
            return text.replace(at, 1, 1, wrong);
        });
}
TEST(EdsDamage, of_an_added_character_starts_the_same_or_is_refused) {
    for (const char wrong : {'M', '[', ']', '='})
        damage_each([wrong](std::string text, std::size_t at) { return text.insert(at, 1, wrong); });
}

const std::string device = "[1000]\nDataType=7\nAccessType=ro\nDefaultValue=0x192\n[1017]\nDataType=6\n"
                           "AccessType=rw\n"; // 7 lines

/// Returns "LINE: MEANING" of the sentence that refuses the file; empty: it is read.
std::string refusal(const std::string& more) {
    const std::string all{detail::EdsReader{SourceText{"x.dcf", device + more}}.fault.view()};
    return all.empty() ? all : all.substr(6, all.find("; the file is not read") - 6);
}
/// The refusal of object 2000h, whose section is line 8.
std::string variable(const std::string& entries) { return refusal("[2000]\n" + entries + "\n"); }

TEST(EdsDamage, of_lines_and_sections_refuses_the_file) {
    EXPECT_EQ(refusal("[6084\nParameterValue=90000\n"),
              "8: \"[6084\" is neither a [section] nor an entry Key=Value");
    EXPECT_EQ(refusal("[6084]\nParameterValue 90000\n"),
              "9: \"ParameterValue 90000\" is neither a [section] nor an entry Key=Value");
    for (const char* name : {"6084ub1", "608", "6084sub", "6O84", "6084alue", "ZO01Value", "1000sub100", ""})
        EXPECT_EQ(refusal("[" + std::string{name} + "]\n"),
                  "8: [" + std::string{name} + "] is no section of CiA 306");
    for (const char* name : {"M1ModuleInfo", "M12SubExt6000", "0040sub1", "2001Name", "Tool1", "Maker"})
        EXPECT_EQ(refusal("[" + std::string{name} + "]\n"), "");
    EXPECT_EQ(refusal("[0084]\nDataType=7\nParameterValue=5\n"),
              "10: ParameterValue is no entry of [0084]: the name of its own section is missing or damaged");
    EXPECT_EQ(refusal("[DeviceIno]\nVendorNumber=5\n"),
              "9: VendorNumber is no entry of [DeviceIno]: the name "
              "of its own section is missing or damaged");
    EXPECT_EQ(refusal("[Comments]\nLine1=[6084]\nDataType=7\n"),
              "10: DataType is no entry of [Comments]: the name of its own section is missing or damaged");
    EXPECT_EQ(refusal("[Comments]\nLine1=a[2001Value]\n1=5\n"),
              "9: \"a[2001Value]\" holds another entry or section: a line's end is missing");
    EXPECT_EQ(variable("ParameterName=aParameterValue=5\nDataType=7\nAccessType=rw"),
              "9: \"aParameterValue=5\" holds another entry or section: a line's end is missing");
    EXPECT_EQ(refusal("[DeviceInfo]\n[DeviceInfo]\n"), "9: [DeviceInfo] is there twice, first in line 8");
    EXPECT_EQ(refusal("[1000]\nDataType=7\nAccessType=ro\n"), "8: 1000h:0 is there twice, first in line 1");
    EXPECT_EQ(refusal("[2000]\nObjectType=8\n[2000]\nObjectType=8\n"),
              "10: 2000h:0 is there twice, first in line 8");
    EXPECT_EQ(refusal("[1A00sub1]\nDataType=7\nAccessType=ro\n"),
              "8: 1A00h:1 is a part of 1A00h, which has no section");
    EXPECT_EQ(refusal("[1000sub1]\nDataType=7\nAccessType=ro\n"),
              "8: 1000h:1 is a part of 1000h, which is a variable");
}

TEST(EdsDamage, of_words_and_numbers_refuses_the_file) {
    const std::string no_meaning = "\" has no meaning there (CiA 301, CiA 306)";
    EXPECT_EQ(variable("DataType=7\nAccessType=rw\nParametrValue=9"),
              "11: \"ParametrValue\" is not ParameterValue, and nearly");
    for (const char* key : {"ParmaeterValue", "arameterValue", "ParameterValu", "ParameterVale",
                            "Para=meterValue", "ParameterValu=1"})
        EXPECT_NE(variable("DataType=7\nAccessType=rw\n" + std::string{key} + "=9"), "") << key;
    for (const char* key : {"ObjFlags", "Denotation", "ParameterUnit", "VendorName"})
        EXPECT_EQ(variable("DataType=7\nAccessType=rw\n" + std::string{key} + "=9"), "") << key;
    EXPECT_EQ(variable("AccessType=ro"), "8: [2000] has no DataType");
    EXPECT_EQ(variable("DataType=5"), "8: [2000] has no AccessType");
    EXPECT_EQ(variable("DataType=5\nDataType=5\nAccessType=ro"),
              "10: DataType is there twice in [2000], first in line 9");
    for (const char* type : {"O7", "6", "08", "5"})
        EXPECT_EQ(variable("ObjectType=" + std::string{type} + "\nDataType=7\nAccessType=rw"),
                  "9: ObjectType \"" + std::string{type} + no_meaning);
    for (const char* type : {"byte", "0x17", "0x1C", "0", "011"})
        EXPECT_EQ(variable("DataType=" + std::string{type} + "\nAccessType=rw"),
                  "9: DataType \"" + std::string{type} + no_meaning);
    EXPECT_EQ(variable("DataType=5\nAccessType=r"), "10: AccessType \"r" + no_meaning);
    EXPECT_EQ(variable("DataType=5\nAccessType=rw\nPDOMapping=2"), "11: PDOMapping \"2" + no_meaning);
    EXPECT_EQ(variable("DataType=5\nAccessType=rw\nHighLimit=many"),
              "11: HighLimit \"many\" of 2000h:0 is not a number");
    EXPECT_EQ(variable("DataType=5\nAccessType=rw\nDefaultValue=x"),
              "11: DefaultValue \"x\" of 2000h:0 is not a number");
    EXPECT_EQ(variable("DataType=5\nAccessType=rw\nParameterValue=08"),
              "11: ParameterValue \"08\" of 2000h:0 is not a number");
    EXPECT_EQ(refusal("[OptionalObjects]\n1=0x1O17\n"),
              "9: a list names object 0x1O17, which has no section");
}

TEST(EdsDamage, of_values_of_an_array_refuses_the_file) {
    const auto values = [](const std::string& compact, const std::string& entries) {
        return refusal("[2001]\nObjectType=8\nDataType=5\nAccessType=rw\n" + compact + "\n[2001Value]\n" +
                       entries + "\n"); // line 14
    };
    EXPECT_EQ(values("CompactSubObj=2", "NrOfEntries=1\n2=0x7"), "");
    EXPECT_EQ(values("CompactSubObj=2", "3=1"),
              "14: it is a value of 2001h:3, which CompactSubObj does not make");
    EXPECT_EQ(values("CompactSubObj=2", "l=1"),
              "14: it is a value of 2001h:l, which CompactSubObj does not make");
    EXPECT_EQ(values("CompactSubObj=2", "1=5\n1=6"), "15: 2001h:1 has two values, the first in line 14");
    EXPECT_EQ(values("CompactSubObj=2", "1="), "14: Value \"\" of 2001h:1 is not a number");
    EXPECT_EQ(values("CompactSubObj=255", "1=1"),
              "12: CompactSubObj \"255\" has no meaning there (CiA 301, CiA 306)");
    EXPECT_EQ(values("ParameterValue=3", ""),
              "12: ParameterValue 3 of 2001h: a record or an array has values in its sub-indices");
}

TEST(EdsDamage, of_the_identity_and_the_node_refuses_the_file) {
    const std::string no_meaning = "\" has no meaning there (CiA 301, CiA 306)";
    EXPECT_EQ(refusal("[DeviceInfo]\nVendorNumber=0x3E7h\n"), "9: VendorNumber \"0x3E7h" + no_meaning);
    EXPECT_EQ(refusal("[DeviceInfo]\nProductNumber=402 h\n"), "9: ProductNumber \"402 h" + no_meaning);
    EXPECT_EQ(refusal("[DeviceComissioning]\nNodeID=0x07h\n"), "9: NodeID \"0x07h" + no_meaning);
    EXPECT_EQ(refusal("[DeviceCommissioning]\nNodeID=128\n"), "9: NodeID \"128" + no_meaning);
    EXPECT_EQ(refusal("[DeviceComissioning]\n"), "8: [DeviceComissioning] has no NodeID");
    const std::string vendor = "[1018]\nObjectType=9\nSubNumber=1\n[1018sub1]\nAccessType=ro\n"; // to line 12
    EXPECT_EQ(refusal(vendor + "DataType=7\nDefaultValue=3E7\n"),
              "14: DefaultValue \"3E7\" of 1018h:1 is not a number");
    EXPECT_EQ(refusal(vendor + "DataType=7\nDefaultValue=0x100000000\n"),
              "14: DefaultValue 0x100000000 of 1018h:1 does not fit its DataType");
    EXPECT_EQ(refusal(vendor + "DataType=0x40\nDefaultValue=999\n"),
              "11: Value \"999\" of 1018h:1 is not a number");
    EXPECT_EQ(refusal(vendor + "DataType=0x1B\nDefaultValue=0x100000000\n"),
              "11: Value \"0x100000000\" of 1018h:1 is not a number");
}

TEST(EdsDamage, of_pdos_refuses_the_file) {
    const std::string record = "[1400]\nObjectType=9\nSubNumber=1\n"; // to line 10
    EXPECT_EQ(refusal(record), "8: PDO 1400h has no sub-index 1 of 32 bits, its COB-ID, by which it is "
                               "silenced");
    EXPECT_EQ(refusal(record + "[1400sub1]\nDataType=5\nAccessType=rw\n"),
              "8: PDO 1400h has no sub-index 1 of 32 bits, its COB-ID, by which it is silenced");
    const std::string cob = record + "[1400sub1]\nDataType=7\nAccessType=rw\n";
    EXPECT_EQ(refusal(cob), "");
    EXPECT_EQ(refusal(cob + "DefaultValue=0x1FFFFFFFF\n"),
              "14: DefaultValue 0x1FFFFFFFF of 1400h:1 does not fit its DataType");
    const std::string compact = "CompactPDO 23 stands for PDO objects without sections; only those with "
                                "sections are read";
    EXPECT_EQ(refusal("[DeviceInfo]\nCompactPDO=23\n"), "9: " + compact);
    EXPECT_EQ(refusal(cob + "[DeviceInfo]\nCompactPDO=23\nNrOfRXPDO=1\n"), "");
    EXPECT_EQ(refusal(cob + "[DeviceInfo]\nCompactPDO=23\nNrOfRXPDO=2\n"), "15: " + compact);
    EXPECT_EQ(refusal(cob + "[DeviceInfo]\nCompactPDO=23\nNrOfTXPDO=1\n"), "15: " + compact);
}

} // namespace
} // namespace tappet::canopen
