// Lines of a user elsewhere, which a server runs in threads: the same output and exit codes as at the
// machine, with no other file and no other socket of this host, and an end at any time.
#include "tests/toolchain/tools/browser/outcome.hpp"
#include "tests/toolchain/tools/browser/sample_machine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

namespace tappet::browser {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using Words = std::vector<std::string>;

/// A user elsewhere: the files that come with the line, and those that come back.
struct FarUser {
    User user{"ann", "operator", "network"};
    FarFiles::Given given{};
    std::map<std::string, std::string> got{};
    std::vector<std::string> ended{};
    std::optional<Size> screen{};
    std::string black_boxes{};
    StopFlag stop{0};
    bool is_there = true;

    Outcome run(const std::string& directory, const Words& words) {
        std::ostringstream out, errors;
        FarFiles files{given, [this](const std::string& name, std::string_view part, bool last) {
                           EXPECT_LE(part.size(), FarFiles::most_in_a_part);
                           got[name] += part;
                           if (last) ended.push_back(name);
                           return is_there;
                       }};
        const int code =
            run_remote_line({words, directory, black_boxes, user, files, out, errors, stop, screen});
        return {code, out.str(), errors.str()};
    }
};

struct RemoteLines : testing::Test {
    Outcome run(const Words& words) { return user.run(machine.directory(), words); }
    Outcome local(Words words) {
        words.insert(words.end(), {"--directory", machine.directory()});
        return run_words(words);
    }
    SampleMachine machine;
    FarUser user;
};

TEST_F(RemoteLines, print_and_end_as_at_the_machine) {
    machine.write("shaft.angle", 12.5);
    for (const Words& words :
         {Words{"list"}, Words{"list", "shaft", "--json"}, Words{"get", "shaft.angle"},
          Words{"get", "shaft.angel"}, Words{"lits"}, Words{"set", "shaft.gains.p"},
          Words{"watch", "shaft.angle", "--count", "2", "--every", "1ms"}, Words{"get", "--cuont"},
          Words{"help", "set"}, Words{"--help"}, Words{"manifest"}, Words{"tree"}}) {
        const Outcome near = local(words), far = run(words);
        EXPECT_EQ(far.code, near.code) << words[0];
        EXPECT_EQ(far.out, near.out) << words[0];
        EXPECT_EQ(far.errors, near.errors) << words[0];
    }
}

TEST_F(RemoteLines, name_their_user_before_anything_else) {
    EXPECT_EQ(run({"set", "shaft.gains.p", "0.5"}).code, 0);
    EXPECT_THAT(machine.requests(),
                ElementsAre("as ann operator network", "hello", "map", "set shaft.gains.p 0.5"));
}

TEST_F(RemoteLines, are_not_run_when_the_machine_refuses_the_user) {
    machine.answer("as ", {R"({"id": %, "ok": false, "code": "denied", "error": "not this one"})"});
    const Outcome refused = run({"set", "shaft.gains.p", "0.5"});
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.errors, HasSubstr("not this one"));
    EXPECT_THAT(machine.requests(), ElementsAre("as ann operator network"));
}

TEST_F(RemoteLines, without_words_show_which_machines_are_there) {
    const Outcome one = run({});
    EXPECT_EQ(one.code, 0) << one.errors;
    EXPECT_THAT(one.out, StartsWith("sample  on "));
    const Outcome none = user.run("/nowhere", {});
    EXPECT_EQ(none.code, 3);
    EXPECT_THAT(none.errors, HasSubstr("no machine runs there; start one at its box"));
    std::ofstream{machine.directory() + "/dead.socket"};
    const Outcome two = run({});
    EXPECT_EQ(two.code, 3);
    EXPECT_THAT(two.out, HasSubstr("dead    does not answer\n"));
    EXPECT_THAT(two.out, HasSubstr("sample  on "));
}

TEST_F(RemoteLines, address_no_other_socket_and_directory) {
    for (const char* option : {"--socket", "--directory"}) {
        const Outcome refused = run({"list", option, machine.socket()});
        EXPECT_EQ(refused.code, 2);
        EXPECT_THAT(refused.errors,
                    HasSubstr(std::string{option} + " names a place on this program's own host"));
    }
    EXPECT_THAT(machine.requests(), IsEmpty());
}

TEST_F(RemoteLines, read_only_files_that_came_with_them) {
    const std::string here = machine.directory() + "/here.osd";
    std::ofstream{here} << "StateMachine M {}";
    for (const std::string& name : {here, std::string{"../here.osd"}, std::string{"/etc/passwd"}}) {
        const Outcome refused = run({"behaviour", "load", name, "loom"});
        EXPECT_EQ(refused.code, 2);
        EXPECT_THAT(refused.errors, HasSubstr("cannot be read"));
    }
    for (const std::string& each : machine.asked()) EXPECT_THAT(each, StartsWith("as "));
    user.given["behaviours/twill.osd"] = "StateMachine Twill {}";
    EXPECT_THAT(run({"behaviour", "load", "behaviours/twill.osd", "loom"}).out,
                HasSubstr("twill.osd: compiled"));
    EXPECT_THAT(machine.asked(), testing::Contains("script loom 0 \"StateMachine Twill {}\""));
}

