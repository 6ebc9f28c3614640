// The page and the summary show everything that a run found, failures first.
#include "tests/figures/report/page.hpp"
#include "tests/figures/report/plots.hpp"
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

struct Page : testing::Test {
    std::string folder = testing::TempDir() + "figures-page";
    ~Page() override { std::filesystem::remove_all(folder); }

    figures::Run run{"abc", "today", "short"};
    std::string text() { return page(run, folder); }
    std::string text_with(Result result) {
        run.programs.push_back(ran(std::move(result)));
        return text();
    }
};

TEST_F(Page, shows_ours_beside_its_floor_and_its_peer_as_ratios) {
    EXPECT_THAT(text_with(result("exchange", 12)),
                AllOf(HasSubstr("exchange.write"), HasSubstr("<b>1.20 x</b> copy (p99 1.20 x)"),
                      HasSubstr("<b>0.30 x</b> mutex")));
}

TEST_F(Page, shows_the_missed_goals_before_those_that_were_held) {
    Result told = result("exchange", 12);
    told.goals = {{"is short", 1.2, 1.1}, {"is lean", 1.0, 3.0}};
    const std::string html = text_with(told);
    EXPECT_LT(html.find("is lean"), html.find("is short"));
    EXPECT_THAT(html, HasSubstr("<b>1 of 2</b>goals held"));
}

TEST_F(Page, a_goal_that_has_no_number_is_missed) {
    Result told = result("exchange", 12);
    told.goals = {{"is something", 1.2, std::numeric_limits<double>::quiet_NaN()}};
    EXPECT_THAT(text_with(told), HasSubstr("<b>0 of 1</b>goals held"));
    EXPECT_THAT(summary_text(run), HasSubstr("MISSED  - x"));
}

TEST_F(Page, says_which_program_failed_and_what_it_said_last) {
    run.programs.push_back({"scale", "ended with exit code 3\nno <compiler>"});
    EXPECT_THAT(text(), AllOf(HasSubstr("figures-scale ended with exit code 3"),
                              HasSubstr("no &lt;compiler&gt;"), HasSubstr("<b>0 of 1</b>programs ran")));
    EXPECT_THAT(summary_text(run), HasSubstr("FAILED  figures-scale ended with exit code 3"));
}

TEST_F(Page, text_of_a_program_is_escaped) {
    const std::string tag = "<script>\"&'";
    Result told = result("exchange", 12);
    told.figures[0].title = told.figures[0].rows[0].name = told.figures[0].how = tag;
    told.goals = {{tag, 1, 1, "x", tag}};
    told.statements = {{tag, true, tag}};
    told.notes = {tag};
    told.plots = {{"p", tag, tag, tag, false, false, false, {{tag, Standing::ours, {{1, 1}, {2, 2}}}}}};
    run.programs.push_back(ran(told));
    run.machine = {{tag, tag}};
    EXPECT_THAT(text(), AllOf(HasSubstr("&lt;script&gt;&quot;&amp;&#39;"), Not(HasSubstr("<script"))));
}

TEST_F(Page, needs_no_external_resources) {
    Result told = result("exchange", 12);
    told.plots = {
        {"p", "a plot", "x", "y", true, false, true, {{"ours", Standing::ours, {{1, 3}, {2, 0}, {3, 9}}}}}};
    const std::string html = text_with(told);
    EXPECT_THAT(html, AllOf(Not(HasSubstr(" src=")), Not(HasSubstr("<link")), Not(HasSubstr("@import")),
                            Not(HasSubstr("<?xml")), Not(HasSubstr("url(http"))));
    for (auto at = html.find("href=\""); at != html.npos; at = html.find("href=\"", at + 1))
        EXPECT_EQ(html[at + 6], '#') << html.substr(at, 60);
    EXPECT_THAT(html, HasSubstr("<svg role=\"img\" aria-label=\"a plot\""));
}

