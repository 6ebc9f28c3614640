// The program from its command line to its exit code, against a machine that the test controls (thesis 4.8).

#include "tests/toolchain/tools/browser/outcome.hpp"
#include "tests/toolchain/tools/browser/sample_machine.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace tappet::browser {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Program : public testing::Test {
protected:
    Outcome run(std::vector<std::string> words) {
        words.insert(words.begin(), {"--directory", machine.directory()});
        return run_words(words);
    }
    std::vector<std::string> asked() { return machine.asked(); }
    SampleMachine machine;
};

TEST_F(Program, lists_components_and_their_facets) {
    const Outcome all = run({"list"});
    EXPECT_EQ(all.code, 0);
    EXPECT_THAT(all.out, HasSubstr("MainShaft"));
    const Outcome one = run({"list", "shaft"});
    EXPECT_THAT(one.out, HasSubstr("shaft.stop"));
    EXPECT_THAT(one.out, HasSubstr("(double)"));
    EXPECT_THAT(one.out, HasSubstr(" [operator]\n")) << "who may send it";
    EXPECT_THAT(one.out, HasSubstr("0 deg            of the main shaft"));
    EXPECT_THAT(run({"list", "shaft", "--json"}).out,
                testing::AllOf(HasSubstr(R"("name": "shaft.angle", "kind": "output")"),
                               testing::ContainsRegex(R"("name": "shaft.stop".*"role": "operator", )"
                                                      R"("for_people": true, "motion": "none")")));
    EXPECT_THAT(run({"list", "loom"}).out, HasSubstr(" [operator, moves]\n"));
    EXPECT_THAT(run({"list", "loom", "--json"}).out, HasSubstr(R"("motion": "moves")"));
}

TEST_F(Program, shows_the_wire_wherever_a_component_has_read_another_value) {
    machine.write("shaft.angle", 14.0, 3'000'000);
    machine.write("loom.angle", 12.5, 1'000'000);
    EXPECT_THAT(run({"get", "loom.angle"}).out, HasSubstr("12.5 deg   wire 14 deg, 2ms newer\n"));
    EXPECT_THAT(run({"list", "loom"}).out, HasSubstr("12.5 deg, wire 14 deg"));
    for (const char* word : {"tree", "info"})
        EXPECT_THAT(run({word, word == std::string_view{"tree"} ? "loom" : "loom.angle"}).out,
                    testing::ContainsRegex("<- shaft.angle .*, wire 14 deg\n"));
    for (const char* word : {"list", "get"})
        EXPECT_THAT(run({word, word == std::string_view{"list"} ? "loom" : "loom.angle", "--json"}).out,
                    HasSubstr(R"("wire": 14, "wire_time_ns": 3000000)"));
    machine.write("loom.angle", 14.0, 3'000'000);
    EXPECT_THAT(run({"list", "loom"}).out, Not(HasSubstr("wire")));
}

class BlackBox : public Program {
protected:
    /// Writes a black box of the machine in its present state.
    std::string keep(std::uint32_t version = map::black_box::version, std::string_view answers = {}) {
        map::black_box::Record box;
        box.magic = map::black_box::magic;
        box.version = version;
        box.exit_code = 139;
        box.memory_bytes = machine.memory().size();
        box.wall_ns = 86'400'000'000'000;
        box.signal = 11;
        box.instruction = 0x4e1c99;
        box.returns[0] = 0x4e1c00;
        std::string{"loom"}.copy(box.machine.data(), 4);
        std::string{"SEGV at instruction 0x4e1c99"}.copy(box.reason.data(), 40);
        std::vector<char> file(map::black_box::memory_at + machine.memory().size());
        std::memcpy(file.data(), &box, sizeof box);
        std::ranges::transform(machine.memory(), file.begin() + map::black_box::memory_at,
                               [](std::byte each) { return static_cast<char>(each); });
        const std::string path = machine.directory() + "/loom-0.blackbox";
        file.insert(file.end(), answers.begin(), answers.end());
        std::ofstream{path, std::ios::binary}.write(file.data(), static_cast<std::streamsize>(file.size()));
        return path;
    }
};

