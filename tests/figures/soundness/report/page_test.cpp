// The page contains a run, and the summary names what failed. page_test.js tests what the page shows.
#include "tests/figures/report/page.hpp"
#include "tests/figures/report/text.hpp"
#include "tests/figures/soundness/report/runs.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <tuple>

namespace tappet::figures {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Page, contains_the_run_and_no_text_of_it_ends_the_element) {
    Result told = result("exchange", 12);
    told.notes = {"</script><b>"};
    figures::Run run{"abc", "today", "short"};
    run.programs.push_back(ran(told));
    const std::string all = merged(run);
    const auto html = page(all);
    ASSERT_TRUE(html) << html.error();
    const std::string begin = "id=\"run\">";
    const auto from = html->find(begin) + begin.size();
    const std::string inside = html->substr(from, html->find("</script>", from) - from);
    EXPECT_EQ(nlohmann::json::parse(inside), nlohmann::json::parse(all));
}

TEST(Page, needs_no_external_resources) {
    const auto html = page("{}");
    ASSERT_TRUE(html) << html.error();
    EXPECT_THAT(*html, AllOf(Not(HasSubstr(" src=")), Not(HasSubstr("<link")), Not(HasSubstr("@import")),
                             Not(HasSubstr("url(")), Not(HasSubstr("fetch(")), Not(HasSubstr("href=\"h"))));
}

TEST(Summary, names_what_was_missed_was_false_and_failed) {
    Result told = result("exchange", 12);
    told.goals = {{"is something", 1.2, std::numeric_limits<double>::quiet_NaN()}};
    told.statements = {{"the highest never waits", true, "0 of 100"}, {"locks cost nothing", false, "8 us"}};
    figures::Run run{"abc", "today", "short"};
    run.programs = {ran(told), {"scale", "ended with exit code 3\nno <compiler>"}};
    EXPECT_THAT(summary_text(run),
                AllOf(HasSubstr("MISSED  - x"), HasSubstr("FALSE   locks cost nothing: 8 us"),
                      HasSubstr("FAILED  figures-scale ended with exit code 3"),
                      HasSubstr("0 of 1 goals held, 1 of 2 statements true, 1 of 2 programs failed"),
                      Not(HasSubstr("the highest never waits"))));
}

TEST(Text, numbers_show_only_significant_digits) {
    EXPECT_EQ(number_text(0.357), "0.36");
    EXPECT_EQ(number_text(20.44), "20.4");
    EXPECT_EQ(number_text(999.4), "999");
    EXPECT_EQ(number_text(1234567), "1 234 567");
    EXPECT_EQ(number_text(-1234), "-1 234");
    EXPECT_EQ(number_text(-123456), "-123 456");
    EXPECT_EQ(number_text(0), "0.00");
    EXPECT_EQ(number_text(0.0012), "0.0012");
    EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "-");
}

TEST(ResultFile, is_read_back_unchanged) {
    Result told = result("exchange", 12);
    told.figures[0].rows[0].instructions = 40;
    told.goals = {{"goal", 1.2, std::numeric_limits<double>::quiet_NaN(), "x", "detail"}};
    told.statements = {{"statement", true, "as measured"}};
    told.plots = {{"p", "t", "x", "y", true, false, true, {{"s", Standing::peer, {{1, 2}}}}}};
    told.notes = {"note"};
    const std::string file = testing::TempDir() + "result.json";
    ASSERT_EQ(told.write(file), "");
    const auto again = read_result(file);
    std::filesystem::remove(file);
    ASSERT_TRUE(again) << again.error();
    EXPECT_EQ(again->text(), told.text());
    EXPECT_EQ(again->figures[0].rows[0].instructions, 40);
    EXPECT_EQ(again->plots[0].series[0].role, Standing::peer);
    EXPECT_TRUE(std::isnan(again->goals[0].measured));
}

TEST(Merged, holds_all_of_a_run) {
    figures::Run run{"abc", "today", "long"};
    run.machine = {{"processor", "fast"}};
    run.before.spread_percent = 1.5;
    run.programs = {ran(result("exchange", 12)), {"scale", "could not be started"}};
    run.programs[0].usage.seconds = 3;
    run.programs[0].after.worst_percent = 9;
    const auto all = nlohmann::json::parse(merged(run));
    EXPECT_EQ(all["commit"], "abc");
    EXPECT_EQ(all["machine"][0][1], "fast");
    EXPECT_EQ(all["noise_before"]["spread_percent"], 1.5);
    const auto& [first, second] = std::tie(all["programs"][0], all["programs"][1]);
    EXPECT_EQ(first["usage"]["seconds"], 3);
    EXPECT_EQ(first["noise_after"]["worst_percent"], 9);
    EXPECT_EQ(first["result"]["figures"][0]["rows"][0]["median"], 12);
    EXPECT_EQ(second["failure"], "could not be started");
}

} // namespace
} // namespace tappet::figures