TEST_F(RemoteLines, convert_a_file_that_came_with_them_and_write_none_here) {
    user.given["run.mcap"] = "no recording";
    EXPECT_THAT(run({"report", "convert", "run.mcap", "run.csv"}).errors, HasSubstr("'run.mcap' "));
    EXPECT_THAT(run({"report", "convert", "/etc/passwd", "run.csv"}).errors,
                HasSubstr("did not come with the line"));
    EXPECT_THAT(run({"report", "stop", machine.directory() + "/run.mcap"}).errors,
                HasSubstr("ends a recording of a program on this host"));
    EXPECT_THAT(user.got, IsEmpty());
}

TEST_F(RemoteLines, bound_what_stays_in_memory) {
    EXPECT_THAT(run({"scope", "record", "--for", "61s", "--to", "x.vcd"}).errors, HasSubstr("at most 60s"));
}

TEST_F(RemoteLines, show_black_boxes_of_their_directory_only) {
    EXPECT_THAT(run({"post-mortem", "loom-0.blackbox"}).errors, HasSubstr("no black boxes are shown here"));
    user.black_boxes = machine.directory() + "/boxes";
    std::filesystem::create_directory(user.black_boxes);
    EXPECT_THAT(run({"post-mortem", "loom-0.blackbox"}).errors, HasSubstr("there is no black box"));
    std::ofstream{user.black_boxes + "/loom-0.blackbox"} << "cut off";
    std::ofstream{machine.directory() + "/other.blackbox"} << "cut off";
    EXPECT_THAT(run({"post-mortem", "loom-0.blackbox"}).errors, HasSubstr("is not a black box"));
    for (const char* name : {"../other.blackbox", "other.blackbox", "/etc/passwd", ".", ""})
        EXPECT_THAT(run({"post-mortem", name}).errors, HasSubstr("there are loom-0.blackbox")) << name;
}

TEST_F(RemoteLines, end_at_once_when_they_are_stopped) {
    for (const Words& words :
         {Words{"watch", "shaft.angle", "--every", "3600s"}, Words{"events", "shaft.beat_up"},
          Words{"behaviour", "watch", "--every", "3600s"}}) {
        user.stop = 0;
        const auto begun = std::chrono::steady_clock::now();
        std::thread stopper{[this] {
            std::this_thread::sleep_for(std::chrono::milliseconds{200});
            user.stop = 1;
        }};
        EXPECT_EQ(run(words).code, 0) << words[0];
        stopper.join();
        EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds{5}) << words[0];
    }
}

TEST_F(RemoteLines, draw_on_a_screen_elsewhere_and_restore_it) {
    user.screen = Size{40, 5};
    const Outcome drawn = run({"watch", "shaft.angle", "--count", "2", "--every", "1ms"});
    EXPECT_EQ(drawn.code, 0) << drawn.errors;
    EXPECT_THAT(drawn.out, StartsWith("\x1b[?1049h"));
    EXPECT_THAT(drawn.out, testing::EndsWith(std::string{screen_ends}));
    EXPECT_THAT(drawn.out, HasSubstr("picture 2"));
    EXPECT_THAT(drawn.out, HasSubstr("q or ^C ends"));
}

TEST_F(RemoteLines, run_beside_each_other) {
    constexpr int lines = 6;
    std::vector<FarUser> users(lines);
    std::vector<Outcome> outcomes(lines);
    std::vector<std::thread> threads;
    for (std::size_t n = 0; n < lines; ++n)
        threads.emplace_back([&, n] {
            users[n].user.name = "user-" + std::to_string(n);
            for (int i = 0; i < 20; ++i)
                outcomes[n] =
                    users[n].run(machine.directory(),
                                 {"set", "shaft.gains.p", std::to_string(n) + ".5", "--timeout", "9s"});
        });
    for (std::thread& each : threads) each.join();
    for (std::size_t n = 0; n < lines; ++n)
        EXPECT_EQ(outcomes[n].out, "set: shaft.gains.p = " + std::to_string(n) + ".5\n")
            << outcomes[n].errors;
}

TEST(FarFile, reaches_its_user_in_bounded_parts_with_an_end) {
    FarUser user;
    std::size_t parts = 0;
    bool is_there = true;
    FarFiles files{{}, [&](const std::string& name, std::string_view part, bool last) {
                       ++parts;
                       user.got[name] += part;
                       if (last) user.ended.push_back(name);
                       return is_there;
                   }};
    const std::string bytes(100'000, 'x');
    ASSERT_TRUE(files.write("a.json", bytes));
    EXPECT_EQ(user.got["a.json"], bytes);
    EXPECT_THAT(user.ended, ElementsAre("a.json"));
    EXPECT_EQ(parts, 5u);
    auto growing = files.create("b.mcap");
    ASSERT_TRUE(growing);
    (*growing)->write("begin");
    EXPECT_EQ(user.got["b.mcap"], "begin") << "each part goes at once";
    is_there = false;
    (*growing)->write("more");
    EXPECT_THAT((*growing)->fault(), HasSubstr("'b.mcap' did not reach its user"));
    EXPECT_FALSE((*growing)->finish());
    EXPECT_THAT(user.ended, ElementsAre("a.json")) << "what was cut off has no end";
}

} // namespace
} // namespace tappet::browser
