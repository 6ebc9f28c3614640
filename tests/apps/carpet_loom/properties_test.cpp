// The loom's properties in files (thesis 4.7.1): the loom weaves with the values of a commissioning engineer,
// saves them at the end and finds them again. A wrong file keeps the loom from starting; one line says where
// the mistake is and what to do.
#include "tests/apps/carpet_loom/program.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace tappet::carpet {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

struct Kept : testing::Test {
    test::Folder directory;
    void put(const char* name, const std::string& members) const {
        std::ofstream{directory / name} << "<properties>\n" << members << "\n</properties>\n";
    }
    [[nodiscard]] std::string get(const char* name) const { return test::contents_of(directory / name); }
    [[nodiscard]] Ended run(const std::string& seed = "4") const {
        return run_loom({"--picks", "10", "--seed", seed, "--properties", directory.string()});
    }
    /// The line on the terminal when the loom refuses this file.
    [[nodiscard]] std::string refusal(const char* name, const std::string& members) const {
        put(name, members);
        const Ended ended = run();
        EXPECT_EQ(ended.exit_code, 2) << "it has not started";
        std::filesystem::remove(directory / name);
        return ended.text;
    }
    [[nodiscard]] std::string begin(const char* name, int line) const {
        return "carpet-loom: " + (directory / name).string() + ":" + std::to_string(line) + ": component \"";
    }
};

constexpr const char* gains = R"(<struct name="gains" type="PropertyBag">
<simple name="proportional" type="double"><value>0.006</value></simple></struct>)";

TEST_F(Kept, values_are_used_and_saved_with_all_the_others) {
    put("warp.cpf", gains);
    ASSERT_EQ(run().exit_code, 0);
    EXPECT_THAT(get("warp.cpf"), AllOf(HasSubstr("<value>0.006</value>"), HasSubstr("name=\"integral\""),
                                       HasSubstr("name=\"set_point_n\"")));
    EXPECT_THAT(get("main.cpf"), AllOf(HasSubstr("name=\"speed_rpm\""), HasSubstr("<value>15ms</value>")))
        << "a file that was not there is there for the next time";
    const std::string saved = get("warp.cpf");
    ASSERT_EQ(run().exit_code, 0);
    EXPECT_EQ(get("warp.cpf"), saved);
}

TEST_F(Kept, values_that_are_wrong_are_refused_with_their_file_their_line_and_a_cure) {
    EXPECT_THAT(refusal("warp.cpf", "\n<simple name=\"band\" type=\"double\"><value>30</value></simple>"),
                AllOf(StartsWith(begin("warp.cpf", 3) + "warp\""), HasSubstr("did you mean \"band_n\"?")));
    EXPECT_THAT(refusal("warp.cpf", R"(<simple name="band_n" type="string"><value>30</value></simple>)"),
                AllOf(StartsWith(begin("warp.cpf", 2) + "warp\""), HasSubstr("write type=\"double\"")));
    EXPECT_THAT(
        refusal("main.cpf", R"(<simple name="speed_rpm" type="double"><value>100000</value></simple>)"),
        AllOf(StartsWith(begin("main.cpf", 2) + "main\""), HasSubstr("over its greatest value")));
    EXPECT_THAT(refusal("main.cpf", "<simple"),
                AllOf(StartsWith("carpet-loom: "), HasSubstr("malformed XML")));
}

TEST_F(Kept, values_that_contradict_each_other_are_refused_by_their_component) {
    EXPECT_THAT(
        refusal("warp.cpf", R"(<simple name="set_point_n" type="double"><value>60</value></simple>
<simple name="band_n" type="double"><value>80</value></simple>)"),
        AllOf(StartsWith(
                  "component \"warp\": \"set_point_n\" is 60 from its file"), // both beat the row's value
              HasSubstr(
                  "\ncarpet-loom: component \"warp\" refuses its properties (see \"warp.cpf\"): band_n")));
}

} // namespace
} // namespace tappet::carpet
