// The log of changes: its lines, its repair and its rotation.
#include "tests/toolchain/folder.hpp"
#include "toolchain/tools/gateway/audit.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

namespace tappet::network {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<json> rows_of(const std::filesystem::path& file) {
    std::ifstream lines{file};
    std::vector<json> rows;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) rows.push_back(json::parse(line));
    return rows;
}

std::string nothing(const Asked&) { return {}; }

TEST(Audit, holds_question_and_outcome) {
    const test::Folder folder;
    const std::string file = folder / "log";
    Audit audit{file};
    ASSERT_THAT(audit.open(nothing), IsEmpty());
    const auto number =
        audit.asked({"mary", "10.0.0.1", "saw", "set line.speed \"2\"", "{\"line.speed\": 1.5}"});
    ASSERT_NE(number, 0u);
    audit.answered(number, "done", "{\"line.speed\": 2}");
    const auto rows = rows_of(file);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0]["what"], "asked");
    EXPECT_EQ(rows[0]["user"], "mary");
    EXPECT_EQ(rows[0]["line"], "set line.speed \"2\"");
    EXPECT_EQ(rows[0]["before"]["line.speed"], 1.5);
    EXPECT_EQ(rows[1]["number"], rows[0]["number"]);
    EXPECT_EQ(rows[1]["outcome"], "done");
    EXPECT_EQ(rows[1]["after"]["line.speed"], 2);
}

TEST(Audit, answers_at_its_start_what_a_killed_gateway_left_open) {
    const test::Folder folder;
    const std::string file = folder / "log";
    std::uint64_t last = 0;
    {
        Audit killed{file};
        ASSERT_THAT(killed.open(nothing), IsEmpty());
        killed.answered(killed.asked({"mary", "10.0.0.1", "saw", "set a.b 1", {}}), "done", {});
        last = killed.asked({"john", "10.0.0.2", "saw", "set a.b 2", {}});
    }
    std::ofstream{file, std::ios::app} << "{\"time\": \"20"; // a power cut within a line
    Audit next{file};
    std::vector<std::string> asked;
    ASSERT_THAT(next.open([&](const Asked& row) {
        return asked.push_back(row.user + ": " + row.line), "{\"a.b\": 2}";
    }),
                IsEmpty());
    EXPECT_THAT(asked, ElementsAre("john: set a.b 2"));
    EXPECT_EQ(next.repaired(), 1u);
    EXPECT_GT(next.asked({"mary", "10.0.0.1", "saw", "set a.b 3", {}}), last) << "numbers go on";
    const std::string text = test::contents_of(file);
    EXPECT_THAT(
        text, testing::HasSubstr(
                  "\"outcome\": \"unknown: the gateway ended before the answer\", \"after\": {\"a.b\": 2}}"));
    Audit third{file};
    ASSERT_THAT(third.open(nothing), IsEmpty());
    EXPECT_EQ(third.repaired(), 1u) << "only the last question";
}

TEST(Audit, is_bounded_by_rotation_and_repaired_across_files) {
    const test::Folder folder;
    const std::string file = folder / "log";
    std::uint64_t open = 0;
    {
        Audit audit{file};
        ASSERT_THAT(audit.open(nothing), IsEmpty());
        open = audit.asked({"mary", "10.0.0.1", "saw", "set a.b 1", {}});
        const std::string line(4000, 'x');
        for (std::size_t i = 0; i < bounds.log_bytes / 4000 * 3; ++i) audit.note("mary", "10.0.0.1", line);
    }
    EXPECT_TRUE(std::filesystem::exists(folder / "log.2"));
    EXPECT_FALSE(std::filesystem::exists(folder / "log.4"));
    EXPECT_LT(std::filesystem::file_size(folder / "log.1"), bounds.log_bytes + 8000);
    Audit next{file};
    ASSERT_THAT(next.open(nothing), IsEmpty());
    EXPECT_EQ(next.repaired(), 1u);
    EXPECT_EQ(rows_of(file).back()["number"], open);
}

TEST(Audit, that_cannot_be_written_lets_nothing_pass) {
    Audit audit{"/nowhere/log"};
    EXPECT_THAT(audit.open(nothing), testing::HasSubstr("'/nowhere/log' cannot be written"));
    EXPECT_EQ(audit.asked({"mary", "10.0.0.1", "saw", "set a.b 1", {}}), 0u);
}

TEST(Audit, knows_what_a_line_may_change) {
    EXPECT_THAT(names_in("set a.b 1 c.d [1, 2]"), ElementsAre("a.b", "c.d"));
    EXPECT_THAT(names_in("force a.b 1"), ElementsAre("a.b"));
    EXPECT_THAT(names_in("get a.b"), IsEmpty());
    EXPECT_THAT(names_in("set a.b \"1"), IsEmpty());
    for (const char* line : {"set a 1", "execute \"do a.b\"", "send a.b", "stop a"})
        EXPECT_TRUE(is_change(line)) << line;
    for (const char* line : {"get a", "hello", "subscribe a", "nonsense", ""})
        EXPECT_FALSE(is_change(line)) << line;
}

} // namespace
} // namespace tappet::network
