// Object dictionaries from EDS and DCF texts: their contents, and each refusal.
#include "apps/carpet_loom/nodes/drive.eds.hpp"
#include "drivers/canopen/eds.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tappet::canopen {
namespace {

const Object& at(const Dictionary& in, Address address) {
    const Object* const found = in.find(address);
    if (found == nullptr) throw std::runtime_error("not there");
    return *found;
}

TEST(Eds, contains_the_objects_of_a_drive) {
    const Dictionary& drive = dictionary<files::drive_eds>;
    EXPECT_EQ(drive.file, "apps/carpet_loom/nodes/drive.eds");
    EXPECT_EQ(drive.product, "Velocity drive");
    EXPECT_EQ(drive.identity, (Identity{0x00020192, 0x3E7, 0x402, 0x00010002}));
    const Object& velocity = at(drive, 0x606C);
    EXPECT_EQ(velocity.name, "Velocity actual value");
    EXPECT_EQ(velocity.type, DataType::integer32);
    EXPECT_EQ(velocity.access, Access::read_only);
    EXPECT_TRUE(velocity.mappable);
    EXPECT_EQ(at(drive, 0x6040).access, Access::read_write_write);
    const Object& mode = at(drive, 0x6060);
    EXPECT_EQ(mode.low.bits, 0x80u) << "-128 in eight bits";
    EXPECT_FALSE(within_limits(mode, 11, 1));
    EXPECT_TRUE(within_limits(mode, 0xFF, 1)) << "-1";
    EXPECT_EQ(at(drive, {0x1800, 1}).value.of(5), 0x40000185u);
    EXPECT_EQ(at(drive, 0x1008).text, "Velocity drive");
    EXPECT_EQ(drive.find({0x1018, 5}), nullptr);
    EXPECT_EQ(drive.find(0x2000), nullptr);
}

/// The objects that each device must have; 16 lines.
#define DEVICE_TYPE                                                                                          \
    "[DeviceInfo]\nVendorNumber=0x10\n\n"                                                                    \
    "[1000]\nParameterName=Device type\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\n"                    \
    "DefaultValue=0x00020192\nPDOMapping=0\n\n"                                                              \
    "[1018]\nParameterName=Identity\nObjectType=0x9\nSubNumber=2\n\n"
#define IDENTITY                                                                                             \
    "[1018sub0]\nDataType=5\nAccessType=const\nDefaultValue=1\n"                                             \
    "[1018sub1]\nDataType=7\nAccessType=ro\nDefaultValue=16\n"

constexpr SourceText odd{
    "odd.dcf", "; a comment\r\n" DEVICE_TYPE IDENTITY "[2000]\r\nParameterName=Gr\xF6\xDF"
               "e \x80\r\nDataType=0x0003\r\nAccessType=RW\r\nDefaultValue=-3\r\n"
               "ParameterValue=017\r\nPDOMapping=1\r\n"
               "[2001]\nObjectType=0x8\nDataType=0x0006\nAccessType=rw\nCompactSubObj=3\nDefaultValue=7\n"
               "[2001Value]\nNrOfEntries=1\n2=0x20\n"
               "[2002]\ndatatype=0x0008\naccesstype=rw\ndefaultvalue=-1.5e1\n"
               "[2003]\nDataType=0x0008\nAccessType=rw\nDefaultValue=0x3FC00000\n"
               "[2004]\nDataType=0x0001\nAccessType=rw\nDefaultValue=1\n"
               "[2005]\nDataType=0x0007\nAccessType=rw\nDefaultValue=0x40000180 + $NODEID\n"
               "[2006]\nObjectType=0x2\nDataType=0x000F\nAccessType=rw\n"
               "[DeviceComissioning]\nNodeID=9\nNodeName=left\n"};

TEST(Eds, reads_files_as_vendors_write_them) {
    const Dictionary& d = dictionary<odd>;
    EXPECT_EQ(d.node, 9);
    EXPECT_EQ(d.identity.vendor, 16u);
    const Object& size = at(d, 0x2000);
    EXPECT_EQ(size.value.bits, 15u) << "the DCF's own value goes before the default one, and is octal";
    EXPECT_TRUE(size.is_parameter);
    Sentence name;
    add_readable(name, size.name);
    EXPECT_EQ(name.view(), "Größe €");
    EXPECT_EQ(at(d, {0x2001, 0}).value.bits, 3u);
    EXPECT_EQ(at(d, {0x2001, 1}).value.bits, 7u);
    EXPECT_EQ(at(d, {0x2001, 2}).value.bits, 0x20u);
    EXPECT_TRUE(at(d, {0x2001, 2}).is_parameter);
    EXPECT_EQ(std::bit_cast<float>(static_cast<std::uint32_t>(at(d, 0x2002).value.bits)), -15.0f);
    EXPECT_EQ(std::bit_cast<float>(static_cast<std::uint32_t>(at(d, 0x2003).value.bits)), 1.5f);
    EXPECT_EQ(at(d, 0x2004).value.bits, 1u);
    EXPECT_EQ(at(d, 0x2005).value.of(9), 0x40000189u);
    EXPECT_EQ(bits_of(at(d, 0x2006).type), 0u);
}

TEST(Eds, reads_floats_as_the_compiler_does) {
    EXPECT_EQ(to_real("0.1"), 0.1);
    EXPECT_EQ(to_real("-123.456e-05"), -123.456e-5);
    EXPECT_EQ(to_real("1e22"), 1e22);
    for (const char* none : {"", ".", "1e", "1e+", "1e23", "0x", "1.2.3", "1234567890123456", "nan"})
        EXPECT_FALSE(to_real(none)) << none;
}

/// The sentence for a text that is read at run time.
template <std::size_t room = 64> std::string fault_of(const std::string& text) {
    return std::string{detail::EdsReader<room>{SourceText{"x.eds", text}}.fault.view()};
}
std::string with(const std::string& more) { return fault_of(DEVICE_TYPE IDENTITY + more); }
std::string variable(const std::string& entries) { return with("[2000]\n" + entries + "\n"); }

TEST(Eds, refuses_files_that_describe_no_device) {
    EXPECT_EQ(fault_of(""), "x.eds:1: it has no object; is it an EDS or DCF file of CiA 306?");
    EXPECT_EQ(fault_of("<xml>"),
              "x.eds:1: \"<xml>\" is neither a [section] nor an entry Key=Value; begin a comment with ;");
    EXPECT_EQ(fault_of("[1000\n"),
              "x.eds:1: \"[1000\" is neither a [section] nor an entry Key=Value; begin a comment with ;");
    EXPECT_EQ(fault_of("[2000]\nDataType=5\nAccessType=ro\n"),
              "x.eds:1: object 1000h (device type) is missing, which each device has; write it");
    EXPECT_EQ(
        fault_of("[DeviceInfo]\nCompactPDO=0x1\n"),
        "x.eds:2: CompactPDO stands for PDO objects that are not written; let its editor write them and "
        "set it to 0");
}

TEST(Eds, refuses_incomplete_objects) {
    EXPECT_EQ(variable("AccessType=ro"), "x.eds:25: [2000] has no DataType; write it");
    EXPECT_EQ(variable("DataType=5"), "x.eds:25: [2000] has no AccessType; write it");
    EXPECT_EQ(variable("DataType=0x1C\nAccessType=ro"),
              "x.eds:26: DataType 0x1C is not one of CiA 301; write the number of a basic type");
    EXPECT_EQ(variable("DataType=0x17\nAccessType=ro"),
              "x.eds:26: DataType 0x17 is not one of CiA 301; write the number of a basic type");
    EXPECT_EQ(variable("DataType=byte\nAccessType=ro"),
              "x.eds:26: DataType is \"byte\"; write a number up to 4294967295");
    EXPECT_EQ(variable("DataType=5\nAccessType=r"),
              "x.eds:27: AccessType is \"r\"; write ro, wo, rw, rwr, rww or const");
    EXPECT_EQ(variable("DataType=5\nAccessType=ro\nPDOMapping=2"),
              "x.eds:28: PDOMapping is \"2\"; write a number up to 1");
    EXPECT_EQ(variable("DataType=5\nDataType=6"),
              "x.eds:27: DataType is there twice in [2000], first in line 26; keep one of them");
    EXPECT_EQ(
        variable("ObjectType=0x5\nDataType=5\nAccessType=ro"),
        "x.eds:26: ObjectType is 0x5, which is not an object type of a device; write 0x2, 0x7, 0x8 or 0x9");
}

TEST(Eds, refuses_values_that_do_not_fit) {
    EXPECT_EQ(variable("DataType=5\nAccessType=ro\nDefaultValue=256"),
              "x.eds:28: DefaultValue 256 does not fit the 8 bits of 2000h:0; correct it or its DataType");
    EXPECT_EQ(
        variable("DataType=2\nAccessType=ro\nDefaultValue=200"),
        "x.eds:28: DefaultValue 200 does not fit the 8 bits of 2000h:0, which has a sign; correct it or "
        "its DataType");
    EXPECT_EQ(
        variable("DataType=2\nAccessType=ro\nDefaultValue=-129"),
        "x.eds:28: DefaultValue -129 does not fit the 8 bits of 2000h:0, which has a sign; correct it or "
        "its DataType");
    EXPECT_EQ(variable("DataType=2\nAccessType=ro\nDefaultValue=0xC8"), "") << "a bit pattern";
    EXPECT_EQ(variable("DataType=5\nAccessType=ro\nParameterValue=08"),
              "x.eds:28: ParameterValue \"08\" is not a number; write 0x1F, 31 or $NODEID+0x1F");
    EXPECT_EQ(variable("DataType=7\nAccessType=ro\nDefaultValue=$NODEID-1"),
              "x.eds:28: DefaultValue \"$NODEID-1\" is not a number; write 0x1F, 31 or $NODEID+0x1F");
    EXPECT_EQ(variable("DataType=8\nAccessType=ro\nDefaultValue=1,5"),
              "x.eds:28: DefaultValue \"1,5\" is not a number of up to 15 digits; write one");
    EXPECT_EQ(variable("DataType=5\nAccessType=ro\nLowLimit=9\nHighLimit=3"),
              "x.eds:25: LowLimit of 2000h:0 is above its HighLimit; exchange them");
    EXPECT_EQ(variable("DataType=2\nAccessType=ro\nLowLimit=-3\nHighLimit=3\nDefaultValue=-4"),
              "x.eds:25: the value -4 of 2000h:0 is outside of its own limits; correct it, LowLimit or "
              "HighLimit");
}

TEST(Eds, refuses_contradictory_sections) {
    EXPECT_EQ(with("[1000]\nDataType=7\nAccessType=ro\n"),
              "x.eds:25: object 1000h:0 is there twice, first in line 4; keep one of them");
    EXPECT_EQ(with("[1A00sub1]\nDataType=7\nAccessType=ro\n"),
              "x.eds:25: object 1A00h:1 is a part of 1A00h, which has no section; write it");
    EXPECT_EQ(
        with("[1000sub1]\nDataType=7\nAccessType=ro\n"),
        "x.eds:25: object 1000h:1 is a part of 1000h, which is a variable; make it ObjectType 0x8 or 0x9");
    EXPECT_EQ(with("[1016]\nObjectType=8\nSubNumber=3\n[1016sub0]\nDataType=5\nAccessType=ro\n"),
              "x.eds:27: SubNumber of 1016h is 3 and 1 sub-index is there; correct it, or what is missing");
    EXPECT_EQ(
        with("[1016]\nObjectType=8\n"),
        "x.eds:25: SubNumber of 1016h is not written and 0 sub-indices are there; correct it, or what is "
        "missing");
    EXPECT_EQ(
        with("[OptionalObjects]\nSupportedObjects=1\n1=0x1017\n"),
        "x.eds:27: the list names object 0x1017, which has no section; write it or take it off the list");
    EXPECT_EQ(with("[2001]\nObjectType=8\nDataType=5\nAccessType=rw\nCompactSubObj=2\n[2001Value]\n3=1\n"),
              "x.eds:31: it is a value of 2001h:3, which is not there; correct CompactSubObj");
    EXPECT_EQ(
        fault_of(DEVICE_TYPE "[1018sub0]\nDataType=5\nAccessType=const\nDefaultValue=1\n"
                             "[1018sub1]\nDataType=7\nAccessType=ro\nDefaultValue=17\n"),
        "x.eds:21: 1018h:1 is 00000011h, but VendorNumber in line 1 and below is 00000010h; correct one of "
        "them");
}

} // namespace
} // namespace tappet::canopen
