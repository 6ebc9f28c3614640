// The form of a commit message: "area: what" within 72 characters, and a body that says why.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <regex>
#include <string>
#include <vector>

namespace tappet::house {
namespace {

constexpr std::size_t most_characters = 72;
/// The rule holds for commits after this one.
constexpr const char* since = "e71bbb0f7ab4";

/// Returns the fault of a message; empty: it has none.
std::string fault_of(const std::string& subject, const std::string& body) {
    static const std::regex form("[a-z][a-z0-9_, -]*: [^ ].*[^.]");
    if (!std::regex_match(subject, form)) return "its subject is not \"area: what\" without a full stop";
    if (subject.size() > most_characters)
        return "its subject has " + std::to_string(subject.size()) + " characters, at most " +
               std::to_string(most_characters) + " are read at a glance";
    if (body.find_first_not_of(" \n") == std::string::npos)
        return "it has no body: say why, what was rejected and how it was tried";
    return {};
}

struct Commit {
    std::string id, subject, body;
};

/// The separators are characters that no message contains.
std::vector<Commit> commits_since(const std::string& first, bool& known) {
    const std::string command = "git -C '" TAPPET_TREE "' log --no-merges --format='%h%x1f%s%x1f%b%x1e' " +
                                first + "..HEAD 2>/dev/null";
    std::FILE* pipe = popen(command.c_str(), "r");
    std::string text;
    std::array<char, 4096> block{};
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe))
        text.append(block.data(), n);
    known = pclose(pipe) == 0;
    std::vector<Commit> commits;
    for (std::size_t begin = 0, end = 0; (end = text.find('\x1e', begin)) != std::string::npos;
         begin = end + 2) {
        const std::string one = text.substr(begin, end - begin);
        const std::size_t a = one.find('\x1f'), b = one.find('\x1f', a + 1);
        commits.push_back({one.substr(0, a), one.substr(a + 1, b - a - 1), one.substr(b + 1)});
    }
    return commits;
}

TEST(Commits, say_where_what_and_why) {
    bool known = false;
    const auto commits = commits_since(since, known);
    if (!known) GTEST_SKIP() << "no history here that reaches back to " << since;
    for (const Commit& commit : commits)
        EXPECT_EQ(fault_of(commit.subject, commit.body), "") << commit.id << " " << commit.subject;
}

TEST(CommitsRule, refuses_subjects_without_an_area_and_empty_bodies) {
    EXPECT_EQ(fault_of("os: a thread is joined", "Why."), "");
    EXPECT_EQ(fault_of("carpet loom: the valve closes", "Why."), "");
    EXPECT_NE(fault_of("fix", "Why."), "");
    EXPECT_NE(fault_of("os: a thread is joined.", "Why."), "");
    EXPECT_NE(fault_of("os: " + std::string(69, 'x'), "Why."), "");
    EXPECT_NE(fault_of("os: a thread is joined", "\n"), "");
}

} // namespace
} // namespace tappet::house
