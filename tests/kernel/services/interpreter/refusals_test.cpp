// A forbidden line is refused before it has any effect, with its place and the cure.
#include "tests/kernel/services/interpreter/line_rig.hpp"

namespace tappet::press {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Refused : Lines {
    Sentence begin(std::string_view line, Role role = Role::engineer, Origin origin = Origin::local) {
        Sentence fault =
            CommandInterpreter::line_functions.begin(&interpreter(), line, {role, origin}, refusal);
        if (fault.empty()) CommandInterpreter::line_functions.let_go(&interpreter());
        run(20ms);
        return fault;
    }
    LineRefusal refusal{};
};

TEST_F(Refused, line_is_reported_with_place_fault_and_cure) {
    static constexpr struct {
        std::string_view line, sentence;
    } cases[] = {
        {"", "line:1:1: the line is empty; write an expression or a statement"},
        {"# nothing", "line:1:10: the line is empty; write an expression or a statement"},
        {";", "line:1:2: the program has no statement"},
        {"gauge.forse", R"(line:1:7: "gauge" has no "forse"; did you mean "force"?)"},
        {"gage.force", R"(line:1:1: found name "gage", which is not known; did you mean "gauge"?)"},
        {"do rom.move_to(1)", R"(line:1:4: found component "rom", which is not known; did you mean "ram"?)"},
        {"1 2",
         R"(line:1:3: found "2" after the expression; a line is one expression, or statements that begin with do, set, var, if, wait ...)"},
        {"gauge.target = 3",
         R"(line:1:14: found "=" after the expression; a line is one expression, or statements that begin with do, set, var, if, wait ...)"},
        {"ram.move_to(3)", R"(line:1:5: "move_to" is a command, which takes time; write "do" and no value)"},
        {"set gauge.force = 1", R"(line:1:11: "force" is an output of "gauge", which alone writes it)"},
        {"do gauge.force.write(1)", R"(line:1:10: "force" is an output of "gauge", which alone writes it)"},
        {"do gauge.marks.push(1)",
         R"(line:1:10: "marks" is a buffered output of "gauge", which alone writes it)"},
        {"gauge.marks.push(1)",
         R"(line:1:7: "marks" is a buffered output of "gauge", which alone writes it)"},
        {"gauge.parts.pop()", R"(line:1:13: "parts" is a buffered input of "gauge", which alone reads it)"},
        {"do gauge.full()", R"(line:1:10: "full" is an event of "gauge", which alone emits it)"},
        {"this.force", R"(line:1:6: "this" has no "force")"},
        {"while true { }",
         R"(line:1:1: this loop can run without waiting; put yield or wait(...) into it, or count with "for" between constants, or let its row say at_most(n))"},
        {"StateMachine M { initial state A { } final state B { } }",
         R"(line:1:1: found "StateMachine", expected a value)"},
        {"set gauge.target = \"ten\"", "line:1:20: found a value of type text, expected double"},
        {"\"open",
         "line:1:1: found a text without its end; close the quotes in the same line; expected a value"},
        {"/* open", "line:1:1: found a comment without its end; write */ after it; expected a value"},
        {"do gauge.lock(true", "line:1:19: found the end of the text, expected \")\""},
    };
    for (const auto& each : cases) {
        EXPECT_EQ(begin(each.line).view(), each.sentence) << each.line;
        EXPECT_EQ(refusal, LineRefusal::wrong) << each.line;
    }
}

TEST_F(Refused, line_uses_no_more_than_its_room_when_hostile) {
    const auto repeated = [](std::string_view piece, std::size_t times) {
        std::string text;
        for (std::size_t i = 0; i < times; ++i) text += piece;
        return text;
    };
    EXPECT_THAT(std::string{begin(repeated("1+", 400)).view()},
                StartsWith("a line has at most 480 characters"));
    EXPECT_THAT(std::string{begin(repeated("(", 200)).view()},
                HasSubstr("nested deeper than scripts may be"));
    EXPECT_THAT(std::string{begin(repeated("-", 200)).view()},
                HasSubstr("nested deeper than scripts may be"));
    EXPECT_THAT(std::string{begin(repeated("do gauge.zero();", 28)).view()},
                HasSubstr("than there is room for"));
    EXPECT_THAT(std::string{begin(repeated("var matrix6x6 m; ", 3)).view()}, HasSubstr("line:1:"));
    EXPECT_THAT(std::string{begin(repeated("gauge.steps+", 39) + "1").view()}, testing::IsEmpty());
    for (int first = 1; first < 256; ++first)
        static_cast<void>(begin(std::string(3, static_cast<char>(first))));
    EXPECT_EQ(gauge().zeroed, 0);
    EXPECT_THAT(std::string{begin("gauge.force").view()}, testing::IsEmpty()) << "the next good one runs";
}

TEST_F(Refused, line_above_the_clients_role_changes_nothing) {
    static constexpr struct {
        std::string_view line;
        Role least;
    } cases[] = {{"1 + 1", Role::observer},
                 {"gauge.force + gauge.target", Role::observer},
                 {"gauge.all_homed()", Role::observer},
                 {"yield", Role::machine_operator},
                 {"do gauge.lock(true)", Role::machine_operator},
                 {"do ram.halt()", Role::machine_operator},
                 {"var int n; do ram.move_to(1, n)", Role::machine_operator},
                 {"do gauge.zero()", Role::engineer},
                 {"var int n = gauge.zero()", Role::engineer},
                 {"do ram.let_go()", Role::engineer},
                 {"set gauge.target = 1", Role::engineer}};
    for (const auto& each : cases)
        for (const Role role : {Role::observer, Role::machine_operator, Role::engineer}) {
            const Sentence fault = begin(each.line, role);
            EXPECT_EQ(fault.empty(), role >= each.least) << each.line << " for an " << to_text(role);
            EXPECT_EQ(refusal, fault.empty() ? LineRefusal::none : LineRefusal::denied) << each.line;
            run(100ms);
        }
    EXPECT_EQ(
        begin("do gauge.zero()", Role::machine_operator).view(),
        "\"gauge.zero\" needs the role of an engineer here, you are an operator; ask for it in the board's "
        "list of roles");
    EXPECT_EQ(
        begin("yield", Role::observer).view(),
        "statements need the role of an operator, you are an observer; write an expression, or ask for it "
        "in the board's list of roles");
}

TEST_F(Refused, network_line_passes_the_gate_of_every_other_request) {
    const auto from_network = [this](std::string_view line, Role role = Role::engineer) {
        return std::string{begin(line, role, Origin::network).view()};
    };
    for (const char* good : {"gauge.force", "gauge.half(3)", "set gauge.target = 12", "do gauge.lock(true)"})
        EXPECT_THAT(from_network(good), testing::IsEmpty()) << good;
    EXPECT_THAT(from_network("do gauge.zero()"), StartsWith(R"("gauge.zero" is not for people, so nobody)"));
    EXPECT_THAT(from_network("var int n; do ram.move_to(3, n)"),
                StartsWith(R"("ram.move_to" moves something, so nobody)"));
    EXPECT_THAT(from_network("do gauge.lock(true); do ram.creep()"),
                StartsWith(R"("ram.creep" moves something while it is held)"));
    EXPECT_EQ(refusal, LineRefusal::denied);
    EXPECT_THAT(from_network("do ram.halt()", Role::observer), HasSubstr("needs the role of an operator"));
    EXPECT_EQ(gauge().zeroed, 0);
    EXPECT_EQ(ram().target, 0);
    EXPECT_TRUE(begin("var int n; do ram.move_to(3, n)", Role::machine_operator, Origin::panel).empty());
}

} // namespace
} // namespace tappet::press