TEST_F(Page, statements_are_true_or_false_as_measured) {
    Result told = result("experiments", 12);
    told.statements = {{"the highest never waits", true, "0 of 100"}, {"locks cost nothing", false, "8 us"}};
    EXPECT_THAT(text_with(told), HasSubstr("<b>1 of 2</b>statements true"));
    EXPECT_THAT(summary_text(run), AllOf(HasSubstr("FALSE   locks cost nothing: 8 us"),
                                         Not(HasSubstr("the highest never waits"))));
}

TEST(Plots, quotes_in_a_name_are_escaped_for_gnuplot) {
    Plot plot{"p", "t", "x's", "y", false, false, false, {{"it's", Standing::ours, {{1, 1}}}}};
    EXPECT_THAT(gnuplot_script(plot, "p0", "out.svg"), AllOf(HasSubstr("'it''s'"), HasSubstr("'x''s'")));
}

TEST(Plots, points_that_an_axis_cannot_show_are_left_out) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Plot plot{"p",   "t",  "x",  "y",
              false, true, true, {{"s", Standing::ours, {{0, 1}, {1, 0}, {nan, 1}, {7, 5}}}}};
    EXPECT_THAT(gnuplot_script(plot, "p0", "out.svg"), HasSubstr("<< END\n7 5\nEND"));
    plot.series[0].points.pop_back();
    EXPECT_EQ(gnuplot_script(plot, "p0", "out.svg"), "") << "nothing is left to draw";
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

TEST(Text, a_floor_of_one_row_is_compared_with_that_row_alone) {
    const Figure figure{"f",
                        "t",
                        "us",
                        "",
                        "",
                        {row("high, one", Standing::ours, 20), row("high, its load", Standing::floor, 10),
                         row("low", Standing::ours, 60), row("low, its load", Standing::floor, 30),
                         row("mutex", Standing::peer, 40)}};
    const auto names = [&](std::size_t i) {
        std::vector<std::string> all;
        for (const Beside& other : beside(figure, figure.rows[i])) all.push_back(other.name);
        return all;
    };
    EXPECT_THAT(names(0), testing::ElementsAre("high, its load", "mutex"));
    EXPECT_THAT(names(2), testing::ElementsAre("low, its load", "mutex"));
    EXPECT_THAT(names(1), testing::IsEmpty());
    EXPECT_EQ(ours_beside(figure, figure.rows[3]).name, "low");
    EXPECT_EQ(ours_beside(figure, figure.rows[4]).name, "high, one") << "the first of ours";
}

TEST_F(Page, a_single_measurement_has_no_quantiles) {
    Result told = result("firmware", 12);
    for (Row& each : told.figures[0].rows) each.summary.count = 1;
    EXPECT_THAT(text_with(told), AllOf(HasSubstr("<th>value</th>"), Not(HasSubstr("p99.9</th>")),
                                       HasSubstr("<b>1.20 x</b> copy</span>")));
}

TEST_F(Page, a_goal_links_to_its_figure) {
    Result told = result("exchange", 12);
    told.goals = {{"is short", 1.2, 1.1, "x", "exchange.write: port / copy"}};
    EXPECT_THAT(text_with(told), HasSubstr("<a href=\"#exchange.write\">exchange.write</a>: port / copy"));
}

TEST_F(Page, many_figures_are_grouped_by_the_prefix_of_their_ids) {
    Result told{"experiments"};
    for (int i = 0; i < 30; ++i) {
        Figure figure = result("x", 12).figures[0];
        figure.id = std::string{i % 2 == 0 ? "experiments.small." : "experiments.large."} + std::to_string(i);
        told.figures.push_back(figure);
    }
    const std::string html = text_with(told);
    std::size_t folds = 0;
    for (auto at = html.find("<details>"); at != html.npos; at = html.find("<details>", at + 1)) ++folds;
    EXPECT_EQ(folds, 2u);
    for (const Figure& figure : told.figures) EXPECT_THAT(html, HasSubstr("id=\"" + figure.id + "\""));
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
