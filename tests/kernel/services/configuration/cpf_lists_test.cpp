// Lists in properties files, as Orocos and others write them: each form is read, and written back as it was.
#include "kernel/services/configuration/cpf.hpp"
#include "tests/kernel/component/every_property.hpp"

#include <gmock/gmock.h>

#include <array>
#include <string>

namespace tappet {
namespace {

using every::Arm;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

struct CpfLists : testing::Test {
    Arm arm;
    PropertyTransaction transaction;
    CpfListForms forms;

    std::string read(const std::string& members) {
        transaction.begin("arm", component_type<Arm>, &arm);
        const std::string text = "<properties>\n" + members + "</properties>\n";
        std::string said{read_cpf(text, "arm.cpf", transaction, nullptr, &forms).view()};
        if (said.empty()) transaction.commit();
        return said;
    }
    std::string write() {
        transaction.begin("arm", component_type<Arm>, &arm);
        transaction.change_all();
        transaction.capture();
        std::array<char, max_cpf_bytes> text{};
        Sentence fault;
        const std::size_t length = write_cpf(transaction, text, fault, {forms.begin(), forms.size()});
        EXPECT_TRUE(fault.empty()) << fault.view();
        return {text.data(), length};
    }
};

std::string value(const std::string& name, const std::string& text) {
    return "<simple " + (name.empty() ? "" : "name=\"" + name + "\" ") + "type=\"double\"><value>" + text +
           "</value></simple>\n";
}
std::string size(const std::string& text) {
    return "<simple name=\"Size\" type=\"long\"><value>" + text + "</value></simple>\n";
}

struct Form {
    const char* what;
    std::string opens; ///< the list's tag without its end
    std::string elements;
    std::string closes;
};

const Form forms_of_lists[]{
    {"a sequence of Tappet", "<sequence name=\"axis\" type=\"double\"",
     value("", "0.5") + value("", "0.25") + value("", "-1"), "</sequence>\n"},
    {"a sequence of Orocos", "<sequence name=\"axis\" type=\"array\"",
     value("Element0", "0.5") + value("Element1", "0.25") + value("Element2", "-1"), "</sequence>\n"},
    {"a struct with its size", "<struct name=\"axis\" type=\"std::vector&lt;double&gt;\"",
     size("3") + value("0", "0.5") + value("1", "0.25") + value("2", "-1"), "</struct>\n"},
    {"a struct without names", "<struct name=\"axis\" type=\"float64[]\"",
     value("", "0.5") + value("", "0.25") + value("", "-1"), "</struct>\n"},
    {"a struct with its size without names", "<struct name=\"axis\" type=\"array\"",
     size("3") + value("", "0.5") + value("", "0.25") + value("", "-1"), "</struct>\n"},
    {"a struct with element names", "<struct name=\"axis\" type=\"array\"",
     value("Element0", "0.5") + value("Element1", "0.25") + value("Element2", "-1"), "</struct>\n"},
    {"a column that counts from 1", "<struct name=\"axis\" type=\"ColumnVector\"",
     value("1", "0.5") + value("2", "0.25") + value("3", "-1"), "</struct>\n"},
    {"a sequence that states its size", "<sequence name=\"axis\" type=\"double\"",
     size("3") + value("0", "0.5") + value("1", "0.25") + value("2", "-1"), "</sequence>\n"},
};

std::string without_indents(const std::string& text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] != ' ' || (i != 0 && text[i - 1] != ' ' && text[i - 1] != '\n')) result += text[i];
    return result;
}

TEST_F(CpfLists, are_read_and_written_back_in_the_form_that_was_read) {
    for (const Form& form : forms_of_lists) {
        ASSERT_EQ(read(form.opens + ">\n" + form.elements + form.closes), "") << form.what;
        EXPECT_EQ(arm.axis.get(), (Eigen::Vector3d{0.5, 0.25, -1})) << form.what;
        const std::string written = without_indents(write());
        EXPECT_THAT(written, HasSubstr(form.opens + "><description>of the tool</description>\n" +
                                       form.elements + form.closes))
            << form.what;
        arm.axis.set(Eigen::Vector3d::Zero());
        transaction.begin("arm", component_type<Arm>, &arm);
        ASSERT_EQ(read_cpf(write(), "again.cpf", transaction).view(), "") << form.what;
    }
}

