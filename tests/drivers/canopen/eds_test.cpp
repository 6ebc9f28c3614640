// Object dictionaries from EDS and DCF texts: their contents, and the refusals of files without a device.
#include "apps/carpet_loom/nodes/drive.eds.hpp"
#include "drivers/canopen/eds.hpp"
#include "drivers/canopen/eds_reader.hpp"
#include "kernel/base/random.hpp"
#include "tests/drivers/canopen/odd.dcf.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
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

TEST(Eds, reads_files_as_vendors_write_them) {
    const Dictionary& d = dictionary<files::odd_dcf>;
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

TEST(Eds, reads_reals_as_the_compiler_does) {
    EXPECT_EQ(to_real<double>("0.1"), 0.1);
    EXPECT_EQ(to_real<double>("-123.456e-05"), -123.456e-5);
    EXPECT_EQ(to_real<double>("1e22"), 1e22);
    EXPECT_EQ(to_real<double>("0.10000000000000001"), 0.10000000000000001);
    EXPECT_EQ(to_real<double>("4.9406564584124654e-324"), 4.9406564584124654e-324);
    EXPECT_EQ(to_real<double>("2.4703282292062327e-324"), 0.0) << "half of the least one";
    EXPECT_EQ(to_real<double>("1.7976931348623157e+308"), std::numeric_limits<double>::max());
    EXPECT_EQ(to_real<double>("1e309"), std::numeric_limits<double>::infinity());
    EXPECT_EQ(to_real<float>("3.4028235E+38"), std::numeric_limits<float>::max());
    EXPECT_EQ(to_real<float>("-3.4028236E+38"), -std::numeric_limits<double>::infinity());
    for (const char* none : {"", ".", "1e", "1e+", "0x", "1.2.3", "nan", "1,5", "--1"})
        EXPECT_FALSE(to_real<double>(none)) << none;
    EXPECT_FALSE(to_real<double>(std::string(41, '1')));
}

TEST(Eds, reads_any_real_as_the_library_does) {
    Random random{20261129};
    for (int round = 0; round < 3'000; ++round) {
        const auto real = std::bit_cast<double>(random.next());
        const auto small = std::bit_cast<float>(static_cast<std::uint32_t>(random.next()));
        if (!std::isfinite(real) || !std::isfinite(small)) continue;
        std::array<char, 64> text{};
        const int digits = static_cast<int>(random.below(25));
        std::snprintf(text.data(), text.size(), "%.*e", digits, real);
        ASSERT_EQ(to_real<double>(text.data()), std::strtod(text.data(), nullptr)) << text.data();
        std::snprintf(text.data(), text.size(), "%.*e", digits, static_cast<double>(small));
        ASSERT_EQ(to_real<float>(text.data()), std::strtof(text.data(), nullptr)) << text.data();
        // Halfway between two neighbours.
        const double next = std::nextafter(small, std::numeric_limits<float>::max());
        std::snprintf(text.data(), text.size(), "%.39e", (static_cast<double>(small) + next) / 2);
        ASSERT_EQ(to_real<float>(text.data()), std::strtof(text.data(), nullptr)) << text.data();
    }
}

std::string refusal(const std::string& text) {
    return std::string{detail::EdsReader{SourceText{"x.eds", text}}.fault.view()};
}

TEST(Eds, refuses_files_that_describe_no_device) {
    const std::string refused = "; the file is not read: correct this line, or take an undamaged file";
    EXPECT_EQ(refusal(""), "x.eds:1: it has no object; is it an EDS or DCF file of CiA 306?" + refused);
    EXPECT_EQ(refusal("<xml>"), "x.eds:1: \"<xml>\" is neither a [section] nor an entry Key=Value" + refused);
    EXPECT_EQ(refusal("\xEF\xBB\xBF[1000]\nDataType=7\nAccessType=ro\n"), "") << "a byte-order mark";
}

} // namespace
} // namespace tappet::canopen
