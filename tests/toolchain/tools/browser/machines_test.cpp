// Several machines in one command: by name, side by side; the failure of one does not hide the others (thesis
// 4.8).
#include "tests/toolchain/tools/browser/outcome.hpp"
#include "tests/toolchain/tools/browser/sample_machine.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

namespace tappet::browser {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Several : public testing::Test {
protected:
    Several() {
        std::filesystem::create_symlink(saw.socket(), directory / "saw.socket");
        std::filesystem::create_symlink(drill.socket(), directory / "drill.socket");
    }
    [[nodiscard]] Outcome run(std::vector<std::string> words) const {
        words.insert(words.begin(), {"--directory", directory.string(), "--timeout", "500ms"});
        return run_words(words);
    }
    SampleMachine saw, drill;
    test::Folder directory;
};

TEST_F(Several, are_listed_with_their_states) {
    saw.answer("behaviours", {R"({"id": %, "ok": true, "behaviours": [{"name": "loom.cycle", )"
                              R"("status": "running", "state": "weave"}], "slots": []})"});
    drill.force("shaft.angle", true, 90.0);
    const Outcome all = run({"list"});
    EXPECT_EQ(all.code, 0) << all.errors;
    EXPECT_THAT(all.out, testing::MatchesRegex("drill  on test, process [0-9]+; 1 FORCED\n"
                                               "saw    on test, process [0-9]+; loom.cycle in weave\n"));
    std::istringstream lines{run({"list", "--json"}).out};
    std::vector<std::string> names;
    for (std::string line; std::getline(lines, line);)
        names.push_back(nlohmann::json::parse(line).value("machine", ""));
    EXPECT_THAT(names, ElementsAre("drill", "saw"));
}

TEST_F(Several, values_of_both_are_got_and_watched_in_one_command) {
    saw.write("shaft.angle", 12.5);
    drill.write("shaft.angle", 99.0);
    EXPECT_EQ(run({"get", "saw.shaft.angle", "drill.shaft.angle"}).out,
              "saw.shaft.angle = 12.5 deg\ndrill.shaft.angle = 99 deg\n");
    EXPECT_THAT(run({"get", "saw.shaft.angle", "--json"}).out, HasSubstr(R"({"name": "saw.shaft.angle", )"));
    EXPECT_THAT(run({"get", "saw.shaft"}).out, HasSubstr("saw.shaft.gains.p = 0"));
    EXPECT_EQ(run({"watch", "saw.shaft.angle", "drill.shaft.angle", "--every", "1ms", "--count", "2"}).out,
              "saw.shaft.angle = 12.5 deg\ndrill.shaft.angle = 99 deg\nsaw.shaft.angle = 12.5 "
              "deg\ndrill.shaft.angle = 99 deg\n");
}

TEST_F(Several, a_machine_hears_its_own_names_and_the_other_hears_nothing) {
    drill.answer("call", {R"({"id": %, "ok": true, "result": 3})"});
    EXPECT_EQ(run({"set", "saw.shaft.gains.p", "1.5", "saw.shaft.gains.i", "2"}).out,
              "set: saw.shaft.gains.p = 1.5, saw.shaft.gains.i = 2\n");
    EXPECT_EQ(run({"force", "saw.loom.lamp", "true"}).out, "forced: saw.loom.lamp = true\n");
    EXPECT_EQ(run({"restart", "saw.motion"}).code, 0);
    EXPECT_EQ(run({"behaviour", "pause", "saw.loom.cycle"}).out, "saw.loom.cycle: pause done\n");
    EXPECT_EQ(run({"save", "saw"}).code, 0);
    EXPECT_THAT(drill.asked(), IsEmpty());
    EXPECT_THAT(saw.asked(), ElementsAre("set shaft.gains.p 1.5 shaft.gains.i 2", "force loom.lamp true",
                                         "restart motion", "behave pause loom.cycle", "save"));
    EXPECT_EQ(run({"call", "drill.shaft.reset"}).out, "drill.shaft.reset = 3\n");
    EXPECT_THAT(run({"call", "drill.shaft.reset", "--json"}).out, HasSubstr(R"("machine":"drill")"));
    EXPECT_THAT(drill.asked(), ElementsAre("call shaft.reset", "call shaft.reset"));
}

TEST_F(Several, events_of_both_are_printed_as_they_come) {
    for (SampleMachine* each : {&saw, &drill})
        each->answer("subscribe",
                     {R"({"id": %, "ok": true})",
                      R"({"id": %, "event": "shaft.beat_up", "time_ns": 5000, "arguments": [1.5]})"});
    const Outcome told = run({"events", "saw.shaft.beat_up", "drill.shaft.beat_up", "--count", "2"});
    EXPECT_EQ(told.code, 0) << told.errors;
    EXPECT_EQ(told.out, "saw.shaft.beat_up [1.5] at 0.000005s\ndrill.shaft.beat_up [1.5] at 0.000005s\n");
    EXPECT_THAT(drill.asked(), ElementsAre("subscribe shaft.beat_up", "unsubscribe shaft.beat_up"));
}

TEST_F(Several, a_command_describes_each_machine_or_the_named_one) {
    EXPECT_THAT(run({"manifest"}).out,
                AllOf(HasSubstr("drill:\nmachine sample"), HasSubstr("saw:\nmachine")));
    EXPECT_THAT(run({"manifest", "saw"}).out, Not(HasSubstr("saw:\n")));
    EXPECT_THAT(run({"manifest", "--json"}).out, HasSubstr("{\"machine\": \"saw\"}\n{\"section\""));
    EXPECT_THAT(run({"list", "saw"}).out, AllOf(HasSubstr("saw.shaft "), Not(HasSubstr("drill"))));
    EXPECT_THAT(run({"list", "saw.shaft"}).out, HasSubstr("saw.shaft.stop"));
    EXPECT_THAT(run({"info", "saw.loom.angle"}).out, HasSubstr("<- saw.shaft.angle (stale after 4ms: hold)"));
}

TEST_F(Several, one_that_is_down_is_reported_and_the_other_answers) {
    drill.end();
    saw.write("shaft.angle", 12.5);
    const Outcome listed = run({"list"});
    EXPECT_EQ(listed.code, 3);
    EXPECT_THAT(listed.out, AllOf(HasSubstr("drill  does not answer\n"), HasSubstr("saw    on test")));
    EXPECT_THAT(listed.errors, HasSubstr("'drill' does not answer: nobody listens at"));
    EXPECT_THAT(run({"list", "--json"}).out, HasSubstr(R"({"machine": "drill", "error": "'drill' does not)"));
    for (const auto& words : {std::vector<std::string>{"get", "drill.shaft.angle", "saw.shaft.angle"},
                              {"watch", "drill.shaft.angle", "saw.shaft.angle", "--count", "1"}}) {
        const Outcome read = run(words);
        EXPECT_EQ(read.code, 3);
        EXPECT_EQ(read.out, "saw.shaft.angle = 12.5 deg\n");
        EXPECT_THAT(read.errors, HasSubstr("'drill' does not answer"));
    }
    EXPECT_EQ(run({"get", "saw.shaft.angle"}).code, 0) << "who is not named is not asked";
    EXPECT_EQ(run({"set", "drill.shaft.gains.p", "1"}).code, 3);
    const Outcome each = run({"forced"});
    EXPECT_EQ(each.code, 3);
    EXPECT_THAT(each.out, HasSubstr("saw:\n"));
}

TEST_F(Several, one_that_ends_is_reported_and_the_other_stays_watched) {
    saw.write("shaft.angle", 12.5);
    std::jthread ending{[this] {
        std::this_thread::sleep_for(std::chrono::milliseconds{200});
        drill.end();
    }};
    const Outcome watched =
        run({"watch", "drill.shaft.angle", "saw.shaft.angle", "--every", "100ms", "--count", "20"});
    EXPECT_EQ(watched.code, 3);
    EXPECT_THAT(watched.out,
                testing::ContainsRegex("\ndrill: the machine has ended\n(saw.shaft.angle = 12.5 deg\n)+$"));
    EXPECT_THAT(watched.errors, HasSubstr("drill ended; the last values shown are the last"));
}

TEST_F(Several, a_time_out_of_one_is_reported_and_the_other_answers) {
    drill.answer("behaviours", {});
    const Outcome silent = run({"list"});
    EXPECT_EQ(silent.code, 5);
    EXPECT_THAT(silent.errors, HasSubstr("'drill': no answer within 500 ms"));
    EXPECT_THAT(silent.out, HasSubstr("saw    on test"));
}

TEST_F(Several, a_name_without_a_machine_is_refused_with_the_likely_names) {
    const auto errors = [this](std::vector<std::string> words) {
        const Outcome refused = run(std::move(words));
        EXPECT_EQ(refused.code, 2);
        EXPECT_EQ(refused.out, "");
        return refused.errors;
    };
    EXPECT_THAT(errors({"get", "shaft.angle"}),
                HasSubstr("'shaft.angle' does not say of which machine: write drill.shaft.angle or "
                          "saw.shaft.angle"));
    EXPECT_THAT(errors({"get", "swa.shaft.angle"}), HasSubstr("did you mean \"saw\"?"));
    EXPECT_THAT(
        errors({"get", "polisher.shaft.angle"}),
        HasSubstr("there is no machine 'polisher' in '" + directory.string() + "'; there are drill, saw"));
    EXPECT_THAT(errors({"get", "saw.shaft.angel"}), HasSubstr("did you mean \"saw.shaft.angle\"?"));
    EXPECT_THAT(errors({"get", "saw.shaft.angle", "drill.shaft.angel"}), HasSubstr("drill.shaft.angle"));
    EXPECT_THAT(errors({"get", "saw"}), HasSubstr("'saw' is a machine; name what is meant in it"));
    EXPECT_THAT(errors({"save"}), HasSubstr("name one machine, as in 'save drill'; there are drill, saw"));
    EXPECT_THAT(errors({"set", "saw.shaft.gains.p", "1", "drill.shaft.gains.p", "1"}),
                HasSubstr("'set' takes names of one machine; these are of saw and drill"));
    EXPECT_THAT(errors({"set", "saw.shaft.gains.p"}), HasSubstr("'set' was given 1 arguments"));
    EXPECT_THAT(saw.asked(), IsEmpty());
    EXPECT_THAT(drill.asked(), IsEmpty());
}

TEST_F(Several, may_be_named_one_by_one_but_two_of_one_name_are_refused) {
    const Outcome named = run_words(
        {"--socket", "a=" + saw.socket(), "--socket", "b=" + drill.socket(), "get", "b.shaft.angle"});
    EXPECT_EQ(named.out, "b.shaft.angle = 0 deg   never written\n") << named.errors;
    const Outcome twice = run_words({"--socket", saw.socket(), "--socket", drill.socket(), "list"});
    EXPECT_EQ(twice.code, 2);
    EXPECT_THAT(twice.errors, AllOf(HasSubstr("two machines are called 'sample'"), HasSubstr("NAME=FILE")));
}

TEST_F(Several, the_only_one_left_still_answers_to_its_name) {
    std::filesystem::remove(directory / "drill.socket");
    saw.write("shaft.angle", 12.5);
    EXPECT_EQ(run({"get", "saw.shaft.angle"}).out, "shaft.angle = 12.5 deg\n");
    EXPECT_EQ(run({"get", "shaft.angle"}).out, "shaft.angle = 12.5 deg\n");
    EXPECT_EQ(run({"restart", "saw.shaft"}).code, 0);
    EXPECT_THAT(saw.asked(), ElementsAre("restart shaft"));
}

TEST_F(Several, a_refusal_names_its_machine) {
    saw.answer("set", {R"({"id": %, "ok": false, "code": "denied", "error": "an observer sets nothing"})"});
    const Outcome refused = run({"set", "saw.shaft.gains.p", "1"});
    EXPECT_EQ(refused.code, 1);
    EXPECT_EQ(refused.errors, "tappet-browse: saw: an observer sets nothing\n");
}

} // namespace
} // namespace tappet::browser