TEST_F(BlackBox, shows_why_the_machine_ended_and_where_its_activities_stood) {
    machine.hold("shaft.angle", true);
    const Outcome told = run({"post-mortem", keep()});
    EXPECT_EQ(told.code, 0) << told.errors;
    EXPECT_THAT(told.out, HasSubstr("1970-01-02 00:00:00 UTC: SEGV at instruction 0x4e1c99; exit code 139"));
    EXPECT_THAT(told.out, HasSubstr("addr2line -Cfipe FIRMWARE 0x4e1c99 0x4e1bff ("));
    EXPECT_THAT(told.out, testing::ContainsRegex("activity .*: was in its cycle"));
    EXPECT_THAT(run({"post-mortem", keep(), "--json"}).out, HasSubstr(R"("exit_code": 139)"));
    EXPECT_THAT(asked(), IsEmpty()) << "nobody is asked";
}

TEST_F(BlackBox, answers_only_commands_that_read) {
    machine.write("shaft.angle", 12.5);
    machine.hold("shaft.angle", true); // half-written values are shown at once, without waiting
    const std::string file = keep();
    EXPECT_THAT(run({"post-mortem", file, "get", "shaft.angle"}).out, HasSubstr("12.5"));
    EXPECT_EQ(run({"post-mortem", file, "list"}).out, run({"list"}).out);
    const Outcome asked_for = run({"post-mortem", file, "send", "shaft.stop"});
    EXPECT_EQ(asked_for.code, 2);
    EXPECT_THAT(asked_for.errors, HasSubstr("is a black box: it can be read, but it answers no requests"));
    EXPECT_THAT(run({"post-mortem", file, "lits"}).errors, HasSubstr("list"));
}

TEST_F(BlackBox, gives_the_last_answers_of_the_machine) {
    const std::string file =
        keep(map::black_box::version,
             "behaviours\t{\"id\": 0, \"ok\": true, \"behaviours\": [{\"name\": \"loom.cycle\", "
             "\"kind\": \"machine\", \"status\": \"running\", \"state\": \"weave\"}], \"slots\": []}\n"
             "behaviours loom.cycle\t{\"cut off");
    EXPECT_EQ(run({"post-mortem", file, "behaviour"}).out, "loom.cycle: running, in weave\n");
    EXPECT_THAT(run({"post-mortem", file, "behaviour", "list", "loom.cycle"}).errors,
                HasSubstr("it answers no requests"));
}

TEST_F(BlackBox, is_shown_even_for_a_machine_without_a_browser_service) {
    const std::string file = keep(map::black_box::version, {});
    std::fstream box{file, std::ios::binary | std::ios::in | std::ios::out};
    box.seekp(offsetof(map::black_box::Record, memory_bytes));
    box.write("\0\0\0\0\0\0\0", 8);
    box.close();
    EXPECT_THAT(run({"post-mortem", file}).errors,
                HasSubstr("which had no BrowserService; what is known: SEGV at instruction 0x4e1c99"));
}

TEST_F(BlackBox, is_refused_when_foreign_truncated_or_of_another_version) {
    EXPECT_THAT(run({"post-mortem", "/nowhere"}).errors,
                HasSubstr("'/nowhere' cannot be opened: No such file"));
    const std::string file = keep();
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 4096);
    EXPECT_THAT(run({"post-mortem", file}).errors, HasSubstr("is cut off"));
    EXPECT_THAT(run({"post-mortem", keep(7)}).errors, HasSubstr("is a black box of version 7"));
    std::ofstream{file} << "text";
    EXPECT_THAT(run({"post-mortem", file}).errors, HasSubstr("is not a black box"));
    EXPECT_THAT(run({"post-mortem"}).errors, HasSubstr("usage: post-mortem FILE"));
    std::filesystem::remove(file);
}

