// tappet check: each awkward DBC file with its table, and the verdict on it.
#include "tests/toolchain/folder.hpp"
#include "toolchain/tools/check/check.hpp"

#include <gtest/gtest.h>

namespace tappet::checking {
namespace {

/// "line weight affected: meaning" for each finding.
std::string findings(std::string_view text) {
    std::string all;
    for (const Finding& each : check_dbc(text)) {
        all += std::to_string(each.line);
        all += each.weight == Weight::note    ? " note"
               : each.weight == Weight::fault ? " fault"
                                              : " unreadable";
        for (const std::string& node : each.affects) all += " " + node;
        all += ": " + each.meaning;
        if (each.more != 0) all += " +" + std::to_string(each.more);
        all += "\n";
    }
    return all;
}

const std::string head = "BU_: A B\n";
std::string with_signal(const std::string& signal) { return head + "BO_ 1 M: 8 A\n SG_ " + signal; }
const std::string plain = with_signal("s : 0|8@1+ (1,0) [0|0] \"\" B\n");

struct Case {
    std::string text, findings;
};

TEST(CheckDbc, is_content_with_good_files) {
    for (const std::string& text :
         {head, plain, plain + "// a comment: BO_ 1 M: 8 A\n",
          with_signal("s : 0|64@1+ (1,0) [0|0] \"\" B // not of C\nVAL_ 1 s 18446744073709551615 \"SNA\";\n"),
          head + "BO_ 1073741824 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n SG_ x : 0|9@1+ (1,0) [0|0] "
                 "\"\" B\n",
          head + "BO_ 1 1st: 8 A\n SG_ 2nd : 0|8@1+ (1,0) [0|0] \"\" B\nVAL_ 1 2nd 1 \"on\";\n",
          plain + "CM_ \"of two lines:\nBO_ 1 M: 8 A; and no more\";\n",
          plain + "BA_DEF_ BO_ \"GenMsgSendType\" ENUM \"cyclic\",\"spontaneous\";\nBA_ \"GenMsgSendType\" "
                  "BO_ 1 1;"})
        EXPECT_EQ(findings(text), "") << text;
}

TEST(CheckDbc, notes_what_nobody_suffers_from) {
    const std::vector<Case> cases{
        {head + "CM_ \"x\"\nBO_ 1 M: 8 A\nBO_ 2 N: 8 A\nCM_ \"end\";\nBO_ 3 O: 8 A\n",
         "2 note: the statement has no \";\"; it ends before the next one\n"},
        {"\xEF\xBB\xBF" + plain, "1 note: the file begins with a byte-order mark\n"},
        {head + "BO_ 1 M: 8 C\nBO_ 2 N: 8 A\nBO_ 3 O: 8 C\n", "2 note: BU_ names no node \"C\" +1\n"},
        {head + "BO_ 1 M: 8 AA\n", "2 note: BU_ names no node \"AA\"; did you mean \"A\"?\n"},
        {plain + "VAL_ 7 s 1 \"on\";\nVAL_ 1 t 1 \"on\";\n", "4 note: no message has the identifier 7\n"
                                                             "5 note: message \"M\" has no signal \"t\"\n"},
        {plain + "VAL_ 1 s 300 \"far\" 1 \"on\" 1 \"off\" 2 \"two\" 2 \"two\";\n",
         "4 note: signal \"s\" names the value 1, which has another name too +1\n"
         "4 note: signal \"s\" names the value 2, which has it twice\n"
         "4 note: signal \"s\" names the value 300, which its bits cannot hold\n"},
        {plain + "VAL_ 1 s 0 \"off\";\nVAL_ 1 s 1 \"on\";\n",
         "5 note: signal \"s\" has its values named twice; none of the names counts\n"},
        {head + "BO_ 1 M: 8 Vector__XXX\n SG_ t : 0|1600@1+ (1,0) [0|1E+481] \"\" Vector__XXX\n",
         "3 note: 1600 is too large for the number of the signal's bits, which is 64 at most\n"
         "3 note: the greatest value is beyond a double\n"},
        {plain + "BA_DEF_ \"x\" INT 0 1\nCM_ \"x\";\n",
         "4 note: the statement has no \";\"; it ends before the next one\n"},
    };
    for (const Case& each : cases) EXPECT_EQ(findings(each.text), each.findings) << each.text;
}

TEST(CheckDbc, names_who_suffers_from_a_fault) {
    const std::vector<Case> cases{
        {head + "BO_ 1 M: 200 A\n SG_ t : 0|1600@1+ (1,0) [0|0] \"\" Vector__XXX\n",
         "2 fault A: message \"M\" has 200 bytes, which no frame holds, only a transport protocol\n"
         "3 fault A: 1600 is too large for the number of the signal's bits, which is 64 at most\n"},
        {with_signal("s : 0|8@1+ (1,0) [0|1E+481] \"\" B\n"),
         "3 fault A: the greatest value is beyond a double\n"},
        {with_signal("s : 0|8@1+ (1,0) [5|2] \"\" B\n"), "3 fault A: signal \"s\" has an empty range\n"},
        {with_signal("s : 0|16@1+ (1,0) [0|0] \"\" A\n SG_ t : 8|8@1+ (1,0) [0|0] \"\" B\n"),
         "4 fault A B: signal \"M.t\" overlaps \"s\" at bit 8\n"},
        {with_signal("s : 60|8@1+ (1,0) [0|0] \"\" B\n"),
         "3 fault A B: signal \"M.s\" reaches outside its frame of 8 bytes: it starts at bit 60 (its lowest) "
         "and "
         "goes up 8 bits\n"},
        {with_signal("s : 0|8@1+ (0,0) [0|0] \"\" B\n SG_ s : 8|8@1+ (1,0) [0|0] \"\" B\n"),
         "3 fault A B: signal \"s\" has the factor 0: every value would be the offset\n"
         "4 fault A B: message \"M\" has two signals \"s\"\n"},
        {head + "BO_ 419361537 M: 8 A\nBO_ 2 M: 8 B\nBO_ 2 N: 12 B\n",
         "2 fault A: message \"M\" has the identifier 419361537: a standard one ends at 2047, an extended "
         "one has "
         "bit 31 set and 29 bits\n3 fault B: message \"M\" is there twice\n"
         "4 fault B: message \"N\" has the identifier of \"M\"\n"
         "4 fault B: frame \"N\" has 12 bytes: a classical frame holds 8 at most\n"},
        {plain + "SIG_VALTYPE_ 1 t : 1;\nBA_ \"GenMsgCycleTime\" BO_ 1 -5;\n",
         "4 fault A B: message \"M\" has no signal \"t\"\n5 fault A B: a cycle time of -5 ms\n"},
        {with_signal(std::string(64, 's') + " : 0|8@1+ (1,0) [0|0] \"\" B\n"),
         "3 fault A B: signal \"M." + std::string(64, 's') +
             "\": a facet's name has at most 63 characters; give it or its frame a shorter one with "
             ".called(\"..\")\n"},
        {with_signal("s m1 : 0|8@1+ (1,0) [0|0] \"\" B\n"),
         "3 fault A B: signal \"s\" is multiplexed but its message has no multiplexor\n"},
    };
    for (const Case& each : cases) EXPECT_EQ(findings(each.text), each.findings) << each.text;
}

TEST(CheckDbc, refuses_a_file_in_which_it_is_not_certain_whom_a_fault_concerns) {
    const std::string begins = ", expected a statement, which begins with BO_, SG_, VAL_ or the like\n";
    const std::vector<Case> cases{
        {"", "1 unreadable: the file has no statement; is it a DBC file?\n"},
        {"Notes of today\n", "1 unreadable: found \"Notes\"" + begins},
        {plain + "FOO_ 1 x;\n", "4 unreadable: found \"FOO_\"" + begins},
        {plain + head, "4 unreadable: BU_ is there twice\n"},
        {plain + "VAL_ 1 s 0 off;\n",
         "4 unreadable: found \"off;\", expected the value's name between quotes\n"},
        {with_signal("s : 0!8@1+ (1,0) [0|0] \"\" B\n"),
         "3 unreadable: found \"!8@1+\", expected \"|\" after the signal's first bit\n"},
        {head + "CM_ \"never closed;\n" + plain.substr(head.size()) + "CM_ \"x\";\n",
         "2 unreadable: a text is unclosed before the next statement\n"},
    };
    for (const Case& each : cases) EXPECT_EQ(findings(each.text), each.findings) << each.text;
}

TEST(CheckDbc, refuses_a_file_that_is_cut_off) {
    EXPECT_EQ(findings(plain + "BO_ 3"),
              "4 unreadable: the file ends, expected a message's name; is it whole?\n");
    EXPECT_EQ(findings(plain + "CM_ \"never ends\n"),
              "4 unreadable: a text is unclosed at the end of the file; is it whole?\n");
    EXPECT_EQ(findings(" SG_ s : 0|8@1+ (1,0) [0|0] \"\" B\n"),
              "1 unreadable: a signal without a message; write BO_ before it\n");
}

TEST(CheckDbc, tells_more_troubles_than_it_first_has_room_for) {
    std::string text = head;
    for (int i = 0; i < 200; ++i) text += "VAL_ " + std::to_string(i) + " s 1 \"on\";\n";
    EXPECT_EQ(check_dbc(text).size(), 200u);
}

TEST(CheckEds, tells_notes_faults_and_files_that_cannot_be_read) {
    const std::string device = "[1000]\nDataType=7\nAccessType=ro\n";
    const auto only = [](std::string_view text) {
        const std::vector<Finding> found = check_eds(text);
        return found.size() == 1 ? found[0] : Finding{.meaning = std::to_string(found.size()) + " findings"};
    };
    EXPECT_TRUE(check_eds(device).empty());
    const Finding note = only(device + "[2000]\nDataType=6\nAccessType=rw\nHighLimit=65536\n");
    EXPECT_EQ(note.weight, Weight::note) << note.meaning;
    EXPECT_TRUE(note.affects.empty());
    const Finding fault = only(device + "[2000]\nDataType=0x40\nAccessType=rw\n");
    EXPECT_EQ(fault.weight, Weight::fault) << fault.meaning;
    EXPECT_EQ(fault.affects, std::vector<std::string>{"rows that map or write 2000h:0"});
    const Finding lost = only(device + "[2000\nDataType=6\nAccessType=rw\nParameterValue=90000\n");
    EXPECT_EQ(lost.weight, Weight::unreadable) << lost.meaning;
    EXPECT_EQ(lost.line, 4u);
}

TEST(Check, prints_a_table_and_a_verdict_for_each_file) {
    const test::Folder folder;
    const auto write = [&](const std::string& name, const std::string& text) {
        std::filesystem::create_directories((folder / name).parent_path());
        std::ofstream{folder / name, std::ios::binary} << text;
    };
    const std::string at = folder.string() + "/";
    write("a.dbc", plain);
    write("deep/b.DBC", plain + "BA_DEF_ \"x\" INT 0 1\nCM_ \"x\";\n");
    write("deep/c.dbc", head + "BO_ 1 M: 8 C\n SG_ s : 0|0@1+ (1,0) [0|0] \"\" B\n");
    write("deep/d.dbc", "BO_");
    write("deep/other.txt", "BO_");
    const Report all = report_on({folder.string()});
    EXPECT_EQ(all.failure, "");
    EXPECT_TRUE(all.has_faults);
    EXPECT_EQ(
        all.text,
        at + "a.dbc: good\n" + at +
            "deep/b.DBC:4  note  nobody  the statement has no \";\"; it ends before the next one\n" + at +
            "deep/b.DBC: good, 1 note\n" + at + "deep/c.dbc:2  note   nobody  BU_ names no node \"C\"\n" +
            at + "deep/c.dbc:3  fault  C, B    signal \"s\" has 0 bits instead of 1 to 64\n" + at +
            "deep/c.dbc: 1 fault, 1 note; a row that takes such a part is refused\n" + at +
            "deep/d.dbc:1  unreadable  all  the file ends, expected a message's identifier; is it whole?\n" +
            at + "deep/d.dbc: unreadable\n");
    EXPECT_FALSE(report_on({at + "a.dbc", at + "deep/b.DBC"}).has_faults);
    write("e.dbc", "\x1B[2J\x07 1;\n");
    EXPECT_EQ(report_on({at + "e.dbc"}).text.find_first_of("\x1B\x07"), std::string::npos);
    EXPECT_TRUE(report_on({at + "deep/c.dbc"}, "B").has_faults);
    EXPECT_FALSE(report_on({at + "deep/c.dbc"}, "A").has_faults) << "who neither sends nor receives it";
    EXPECT_EQ(report_on({at + "deep/other.txt"}).failure,
              "\"" + at +
                  "deep/other.txt\" is no file that it reads; name files that end in .dbc, .eds or .dcf, or "
                  "a folder");
    EXPECT_EQ(report_on({at + "none.dbc"}).failure, "there is no file \"" + at + "none.dbc\"");
    EXPECT_EQ(report_on({}).failure, "name files or folders: tappet check press.dbc");
}

} // namespace
} // namespace tappet::checking
