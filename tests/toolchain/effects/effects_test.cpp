// The compiler's companion: g++ compiles a source, and clang follows its function effects beside it.
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>

namespace tappet {
namespace {

using testing::HasSubstr;
using testing::Not;

class Companion : public testing::Test {
protected:
    /// Compiles a component with this body of its step as a user's build does, with g++.
    [[nodiscard]] Ended compile(const std::string& step, const std::string& clang = CLANG) const {
        std::ofstream{folder_ / "filler.cpp"} << "#include \"kernel/base/realtime.hpp\"\n"
                                                 "#include <mutex>\n"
                                                 "#include <vector>\n"
                                                 "#include <unistd.h>\n"
                                                 "std::vector<int> list;\n"
                                                 "std::mutex mutex;\n"
                                                 "int count = OF;\n"
                                                 "struct Filler { void step() noexcept TAPPET_REALTIME; };\n"
                                                 "void Filler::step() noexcept TAPPET_REALTIME {\n"
                                              << step << "\n}\n";
        return run_line("cd " + folder_.string() + " && " TAPPET_EFFECTS " " + clang +
                        " -Wno-everything -Wfunction-effects -Werror=function-effects -- g++ -std=c++23 -O2 "
                        "-fconstexpr-ops-limit=2000000000 -DOF=1 -I" SOURCE_DIRECTORY
                        " -MD -MT filler.o -MF filler.d -o filler.o -c filler.cpp");
    }
    [[nodiscard]] bool has(const char* file) const { return std::filesystem::exists(folder_ / file); }

    test::Folder folder_;
};

TEST_F(Companion, is_silent_about_a_step_that_cannot_block) {
    const Ended ended = compile("++count;");
    EXPECT_EQ(ended.exit_code, 0) << ended.text;
    EXPECT_EQ(ended.text, "");
    EXPECT_TRUE(has("filler.o"));
    EXPECT_TRUE(has("filler.d"));
    EXPECT_FALSE(has("filler.o.effects"));
    EXPECT_FALSE(has("filler.o.effects.txt"));
}

TEST_F(Companion, refuses_what_may_block_at_the_users_line_and_leaves_no_object) {
    for (const char* step : {"::usleep(1);", "list.push_back(1);", "const std::lock_guard hold{mutex};",
                             "throw 1;", "delete new int;"}) {
        const Ended ended = compile(step);
        EXPECT_EQ(ended.exit_code, 1) << step;
        EXPECT_THAT(ended.text, HasSubstr("filler.cpp:10:")) << step;
        EXPECT_THAT(ended.text, HasSubstr(step)) << "the line itself is shown";
        EXPECT_THAT(ended.text, HasSubstr("with 'nonblocking' attribute must not")) << step;
        EXPECT_THAT(ended.text, HasSubstr("a real-time function may block")) << step;
        EXPECT_THAT(ended.text, Not(HasSubstr("in template expansion here"))) << "the first reason is enough";
        EXPECT_FALSE(has("filler.o")) << "a later build would take it for good";
    }
}

TEST_F(Companion, does_not_repeat_the_errors_of_a_source_that_does_not_compile) {
    const Ended ended = compile("::usleep(1); ++cuont;");
    EXPECT_NE(ended.exit_code, 0);
    EXPECT_THAT(ended.text, HasSubstr("was not declared")); // g++'s words
    EXPECT_THAT(ended.text, Not(HasSubstr("undeclared identifier"))) << "clang's words";
    EXPECT_FALSE(has("filler.o"));
}

TEST_F(Companion, shows_what_only_clang_does_not_accept) {
    const Ended ended = compile("count = __builtin_apply_args() != nullptr;");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.text, HasSubstr("__builtin_apply_args"));
    EXPECT_FALSE(has("filler.o"));
}

TEST_F(Companion, fails_when_the_check_cannot_run) {
    const Ended ended = compile("++count;", "no-such-clang");
    EXPECT_NE(ended.exit_code, 0);
    EXPECT_THAT(ended.text, HasSubstr("no-such-clang"));
    EXPECT_FALSE(has("filler.o"));
}

TEST_F(Companion, names_its_usage) {
    EXPECT_THAT(run_line(TAPPET_EFFECTS).text, HasSubstr("CHECK... -- COMPILE..."));
    EXPECT_EQ(run_line(TAPPET_EFFECTS " clang --").exit_code, 3);
    EXPECT_THAT(run_line(TAPPET_EFFECTS " clang -- g++ -c a.cpp").text, HasSubstr("no -o OBJECT"));
}

} // namespace
} // namespace tappet