TEST_F(CpfLists, grow_and_shrink_in_their_form) {
    ASSERT_EQ(read("<struct name=\"offsets\" type=\"array\">" + size("0") + "</struct>"), "");
    ASSERT_EQ(arm.offsets.get().size(), 0u);
    Sequence<double, 4> two;
    ASSERT_TRUE(two.push(1.5) && two.push(-2));
    arm.offsets.set(two);
    EXPECT_THAT(without_indents(write()),
                HasSubstr(size("2") + value("0", "1.5") + value("1", "-2") + "</struct>\n"));
}

TEST_F(CpfLists, may_hold_names_on_some_elements_and_whole_numbers) {
    ASSERT_EQ(read("<struct name=\"axis\" type=\"array\">" + value("0", "1") + value("", "0") +
                   "<simple name=\"2\" type=\"long\"><value>-1</value></simple></struct>"
                   "<sequence name=\"offsets\" type=\"double\">" +
                   value("", "2") + "</sequence>"),
              "");
    EXPECT_EQ(arm.axis.get(), (Eigen::Vector3d{1, 0, -1}));
    EXPECT_EQ(arm.offsets.get().size(), 1u) << "structs and sequences in one file";
    const std::string written = without_indents(write());
    EXPECT_THAT(written, HasSubstr(value("0", "1") + value("1", "0") + value("2", "-1") + "</struct>"));
    EXPECT_THAT(written, HasSubstr(value("", "2") + "</sequence>"));
}

TEST_F(CpfLists, of_texts_are_lists_too) {
    ASSERT_EQ(read("<struct name=\"marks\" type=\"std::vector&lt;std::string&gt;\">"
                   "<simple name=\"Size\" type=\"ulong\"><value>1</value></simple>"
                   "<simple name=\"0\" type=\"string\"><value>a b</value></simple></struct>"),
              "");
    ASSERT_EQ(arm.marks.get().size(), 1u);
    EXPECT_EQ(arm.marks.get()[0].view(), "a b");
}

TEST_F(CpfLists, may_have_types_that_are_not_escaped) {
    ASSERT_EQ(read("<struct name=\"axis\" type=\"std::vector<double>\">" + value("0", "1") + value("1", "0") +
                   value("2", "0") + "</struct>"),
              "");
    EXPECT_THAT(write(), HasSubstr("<struct name=\"axis\" type=\"std::vector&lt;double&gt;\">")) << "XML";
}

TEST_F(CpfLists, matrix_is_a_list_of_its_rows) {
    const std::string turn = "<struct name=\"turn\" type=\"Matrix\">\n";
    const std::string rows = "<struct name=\"1\" type=\"RowVector\">\n" + value("1", "5") + value("2", "6") +
                             "</struct>\n<struct name=\"2\" type=\"RowVector\">\n" + value("1", "7") +
                             value("2", "8") + "</struct>\n</struct>\n";
    ASSERT_EQ(read(turn + rows), "");
    EXPECT_EQ(arm.turn.get(), (Eigen::Matrix2d{{5, 6}, {7, 8}}));
    EXPECT_THAT(without_indents(write()), HasSubstr(rows));
    const std::string sizes = size("2") + "<sequence type=\"double\">\n" + size("2") + value("", "1") +
                              value("", "2") + "</sequence>\n<sequence type=\"double\">\n" + size("2") +
                              value("", "3") + value("", "4") + "</sequence>\n</struct>\n";
    ASSERT_EQ(read(turn + sizes), "");
    EXPECT_EQ(arm.turn.get(), (Eigen::Matrix2d{{1, 2}, {3, 4}}));
    EXPECT_THAT(without_indents(write()), HasSubstr(sizes));
    ASSERT_EQ(
        read(turn + value("0", "1") + value("1", "2") + value("2", "3") + value("3", "4") + "</struct>"), "");
    EXPECT_EQ(arm.turn.get(), (Eigen::Matrix2d{{1, 3}, {2, 4}})) << "column by column";
}

TEST_F(CpfLists, that_are_refused_keep_value_and_form) {
    ASSERT_EQ(read("<struct name=\"axis\" type=\"array\">" + value("", "1") + value("", "0") +
                   value("", "0") + "</struct>"),
              "");
    ASSERT_NE(read("<sequence name=\"axis\" type=\"x\">" + value("", "1") + "</sequence>"), "");
    EXPECT_THAT(write(), HasSubstr("<struct name=\"axis\" type=\"array\">"));
    EXPECT_EQ(arm.axis.get(), (Eigen::Vector3d{1, 0, 0}));
}

