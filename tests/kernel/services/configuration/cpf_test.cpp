// Properties as CPF text (thesis 4.7.1): written values are read back unchanged, Orocos' own spelling is
// understood, and every fault is refused.
#include "kernel/services/configuration/cpf.hpp"

#include "kernel/base/random.hpp"
#include "tests/kernel/component/every_property.hpp"

#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cmath>
#include <string>

namespace tappet {
namespace {

using every::Arm;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

struct Cpf : testing::Test {
    Arm arm;
    PropertyTransaction transaction;
    std::string read(std::string_view text) {
        transaction.begin("arm", component_type<Arm>, &arm);
        return std::string{read_cpf(text, "arm.cpf", transaction).view()};
    }
    std::string read_members(const std::string& members) {
        return read("<properties>\n" + members + "\n</properties>\n");
    }
    void take(const std::string& members) {
        ASSERT_EQ(read_members(members), "");
        transaction.commit();
        ASSERT_EQ(transaction.state(), PropertyTransaction::State::done);
    }
    static std::size_t write(Arm& of, std::span<char> text, Sentence& fault) {
        PropertyTransaction all;
        all.begin("arm", component_type<Arm>, &of);
        all.change_all();
        all.capture();
        return write_cpf(all, text, fault);
    }
    static std::string write(Arm& of) {
        std::array<char, max_cpf_bytes> text{};
        Sentence fault;
        const std::size_t length = write(of, text, fault);
        EXPECT_TRUE(fault.empty()) << fault.view();
        return {text.data(), length};
    }
};

TEST_F(Cpf, file_of_orocos_is_read) {
    ASSERT_EQ(read(R"(<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE properties SYSTEM "cpf.dtd">
<properties>
  <simple name="scale" type="double"><description>of it</description><value>0.25</value></simple>
  <simple name="steps" type="long"><value>-12</value></simple>
  <simple name="word" type="ushort"><value>65535</value></simple>
  <simple name="huge" type="llong"><value>-9223372036854775808</value></simple>
  <simple name="serial" type="ullong"><value>18446744073709551615</value></simple>
  <simple name="reversed" type="boolean"><value>0</value></simple>
  <simple name="label" type="string"><value>warp &lt;1&gt; &amp; 2</value></simple>
  <struct name="gains" type="PropertyBag">
     <description>Of both axes</description>
     <struct name="roll" type="PropertyBag">
       <simple name="p" type="double"><value>4.25</value></simple>
     </struct>
     <simple name="all" type="long"><value>3</value></simple>
  </struct>
  <sequence name="offsets" type="array">
    <simple name="Element0" type="double"><value>0.5</value></simple>
    <simple name="Element1" type="double"><value>-0.5</value></simple>
  </sequence>
</properties>)"),
              "");
    transaction.commit();
    EXPECT_EQ(arm.scale.get(), 0.25f);
    EXPECT_EQ(arm.steps.get(), -12);
    EXPECT_EQ(arm.word.get(), 65535);
    EXPECT_EQ(arm.huge.get(), std::numeric_limits<std::int64_t>::min());
    EXPECT_EQ(arm.serial.get(), std::numeric_limits<std::uint64_t>::max());
    EXPECT_FALSE(arm.reversed.get());
    EXPECT_EQ(arm.label.get().view(), "warp <1> & 2");
    EXPECT_EQ(arm.roll.p.get(), 4.25);
    EXPECT_EQ(arm.pitch.p.get(), 1.0) << "what the file leaves out keeps its value";
    EXPECT_EQ(arm.gain.get(), 3.0) << "a whole number is a number";
    ASSERT_EQ(arm.offsets.get().size(), 2u);
    EXPECT_EQ(arm.offsets.get()[1], -0.5);
}

TEST_F(Cpf, times_and_enumerations_are_stored_as_strings) {
    take(R"(<simple name="filter" type="string"><value>5ms</value></simple>
            <simple name="side" type="string"><value>both</value></simple>
            <simple name="code" type="short"><value>-3</value></simple>)");
    EXPECT_EQ(arm.filter.get(), 5ms);
    EXPECT_EQ(arm.side.get(), every::Side::both);
    EXPECT_EQ(static_cast<int>(arm.code.get()), -3);
}

TEST_F(Cpf, vector_and_matrix_are_sequences_of_their_exact_size) {
    take(R"(<sequence name="axis" type="double"><simple type="double"><value>1</value></simple>
              <simple type="double"><value>0</value></simple><simple type="double"><value>-1</value></simple>
            </sequence>
            <sequence name="marks" type="string"><description>two</description>
              <simple type="string"><value>a</value></simple><simple type="string"><value>b c</value></simple>
            </sequence>)");
    EXPECT_EQ(arm.axis.get(), (Eigen::Vector3d{1, 0, -1}));
    EXPECT_EQ(arm.marks.get()[1].view(), "b c");
}

TEST_F(Cpf, text_keeps_its_spaces_and_numbers_lose_theirs) {
    take("<simple name=\"label\" type=\"string\"><value> a <!-- not this -->b<![CDATA[<&>]]></value></simple>"
         "<simple name=\"steps\" type=\"long\"><value>\n  7  </value></simple>");
    EXPECT_EQ(arm.label.get().view(), " a b<&>");
    EXPECT_EQ(arm.steps.get(), 7);
    take("<simple name=\"label\" type=\"string\"><value>   </value></simple>");
    EXPECT_EQ(arm.label.get().view(), "   ");
    take("<simple name=\"label\" type=\"string\"><value/></simple>");
    EXPECT_EQ(arm.label.get().view(), "");
}

TEST_F(Cpf, values_survive_writing_and_reading) {
    Random random{20261121};
    for (int round = 0; round < 200; ++round) {
        Arm from;
        const auto real = [&] {
            // Any finite double.
            double value = std::bit_cast<double>(random.next());
            return std::isnan(value) ? 1.0 : value;
        };
        const auto within = [&](double low, double high) { return low + (high - low) * random.unit(); };
        from.gain.set(real());
        from.scale.set(static_cast<float>(within(-1e30, 1e30)));
        from.roll.p.set(within(0, 10));
        from.pitch.i.set(within(0, 10));
        from.small.set(static_cast<std::int8_t>(random.next()));
        from.word.set(static_cast<std::uint16_t>(random.next()));
        from.steps.set(static_cast<std::int32_t>(random.next()));
        from.huge.set(static_cast<std::int64_t>(random.next()));
        from.serial.set(random.next());
        from.reversed.set((random.next() & 1) != 0);
        from.filter.set(Duration{random.between(0, 500'000'000)});
        from.side.set(static_cast<every::Side>(random.below(3)));
        from.code.set(static_cast<every::Code>(random.next()));
        Text<12> label;
        label.length = static_cast<std::uint32_t>(random.below(13));
        for (std::size_t i = 0; i < label.length; ++i)
            label.characters[i] = static_cast<char>(random.between(1, 127));
        from.label.set(label);
        Sequence<double, 4> offsets;
        for (std::uint64_t i = random.below(5); i != 0; --i) ASSERT_TRUE(offsets.push(within(-5, 5)));
        from.offsets.set(offsets);
        Eigen::Matrix2d turn;
        for (double* each = turn.data(); each != turn.data() + 4; ++each) *each = real();
        from.turn.set(turn);
        Eigen::Vector3d axis;
        for (double* each = axis.data(); each != axis.data() + 3; ++each) *each = within(-1, 1);
        from.axis.set(axis);

        const std::string text = write(from);
        std::construct_at(&arm); // over the one before, which has nothing to take apart
        ASSERT_EQ(read(text), "") << text;
        transaction.commit();
        ASSERT_TRUE(every::same_properties(from, arm)) << text;
        ASSERT_EQ(write(arm), text);
    }
}

TEST_F(Cpf, output_that_exceeds_its_buffer_is_not_written_in_part) {
    std::array<char, 1000> small{};
    Sentence fault;
    EXPECT_EQ(write(arm, small, fault), 0u);
    EXPECT_THAT(std::string{fault.view()}, HasSubstr("more than 1000 bytes"));
}

TEST_F(Cpf, text_that_cannot_be_stored_is_not_written) {
    Text<12> zero{"ab"};
    zero.characters[1] = '\0';
    arm.label.set(zero);
    std::array<char, max_cpf_bytes> text{};
    Sentence fault;
    EXPECT_EQ(write(arm, text, fault), 0u);
    EXPECT_THAT(std::string{fault.view()}, HasSubstr("\"label\" holds a zero character"));
}

struct Wrong {
    const char* what;
    std::string members; ///< content of <properties>, whose tag is line 1
    const char* said;
    int line = 2;
};

class CpfRefusal : public Cpf, public testing::WithParamInterface<Wrong> {};

TEST_P(CpfRefusal, names_the_file_the_line_the_component_and_the_cure) {
    const Wrong& wrong = GetParam();
    const std::string said = read_members(wrong.members);
    EXPECT_THAT(said, AllOf(StartsWith("arm.cpf:" + std::to_string(wrong.line) + ": component \"arm\": "),
                            HasSubstr(wrong.said)))
        << wrong.what;
}

std::string simple(const std::string& name, const std::string& type, const std::string& value) {
    return "<simple name=\"" + name + "\" type=\"" + type + "\"><value>" + value + "</value></simple>";
}
const Wrong wrongs[]{
    {"unknown", simple("scael", "double", "1"), "did you mean \"scale\"?"},
    {"unknown in a bag",
     "<struct name=\"gains\" type=\"\">\n<struct name=\"roll\" type=\"\">\n<simple name=\"k\" "
     "type=\"double\"><value>1</value></simple></struct></struct>",
     "property \"gains.roll.k\", which the component does not have", 4},
    {"unknown bag", "\n<struct name=\"gain\" type=\"PropertyBag\"/>", "did you mean \"gains\"?", 3},
    {"a port", simple("angle", "double", "1"), "which the component does not have"},
    {"dotted", simple("gains.all", "double", "1"), "a <struct> for each bag"},
    {"type", simple("scale", "string", "1"), "write type=\"float\""},
    {"no type", R"(<simple name="scale"><value>1</value></simple>)", "write type=\"float\""},
    {"real as whole", simple("steps", "double", "1"), "write type=\"long\""},
    {"no number", simple("scale", "double", "fast"), "property \"scale\": "},
    {"half a number", simple("scale", "double", "1.5x"), "property \"scale\": "},
    {"two numbers", simple("scale", "double", "1 2"), "property \"scale\": "},
    {"empty number", R"(<simple name="scale" type="double"><value/></simple>)", "property \"scale\": "},
    {"not a number", simple("gains", "double", "nan"), "write a <struct>"},
    {"nan", simple("scale", "double", "nan"), "scale"},
    {"too wide", simple("small", "short", "128"), "property \"small\": "},
    {"negative", simple("word", "ushort", "-1"), "property \"word\": "},
    {"truth", simple("reversed", "boolean", "2"), "property \"reversed\": "},
    {"time without unit", simple("filter", "string", "5"), "property \"filter\": "},
    {"enumeration", simple("side", "string", "lefft"), "property \"side\": "},
    {"too long", simple("label", "string", "thirteen char"), "more than its 12 characters"},
    {"over range",
     "<struct name=\"gains\" type=\"\"><struct name=\"roll\" type=\"\">\n\n<simple name=\"p\" "
     "type=\"double\"><value>10.5</value></simple></struct></struct>",
     "over its greatest value 10", 4},
    {"time over range", simple("filter", "string", "501ms"), "over its greatest value 0.5 s"},
    {"element over range",
     R"(<sequence name="offsets" type="double"><simple type="double"><value>6</value></simple></sequence>)",
     "element 0 is over its greatest value 5"},
    {"too few",
     R"(<sequence name="axis" type="double"><simple type="double"><value>1</value></simple></sequence>)",
     "1 elements, but it has 3"},
    {"a list as simple", simple("axis", "double", "1"), "write a <sequence>"},
    {"a value as sequence", R"(<sequence name="scale" type="double"/>)", "write a <simple>"},
    {"a value as struct", R"(<struct name="scale" type=""/>)", "scale"},
    {"twice", simple("steps", "long", "1") + "\n" + simple("steps", "long", "1"),
     "gives \"steps\" again, as line 2 did", 3},
    {"a bag twice", "<struct name=\"gains\" type=\"\"/>\n<struct name=\"gains\" type=\"\"/>",
     "again, as line 2", 3},
    {"no name", R"(<simple type="long"><value>1</value></simple>)", "without a name"},
    {"attribute", R"(<simple name="steps" type="long" unit="1"><value>1</value></simple>)", "\"unit\""},
    {"attribute twice", R"(<simple name="steps" name="word" type="long"><value>1</value></simple>)",
     "\"name\""},
    {"no value", R"(<simple name="steps" type="long"></simple>)", "no <value>"},
    {"two values", R"(<simple name="steps" type="long"><value>1</value><value>2</value></simple>)",
     "one <value>"},
    {"element in a value", R"(<simple name="steps" type="long"><value>1<b/></value></simple>)",
     "not plain text"},
    {"foreign element", "<tuple/>", "has <tuple>"},
    {"loose text", "\nsteps = 1", "text where a property belongs", 3},
    {"text in a simple", R"(<simple name="steps" type="long">1<value>1</value></simple>)", "remove it"},
    {"in a sequence", R"(<sequence name="offsets" type="double"><struct name="x" type=""/></sequence>)",
     "that is not a <simple>"},
    {"entity", simple("label", "string", "&me;"), "write &amp;"},
    {"loose ampersand", simple("label", "string", "a & b"), "write &amp;"},
    {"number of no character", simple("label", "string", "&#0;"), "write &amp;"},
};

INSTANTIATE_TEST_SUITE_P(Cpf, CpfRefusal, testing::ValuesIn(wrongs), [](const auto& each) {
    std::string name = each.param.what;
    for (char& character : name)
        if (character == ' ') character = '_';
    return name;
});

TEST_F(Cpf, malformed_file_is_an_error_with_its_line) {
    EXPECT_THAT(read("<properties>\n\n<simple name=\"steps\"\n</properties>"),
                AllOf(StartsWith("arm.cpf:"), HasSubstr("is malformed XML: ")));
    EXPECT_THAT(read("<properties>\n<simple>\n</properties>"), StartsWith("arm.cpf:3: "));
    EXPECT_THAT(read(""), HasSubstr("has no <properties> element"));
    EXPECT_THAT(read("  \n"), HasSubstr("has no <properties> element"));
    EXPECT_THAT(read("<properties/>\n<properties/>"),
                AllOf(StartsWith("arm.cpf:2: "), HasSubstr("is outside of")));
    EXPECT_THAT(read("stray <properties/>"), HasSubstr("is outside of <properties>"));
    EXPECT_THAT(read("<Properties/>"), HasSubstr("is outside of <properties>"));
    EXPECT_THAT(read(std::string_view{"<properties/>\n\0 more", 20}),
                AllOf(StartsWith("arm.cpf:2: "), HasSubstr("zero byte")));
    EXPECT_THAT(read("<properties version=\"2\"/>"), HasSubstr("attribute"));
    EXPECT_EQ(read("<properties/>"), "");
}

TEST_F(Cpf, malformed_file_is_refused_wherever_it_is_cut) {
    const std::string whole = write(arm);
    const std::size_t end = whole.rfind('>');
    for (std::size_t length = 0; length < end; ++length)
        ASSERT_NE(read(whole.substr(0, length)), "") << "cut at " << length;
    EXPECT_EQ(read(whole.substr(0, end + 1)), "");
}

TEST_F(Cpf, file_above_the_size_limit_is_refused_unread) {
    EXPECT_THAT(read(std::string(max_cpf_bytes + 1, ' ')), HasSubstr("more than 65536 bytes"));
}

TEST_F(Cpf, nesting_without_end_is_refused_safely) {
    std::string deep = "<properties>";
    for (int i = 0; i < 4000; ++i) deep += "<struct name=\"gains\" type=\"\">";
    EXPECT_NE(read(deep), "");
    std::string closed = "<properties><description>";
    for (int i = 0; i < 2000; ++i) closed += "<a>";
    for (int i = 0; i < 2000; ++i) closed += "</a>";
    EXPECT_NE(read(closed + "</description></properties>"), "");
}

} // namespace
} // namespace tappet