TEST_F(Program, reports_why_the_machine_disconnected_it) {
    machine.answer("save",
                   {R"({"id": 0, "ok": false, "code": "not_now", "error": "an engineer needs this place"})"});
    const Outcome outcome = run({"save"});
    EXPECT_NE(outcome.code, 0);
    EXPECT_THAT(outcome.errors, HasSubstr("an engineer needs this place"));
}

TEST_F(Program, closes_the_machines_descriptors_with_its_session) {
    const auto of_its_memory = [] {
        std::size_t count = 0;
        for (const auto& each : std::filesystem::directory_iterator{"/proc/self/fd"}) {
            std::error_code gone;
            count += std::filesystem::read_symlink(each, gone).string().find("memfd:") != std::string::npos;
        }
        return count;
    };
    EXPECT_EQ(run({"list"}).code, 0); // the first session may open lasting descriptors
    const auto before = of_its_memory();
    EXPECT_EQ(run({"list"}).code, 0);
    EXPECT_EQ(of_its_memory(), before);
}

TEST_F(Program, says_that_a_machine_records_no_cycles_and_the_cure) {
    const Outcome scope = run({"scope", "worst"});
    EXPECT_EQ(scope.code, 1);
    EXPECT_THAT(scope.errors, HasSubstr("component<ThreadScope>"));
}

TEST_F(Program, says_why_a_machine_is_not_in_a_state) {
    machine.answer("why",
                   {R"({"id": %, "ok": true, "name": "loom.cycle", "status": "running", "state": "a/ready", )"
                    R"("wanted": "a/run", "is_final": false, "path": ["ready", "run"], "ways": [)"
                    R"({"from": "ready", "to": "run", "event": "io.start.rises", "answer": "guard", )"
                    R"("because": "it waits for", "detail": "oil"}, )"
                    R"({"from": "a", "to": "run", "reason": "long enough", "answer": "too_early", )"
                    R"("left_ns": 1234567890}, {"from": "a", "to": "run", "answer": "guard"}]})"});
    EXPECT_EQ(run({"why", "loom.run"}).out,
              "loom.cycle is running, in a/ready; the way to a/run: ready -> run\n"
              "    ready -> run awaits io.start.rises, and its guard says no: it waits for: oil\n"
              "    a -> run (long enough): in 1.23s\n"
              "    a -> run: its condition does not hold\n");
    EXPECT_EQ(asked(), std::vector<std::string>{"why loom.run"});
    EXPECT_EQ(run({"why"}).code, 2);
}

TEST_F(Program, gets_values_for_people_and_for_programs) {
    machine.write("shaft.angle", 12.5, 77);
    EXPECT_EQ(run({"get", "shaft.angle"}).out, "shaft.angle = 12.5 deg\n");
    EXPECT_EQ(run({"get", "shaft.angle", "--json"}).out,
              "{\"name\": \"shaft.angle\", \"value\": 12.5, \"unit\": \"deg\", \"flow\": \"fresh\", "
              "\"forced\": false, \"time_ns\": 77}\n");
    EXPECT_THAT(run({"get", "shaft"}).out, HasSubstr("shaft.gains.p = 0"));
}