TEST_F(CpfLists, are_refused_when_their_form_cannot_be_kept) {
    while (!forms.full()) ASSERT_TRUE(forms.push({.component = "other", .facet = forms.size()}));
    const std::string three = value("", "1") + value("", "0") + value("", "0");
    EXPECT_THAT(
        read("<struct name=\"axis\" type=\"array\">" + three + "</struct>"),
        HasSubstr("gives \"axis\" in a form of its own, as 128 other lists of the machine are; write a "
                  "<sequence> of the type double without Size and names"));
    EXPECT_EQ(arm.axis.get(), (Eigen::Vector3d{0, 0, 1}));
    EXPECT_EQ(read("<sequence name=\"axis\" type=\"double\">" + three + "</sequence>"), "");
    forms.used = 0;
    ASSERT_EQ(read("<struct name=\"axis\" type=\"array\">" + three + "</struct>"), "");
    ASSERT_EQ(read("<sequence name=\"axis\" type=\"double\">" + three + "</sequence>"), "");
    EXPECT_THAT(write(), HasSubstr("<sequence name=\"axis\" type=\"double\">")) << "the last form";
}

struct WrongList {
    std::string list;
    const char* said;
};

TEST_F(CpfLists, that_do_not_fit_are_refused_by_name_and_count) {
    const std::string axis = "<struct name=\"axis\" type=\"array\">";
    const std::string turn = "<struct name=\"turn\" type=\"Matrix\">";
    const std::string row = "<struct type=\"RowVector\">" + value("", "1") + value("", "2") + "</struct>";
    const std::string short_row = "<struct type=\"RowVector\">" + value("", "1") + "</struct>";
    const std::string three = value("0", "1") + value("1", "0") + value("2", "0");
    const WrongList wrongs[]{
        {axis + three + value("3", "0") + "</struct>",
         "gives \"axis\" 4 elements, but it has 3; write so many <simple> elements"},
        {"<struct name=\"offsets\" type=\"array\">" + three + value("3", "0") + value("4", "0") + "</struct>",
         "gives \"offsets\" 5 elements, but it has at most 4"},
        {axis + size("6") + three + "</struct>",
         "gives \"axis\" 3 elements, but its Size is 6; correct the Size, or what is missing"},
        {axis + size("3") + size("3") + three + "</struct>", "a second Size"},
        {axis + "<simple name=\"Size\" type=\"double\"><value>3</value></simple>" + three + "</struct>",
         "gives property \"Size\" as double"},
        {axis + "<simple name=\"Size\" type=\"long\"><value>-1</value></simple>" + three + "</struct>",
         "property \"Size\": "},
        {axis + value("0", "1") + value("2", "0") + value("1", "0") + "</struct>",
         "names element 1 of \"axis\" \"2\", but names count the elements in their order; write \"1\", or no "
         "name"},
        {axis + value("2", "1") + value("3", "0") + value("4", "0") + "</struct>",
         "names element 0 of \"axis\" \"2\""},
        {axis + value("a0", "1") + value("b1", "0") + value("a2", "0") + "</struct>",
         "names element 1 of \"axis\" \"b1\", but names count the elements in their order; write \"a1\""},
        {axis + value("x", "1") + value("y", "0") + value("z", "0") + "</struct>",
         "names element 0 of \"axis\" \"x\""},
        {axis + row + row + row + "</struct>", "something in list \"axis\" that is not a <simple>"},
        {turn + row + "</struct>", "gives \"turn\" 1 rows, but it has 2; write so many of them"},
        {turn + row + short_row + "</struct>", "gives row 1 of \"turn\" 1 elements, but it has 2"},
        {turn + row + value("", "1") + "</struct>", "gives row 1 of \"turn\" 0 elements"},
        {turn + row + "<struct type=\"RowVector\">" + size("3") + value("", "1") + value("", "2") +
             "</struct></struct>",
         "gives \"turn\" 2 elements, but its Size is 3"},
        {"<struct name=\"axsi\" type=\"array\">" + three + "</struct>", "did you mean \"axis\"?"},
        {"<struct name=\"axis\" type=\"" + std::string(96, 'a') + "\">" + three + "</struct>",
         "more than 95 characters"},
    };
    for (const WrongList& wrong : wrongs) {
        EXPECT_THAT(read(wrong.list), AllOf(StartsWith("arm.cpf:"), HasSubstr(wrong.said))) << wrong.list;
        EXPECT_EQ(arm.axis.get(), (Eigen::Vector3d{0, 0, 1}));
    }
}

} // namespace
} // namespace tappet