TEST_F(Program, an_unknown_name_is_refused_with_the_nearest_and_exit_code_2) {
    const Outcome outcome = run({"get", "shaft.angel"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.errors, HasSubstr("did you mean \"shaft.angle\"?"));
    EXPECT_EQ(run({"gte", "shaft.angle"}).code, 2);
    EXPECT_THAT(run({"gte", "shaft.angle"}).errors, HasSubstr("did you mean \"get\"?"));
    EXPECT_THAT(run({"list", "shafd"}).errors, HasSubstr("did you mean \"shaft\"?"));
    EXPECT_THAT(run({"stop", "shafd"}).errors, HasSubstr("did you mean \"shaft\"?"));
    EXPECT_THAT(asked(), IsEmpty());
}

TEST_F(Program, a_misspelt_command_is_refused_with_the_nearest_one) {
    EXPECT_THAT(run({"help", "lsit"}).errors, HasSubstr("did you mean \"list\"?"));
    EXPECT_EQ(run({"help", "lsit"}).code, 2);
    EXPECT_THAT(run({"help", "list"}).out, HasSubstr("list [COMPONENT]"));
    EXPECT_THAT(run({"behaviour", "pasue", "loom.cycle"}).errors, HasSubstr("did you mean \"pause\"?"));
    EXPECT_THAT(run({"behaviour", "pause"}).errors, HasSubstr("has the wrong arguments"));
    EXPECT_THAT(asked(), IsEmpty());
}

TEST_F(Program, an_option_of_another_command_is_refused_and_its_own_named) {
    const Outcome outcome = run({"get", "shaft.angle", "--every", "1s"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.errors, "tappet-browse: 'get' takes no --every; watch behaviour may\n");
    EXPECT_THAT(run({"save", "--follow"}).errors, HasSubstr("'save' takes no --follow; send may"));
    EXPECT_THAT(run({"--to", "a.vcd"}).errors, HasSubstr("only a command takes --to; post-mortem scope may"));
    EXPECT_EQ(run({"get", "shaft.angle", "--json", "--timeout", "1s"}).code, 0) << "those are for all";
    EXPECT_EQ(run({"watch", "shaft.angle", "--count", "1", "--every", "1ms"}).code, 0);
    EXPECT_THAT(asked(), IsEmpty());
}

TEST_F(Program, prints_the_effective_table) {
    machine.write("shaft.gains.p", 1.0 / 3.0, 5);
    const Outcome manifest = run({"manifest"});
    EXPECT_EQ(manifest.code, 0) << manifest.errors;
    EXPECT_THAT(manifest.out, testing::StartsWith("machine sample on board test"));
    EXPECT_THAT(manifest.out, HasSubstr("\n    shaft MainShaft, device encoder\n"));
    EXPECT_THAT(manifest.out, HasSubstr("gains.p = 0.333333"));
    EXPECT_THAT(manifest.out, HasSubstr("shaft.angle -> loom.angle, stale after 4ms: hold"));
    const std::string json = run({"manifest", "--json"}).out;
    EXPECT_THAT(json, HasSubstr(R"("name": "shaft.gains.p", "value": 0.3333333333333333)"));
    EXPECT_THAT(
        json,
        HasSubstr(
            R"({"section": "connection", "from": "shaft.angle", "to": "loom.angle", "stale_after_ns": 4000000)"));
    std::istringstream lines{json};
    for (std::string line; std::getline(lines, line);) EXPECT_TRUE(nlohmann::json::accept(line)) << line;
}

TEST_F(Program, a_name_of_another_kind_is_refused_with_its_proper_use) {
    EXPECT_THAT(run({"set", "shaft.angle", "3"}).errors, HasSubstr("of kind output; read it with get"));
    EXPECT_THAT(run({"get", "shaft.stop"}).errors, HasSubstr("of kind command; send it with send"));
    EXPECT_THAT(run({"force", "shaft.gains.p", "3"}).errors, HasSubstr("cannot be forced"));
    EXPECT_THAT(asked(), IsEmpty());
}

TEST_F(Program, sets_several_properties_in_one_request) {
    const Outcome outcome = run({"set", "shaft.gains.p", "1.5", "shaft.gains.i", "-0.5"});
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    EXPECT_THAT(asked(), ElementsAre("set shaft.gains.p 1.5 shaft.gains.i -0.5"));
    EXPECT_EQ(run({"set", "shaft.gains.p"}).code, 2);
    EXPECT_THAT(run({"set", "shaft.gains.p", "1", "shaft.gains.i"}).errors, HasSubstr("has no value"));
}

TEST_F(Program, a_refusal_is_the_machines_own_sentence_and_exit_code_1) {
    machine.answer("set",
                   {R"({"id": %, "ok": false, "code": "denied", "error": "an observer sets nothing"})"});
    const Outcome outcome = run({"set", "shaft.gains.p", "1"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.errors, "tappet-browse: an observer sets nothing\n");
    EXPECT_THAT(run({"set", "shaft.gains.p", "1", "--json"}).errors,
                HasSubstr("{\"error\": \"an observer sets nothing\", \"exit\": 1}"));
}

TEST_F(Program, follows_a_command_to_its_end) {
    machine.answer(
        "send",
        {R"({"id": %, "ok": true, "state": "sent"})",
         R"({"id": %, "command": "shaft.stop", "state": "executing", "time_ns": 1})",
         R"({"id": %, "command": "shaft.stop", "state": "done", "time_ns": 2, "final": true, "results": [180.5]})"});
    const Outcome outcome = run({"send", "shaft.stop", "180", "--follow"});
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    EXPECT_EQ(outcome.out, "shaft.stop: sent\nshaft.stop: executing\nshaft.stop: done [180.5]\n");
    EXPECT_THAT(asked(), ElementsAre("send shaft.stop 180"));
}

TEST_F(Program, a_command_that_is_rejected_is_exit_code_4) {
    machine.answer(
        "send", {R"({"id": %, "ok": true, "state": "sent"})",
                 R"({"id": %, "command": "shaft.stop", "state": "rejected", "time_ns": 1, "final": true})"});
    const Outcome outcome = run({"send", "shaft.stop", "180", "--follow"});
    EXPECT_EQ(outcome.code, 4);
    EXPECT_THAT(outcome.errors, HasSubstr("rejected"));
    EXPECT_EQ(run({"send", "shaft.stop", "180"}).code, 0); // success means only that it was sent
}

TEST_F(Program, calls_forces_releases_and_restarts) {
    machine.answer("call", {R"({"id": %, "ok": true, "result": 3})"});
    EXPECT_EQ(run({"call", "shaft.reset"}).out, "shaft.reset = 3\n");
    EXPECT_EQ(run({"force", "loom.lamp", "true"}).code, 0);
    EXPECT_EQ(run({"release", "loom.lamp"}).code, 0);
    EXPECT_EQ(run({"restart", "motion"}).code, 0);
    EXPECT_THAT(asked(), ElementsAre("call shaft.reset", "force loom.lamp true", "release loom.lamp",
                                     "restart motion"));
}

TEST_F(Program, prints_events_and_how_many_were_lost) {
    machine.answer(
        "subscribe",
        {R"({"id": %, "ok": true})",
         R"({"id": %, "event": "shaft.beat_up", "time_ns": 5000, "arguments": [1.5], "lost": 0})",
         R"({"id": %, "event": "shaft.beat_up", "time_ns": 6000, "arguments": [2.5], "lost": 3})"});
    const Outcome outcome = run({"events", "shaft.beat_up", "--count", "2"});
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    EXPECT_THAT(outcome.out, HasSubstr("shaft.beat_up [1.5] at 0.000005s\n"));
    EXPECT_THAT(outcome.out, HasSubstr("shaft.beat_up [2.5] at 0.000006s, 3 lost so far\n"));
    EXPECT_THAT(asked(), ElementsAre("subscribe shaft.beat_up", "unsubscribe shaft.beat_up"));
}

TEST_F(Program, watches_as_often_as_asked) {
    machine.write("shaft.angle", 1.0);
    const Outcome outcome = run({"watch", "shaft.angle", "--every", "1ms", "--count", "3"});
    EXPECT_EQ(outcome.out, "shaft.angle = 1 deg\nshaft.angle = 1 deg\nshaft.angle = 1 deg\n");
}

TEST_F(Program, a_value_that_is_always_busy_is_exit_code_5) {
    machine.hold("shaft.angle", true);
    const Outcome outcome = run({"get", "shaft.angle"});
    EXPECT_EQ(outcome.code, 5);
    EXPECT_THAT(outcome.errors, HasSubstr("try again"));
}

TEST_F(Program, without_a_machine_the_exit_code_is_3_and_the_cure_is_named) {
    machine.end();
    const Outcome outcome = run({"list"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.errors, HasSubstr("start it again"));
    const Outcome elsewhere = run_words({"list", "--directory", "/nowhere"});
    EXPECT_EQ(elsewhere.code, 3);
    EXPECT_THAT(elsewhere.errors, HasSubstr("--socket"));
}

TEST_F(Program, a_machine_that_does_not_answer_is_exit_code_5) {
    machine.answer("save", {});
    const Outcome outcome = run({"save", "--timeout", "50ms"});
    EXPECT_EQ(outcome.code, 5);
    EXPECT_THAT(outcome.errors, HasSubstr("no answer within 50 ms"));
}

TEST_F(Program, an_invalid_answer_is_reported_and_ends_nothing_else) {
    machine.answer("save", {"no JSON"});
    EXPECT_EQ(run({"save"}).code, 3);
    machine.answer("forc", {R"({"id": {}, "ok": true})"});
    const Outcome outcome = run({"force", "loom.lamp", "true"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.errors, HasSubstr("is another program at this socket?"));
}

TEST_F(Program, describes_the_machine_and_a_single_name) {
    machine.answer("counters", {R"({"id": %, "ok": true,
        "stacks": [{"activity": "fast", "bytes": 65536, "used_bytes": 4096}, {"activity": "slow", "bytes": 65536, "used_bytes": 0}],
        "held_back": [{"row": "loom.speed", "times": 3}],
        "unsent": [{"input": "can.axis.speed", "clamped": 12, "no_number": 1}, {"output": "can.cell.force", "clamped": 0, "no_number": 2}]})"});
    const Outcome machine_info = run({"info"});
    EXPECT_THAT(machine_info.out, HasSubstr("machine sample on board test"));
    EXPECT_THAT(machine_info.out, HasSubstr("you are its engineer"));
    EXPECT_THAT(machine_info.out, HasSubstr("cycles = 0"));
    EXPECT_THAT(machine_info.out, HasSubstr("stack of fast: 4096 of 65536 bytes used at most\n"));
    EXPECT_THAT(machine_info.out, Not(HasSubstr("stack of slow"))) << "in virtual time it has none";
    EXPECT_THAT(machine_info.out, HasSubstr("limits held back loom.speed 3 times\n"));
    EXPECT_THAT(machine_info.out, HasSubstr("can.axis.speed: 12 times outside its range, sent as its nearest "
                                            "bound; 1 times not a number, not sent\n"));
    EXPECT_THAT(machine_info.out,
                HasSubstr("can.cell.force: 2 times received and not a number, not passed on\n"));
    machine.answer("counters", {R"({"id": %, "ok": true})"});
    EXPECT_THAT(run({"info", "--json"}).out, HasSubstr("\"role\": \"engineer\""));
    const Outcome facet = run({"info", "loom.angle"});
    EXPECT_THAT(facet.out, HasSubstr("<- shaft.angle (stale after 4ms: hold)"));
    EXPECT_THAT(run({"tree", "shaft"}).out, HasSubstr("-> loom.angle"));
    EXPECT_THAT(run({"tree", "shaft"}).out, Not(HasSubstr("loom (Loom")));
}

TEST_F(Program, shows_what_is_forced) {
    EXPECT_EQ(run({"forced"}).out, "");
    machine.force("shaft.angle", true, 90.0);
    EXPECT_EQ(run({"forced"}).out, "shaft.angle = 90 deg   FORCED\n");
}

TEST_F(Program, help_names_every_command_and_every_exit_code) {
    const Outcome help = run({"--help"});
    EXPECT_EQ(help.code, 0);
    for (const Command& each : commands()) EXPECT_THAT(help.out, HasSubstr(std::string{each.usage}));
    EXPECT_THAT(help.out, HasSubstr("Exit codes"));
    EXPECT_THAT(run({"send", "--help"}).out, HasSubstr("--follow"));
}

} // namespace
} // namespace tappet::browser
