// Users, passwords, lock-out and sessions.
#include "tests/toolchain/folder.hpp"
#include "toolchain/tools/gateway/access.hpp"
#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/user_command.hpp"

#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <functional>
#include <sstream>
#include <utility>

#include <sys/stat.h>

namespace tappet::network {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using namespace std::chrono_literals;

/// A user whose password costs little to check.
User cheap(std::string_view name, Role role, std::string_view password) {
    User user{std::string{name}, role, Cost{2, 1, 1}, std::string(16, 's'), {}};
    user.hash = scrypt(password, user.salt, user.cost);
    return user;
}

TEST(Users, are_read_as_they_were_written) {
    const test::Folder folder;
    const std::string file = folder / "users";
    Users users;
    users.put(cheap("mary", Role::engineer, "a long password"));
    users.put(cheap("j.doe-2", Role::observer, "another password"));
    ASSERT_THAT(users.write(file), IsEmpty());
    struct stat state{};
    ASSERT_EQ(::stat(file.c_str(), &state), 0);
    EXPECT_EQ(state.st_mode & 0777, 0600u);
    const auto read = Users::read(file);
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(read->all(), users.all());
}

TEST(Users, are_refused_where_others_may_read_them) {
    const test::Folder folder;
    const std::string file = folder / "users";
    ASSERT_THAT(Users{}.write(file), IsEmpty());
    ASSERT_EQ(::chmod(file.c_str(), 0640), 0);
    EXPECT_THAT(Users::read(file).error(), HasSubstr("chmod 600"));
}

TEST(Users, are_refused_with_the_line_and_the_fault) {
    const std::string good = cheap("mary", Role::engineer, "a long password").name;
    const auto fault = [](std::string_view text) { return Users::parse(text).error(); };
    EXPECT_THAT(fault("# a comment\n\nmary engineer\n"), HasSubstr("line 3: is not `name role"));
    Users one;
    one.put(cheap("mary", Role::engineer, "a long password"));
    const std::string line = one.text().substr(one.text().find('\n') + 1);
    EXPECT_THAT(fault(line + line), HasSubstr("line 2: 'mary' stands there twice"));
    const auto with = [&](std::string_view from, std::string_view to) {
        std::string changed = line;
        return changed.replace(changed.find(from), from.size(), to);
    };
    EXPECT_THAT(fault(with("engineer", "root")), HasSubstr("role"));
    EXPECT_THAT(fault(with("mary", "Mary")), HasSubstr("a user's name"));
    EXPECT_THAT(fault(with("scrypt 2 1 1", "scrypt 3 1 1")), HasSubstr("cost"));
    EXPECT_THAT(fault(with("scrypt 2 1 1", "scrypt 1073741824 8 1")), HasSubstr("cost"));
    EXPECT_THAT(fault(with(to_base64(std::string(16, 's')), "c3M=")), HasSubstr("cut off"));
}

TEST(UserCommand, adds_lists_changes_and_removes) {
    const test::Folder folder;
    const std::string file = folder / "users";
    const auto run = [&](std::vector<std::string_view> words, const std::string& typed = {}) {
        std::istringstream in{typed};
        std::ostringstream out, errors;
        const int code = run_user_command(words, file, in, out, errors);
        return std::to_string(code) + " " + out.str() + errors.str();
    };
    EXPECT_THAT(run({"add", "mary", "engineer"}, "short\nshort\n"),
                HasSubstr("a password has 10 to 128 bytes, this one has 5"));
    EXPECT_THAT(run({"add", "mary", "engineer"}, "a long password\nanother password\n"), HasSubstr("differ"));
    EXPECT_THAT(run({"add", "mary", "root"}, "a long password\na long password\n"), HasSubstr("is no role"));
    EXPECT_THAT(run({"add", "mary", "engineer"}, "a long password\na long password\n"),
                testing::StartsWith("0"));
    EXPECT_THAT(run({"add", "mary", "engineer"}), HasSubstr("is there already"));
    EXPECT_EQ(run({"list"}), "0 mary engineer\n");
    const std::string before = test::contents_of(file);
    EXPECT_THAT(run({"password", "mary"}, "another password\nanother password\n"), testing::StartsWith("0"));
    EXPECT_NE(test::contents_of(file), before);
    EXPECT_THAT(run({"remove", "john"}), HasSubstr("there is no user 'john'"));
    EXPECT_THAT(run({"remove", "mary"}), testing::StartsWith("0"));
    EXPECT_EQ(run({"list"}), "0 ");
    EXPECT_THAT(run({"delete", "mary"}), HasSubstr("user add NAME"));
}

/// A prompt at which somebody takes long: meanwhile something else happens.
struct SlowPrompt : std::streambuf {
    SlowPrompt(std::string what, std::function<void()> then)
        : typed{std::move(what)}, meanwhile{std::move(then)} {}
    int_type underflow() override {
        if (!meanwhile) return traits_type::eof();
        std::exchange(meanwhile, {})();
        setg(typed.data(), typed.data(), typed.data() + typed.size());
        return traits_type::to_int_type(typed.front());
    }
    std::string typed;
    std::function<void()> meanwhile;
};

TEST(UserCommand, brings_nobody_back_who_was_removed_meanwhile) {
    const test::Folder folder;
    const std::string file = folder / "users";
    Users users;
    users.put(cheap("mallory", Role::engineer, "a long password"));
    users.put(cheap("bob", Role::observer, "a long password"));
    ASSERT_THAT(users.write(file), IsEmpty());
    std::ostringstream out;
    SlowPrompt prompt{"another password\nanother password\n", [&] {
                          std::istringstream nothing;
                          const std::vector<std::string_view> words{"remove", "mallory"};
                          EXPECT_EQ(run_user_command(words, file, nothing, out, out), 0);
                      }};
    std::istream in{&prompt};
    const std::vector<std::string_view> words{"password", "bob"};
    EXPECT_EQ(run_user_command(words, file, in, out, out), 0) << out.str();
    const auto left = Users::read(file);
    ASSERT_TRUE(left);
    EXPECT_EQ(left->find("mallory"), nullptr);
    EXPECT_NE(*left->find("bob"), *users.find("bob"));
}

TEST(Secrets, follow_rfc_7914) {
    EXPECT_EQ(to_hex(scrypt("password", "NaCl", {1024, 8, 16})),
              "fdbabe1c9d3472007856e7190d01e9fe7c6ad7cbc8237830e77376634b373162");
    EXPECT_FALSE(are_equal("abc", "abd"));
    EXPECT_FALSE(are_equal("abc", "ab"));
    EXPECT_TRUE(are_equal("abc", "abc"));
}

TEST(Encoding, follows_rfc_4648) {
    const std::array<std::array<std::string_view, 2>, 4> pairs{
        {{"", ""}, {"f", "Zg=="}, {"foob", "Zm9vYg=="}, {"foobar", "Zm9vYmFy"}}};
    for (const auto& [bytes, text] : pairs) {
        EXPECT_EQ(to_base64(bytes), text);
        EXPECT_EQ(from_base64(text), bytes);
    }
    for (const char* wrong : {"Zg=", "Zg", "Z===", "Zh==", "Z*==", "=Zg="})
        EXPECT_FALSE(from_base64(wrong)) << wrong;
    EXPECT_EQ(to_base64("\xff\xfe", true), "__4");
}

TEST(Encoding, reads_forms_and_cookies) {
    const auto form = from_form("user=m%61ry&password=a+b%26c&empty");
    ASSERT_TRUE(form);
    EXPECT_EQ((*form)[0].second, "mary");
    EXPECT_EQ((*form)[1].second, "a b&c");
    EXPECT_EQ((*form)[2].second, "");
    EXPECT_FALSE(from_form("a=%4"));
    EXPECT_FALSE(from_form("a=%zz"));
    EXPECT_EQ(cookie_of("a=1; tappet=x=y; b=2", "tappet"), "x=y");
    EXPECT_FALSE(cookie_of("tappet=1; tappet=2", "tappet")) << "which one is meant is unknown";
    EXPECT_FALSE(cookie_of("xtappet=1", "tappet"));
    EXPECT_EQ(in_html("<a b=\"c\">'&"), "&lt;a b=&quot;c&quot;&gt;&#39;&amp;");
    EXPECT_EQ(as_utf8("a\xffz\xc3\xa4\xed\xa0\x80"), "a?z\xc3\xa4???");
    EXPECT_EQ(cut("\xc3\xa4\xc3\xa4", 3), "\xc3\xa4");
}

TEST(Lockout, waits_after_five_failures_and_doubles) {
    Lockout lockout;
    const Clock::time_point start{};
    Clock::time_point now = start + 1h;
    for (int i = 0; i < 4; ++i) lockout.begin("mary", "10.0.0.1", now);
    EXPECT_EQ(lockout.left("mary", "10.0.0.1", now), 0s);
    lockout.begin("mary", "10.0.0.1", now);
    EXPECT_EQ(lockout.left("mary", "10.0.0.1", now), 30s);
    EXPECT_EQ(lockout.left("mary", "10.0.0.2", now), 0s) << "another place";
    EXPECT_EQ(lockout.left("john", "10.0.0.1", now), 0s) << "another user there";
    std::chrono::seconds expected = 30s;
    for (int i = 0; i < 8; ++i) {
        now += lockout.left("mary", "10.0.0.1", now);
        EXPECT_EQ(lockout.left("mary", "10.0.0.1", now), 0s);
        lockout.begin("mary", "10.0.0.1", now);
        expected = std::min<std::chrono::seconds>(2 * expected, 15min);
        EXPECT_EQ(lockout.left("mary", "10.0.0.1", now), expected);
    }
}

TEST(Lockout, of_an_address_counts_all_names_and_a_success_frees_no_other) {
    Lockout lockout;
    const Clock::time_point now{1h};
    for (int i = 0; i < 20; ++i) lockout.begin("guess" + std::to_string(i), "10.0.0.1", now);
    EXPECT_GE(lockout.left("anyone", "10.0.0.1", now), 30s);
    EXPECT_EQ(lockout.left("anyone", "10.0.0.2", now), 0s);
    for (int i = 0; i < 20; ++i)
        lockout.begin("guess" + std::to_string(i), "2001:db8::" + std::to_string(i + 1), now);
    EXPECT_GE(lockout.left("anyone", "2001:db8::ffff", now), 30s) << "one network of one person";
    lockout.begin("mary", "10.0.0.3", now);
    lockout.succeed("mary", "10.0.0.3");
    for (int i = 0; i < 4; ++i) lockout.begin("mary", "10.0.0.3", now);
    EXPECT_EQ(lockout.left("mary", "10.0.0.3", now), 0s);
}

TEST(Lockout, keeps_a_bounded_number) {
    Lockout lockout;
    const Clock::time_point now{1h};
    for (int i = 0; i < 5; ++i) lockout.begin("mary", "10.0.0.1", now);
    for (std::size_t i = 0; i < 2 * bounds.failures_kept; ++i)
        lockout.begin("x", "10.1.0." + std::to_string(i), now + 1s);
    EXPECT_LE(lockout.size(), bounds.failures_kept);
    EXPECT_GT(lockout.left("mary", "10.0.0.1", now), 0s) << "a flood of others frees nobody";
}

TEST(Sessions, end_by_idling_by_age_and_by_order) {
    Sessions sessions;
    const Clock::time_point start{1h};
    const std::string token = sessions.begin({"mary", Role::engineer}, start);
    EXPECT_GE(token.size(), 43u) << "256 bits";
    EXPECT_EQ(sessions.find(token, start + 29min)->user, "mary");
    EXPECT_TRUE(sessions.find(token, start + 58min));
    EXPECT_FALSE(sessions.find(token, start + 89min));
    const std::string used = sessions.begin({"mary", Role::engineer}, start);
    for (auto at = start; at < start + 12h; at += 20min) EXPECT_TRUE(sessions.find(used, at));
    EXPECT_FALSE(sessions.find(used, start + 12h + 1s));
    const std::string other = sessions.begin({"mary", Role::engineer}, start);
    sessions.end(other);
    EXPECT_FALSE(sessions.find(other, start));
    EXPECT_FALSE(sessions.find("", start));
}

TEST(Sessions, of_a_user_are_bounded) {
    Sessions sessions;
    const Clock::time_point start{1h};
    const std::string first = sessions.begin({"mary", Role::engineer}, start);
    const std::string foreign = sessions.begin({"john", Role::observer}, start);
    for (std::size_t i = 0; i < bounds.sessions_of_user; ++i)
        static_cast<void>(sessions.begin({"mary", Role::engineer}, start + 1s));
    EXPECT_FALSE(sessions.find(first, start + 1s));
    EXPECT_TRUE(sessions.find(foreign, start + 1s));
}

class Doors : public testing::Test {
protected:
    Doors() {
        users.put(cheap("mary", Role::engineer, "a long password"));
        EXPECT_THAT(users.write(file), IsEmpty());
        access.emplace(file, users);
    }
    std::expected<Access::Admitted, std::string> login(std::string_view user, std::string_view password) {
        const auto attempt = access->begin(user, password, "10.0.0.1", now);
        if (!attempt) return std::unexpected(attempt.error());
        return access->finish(*attempt, attempt->matches(), now);
    }
    test::Folder folder{};
    std::string file = folder / "users";
    Users users{};
    std::optional<Access> access{};
    Clock::time_point now{1h};
};

TEST_F(Doors, open_by_the_right_password_only) {
    const auto admitted = login("mary", "a long password");
    ASSERT_TRUE(admitted) << admitted.error();
    EXPECT_EQ(access->find(admitted->token, now), (LoggedIn{"mary", Role::engineer}));
    EXPECT_EQ(login("mary", "a wrong password").error(), login("john", "a long password").error())
        << "a name is no secret to find out";
    EXPECT_FALSE(login("mary", ""));
    EXPECT_FALSE(login("", ""));
    EXPECT_FALSE(login("mary", std::string(1000, 'x')));
}

TEST_F(Doors, count_many_attempts_at_once) {
    std::vector<Attempt> begun;
    for (int i = 0; i < 20; ++i)
        if (auto attempt = access->begin("mary", "guess", "10.0.0.1", now))
            begun.push_back(std::move(*attempt));
    EXPECT_EQ(begun.size(), bounds.failures) << "no more than that before the first answer";
    EXPECT_THAT(login("mary", "a long password").error(), HasSubstr("try again in 30 s"));
}

TEST_F(Doors, close_for_who_is_removed_or_changed) {
    const std::string token = login("mary", "a long password")->token;
    access->remember("mary", "a long password", token);
    EXPECT_TRUE(access->remembered("mary", "a long password", "10.0.0.1", now));
    EXPECT_FALSE(access->remembered("mary", "another password", "10.0.0.1", now));
    EXPECT_THAT(access->refresh(), IsEmpty());
    EXPECT_TRUE(access->lasts(token, now));
    users.put(cheap("mary", Role::observer, "a long password"));
    ASSERT_THAT(users.write(file), IsEmpty());
    EXPECT_THAT(access->refresh(), IsEmpty());
    EXPECT_FALSE(access->lasts(token, now));
    EXPECT_FALSE(access->remembered("mary", "a long password", "10.0.0.1", now));
    EXPECT_EQ(login("mary", "a long password")->who.role, Role::observer);
}

TEST_F(Doors, stay_as_they_are_while_the_file_is_wrong) {
    const std::string token = login("mary", "a long password")->token;
    std::ofstream{file} << "half a li";
    EXPECT_THAT(access->refresh(), HasSubstr("the users stay as they were"));
    EXPECT_THAT(access->refresh(), IsEmpty()) << "said once";
    EXPECT_TRUE(access->lasts(token, now));
}

TEST_F(Doors, close_when_a_file_that_could_not_be_read_is_readable_again) {
    const std::string token = login("mary", "a long password")->token;
    users.remove("mary");
    ASSERT_THAT(users.write(file), IsEmpty());
    ASSERT_EQ(::chmod(file.c_str(), 0644), 0);
    EXPECT_THAT(access->refresh(), HasSubstr("chmod 600"));
    EXPECT_TRUE(access->lasts(token, now));
    ASSERT_EQ(::chmod(file.c_str(), 0600), 0);
    EXPECT_THAT(access->refresh(), IsEmpty());
    EXPECT_FALSE(access->lasts(token, now));
}

TEST_F(Doors, open_by_no_remembered_password_at_a_locked_address) {
    access->remember("mary", "a long password", login("mary", "a long password")->token);
    for (unsigned i = 0; i < bounds.failures; ++i) EXPECT_FALSE(login("mary", "a wrong password"));
    EXPECT_FALSE(access->remembered("mary", "a long password", "10.0.0.1", now));
    EXPECT_TRUE(access->remembered("mary", "a long password", "10.0.0.2", now)) << "Prometheus is elsewhere";
}

TEST_F(Doors, stay_open_for_a_login_that_could_not_be_checked) {
    for (unsigned i = 0; i < 3 * bounds.failures; ++i) {
        const auto attempt = access->begin("mary", "a long password", "10.0.0.1", now);
        ASSERT_TRUE(attempt) << attempt.error();
        access->cancel(*attempt);
    }
    EXPECT_TRUE(login("mary", "a long password"));
}

} // namespace
} // namespace tappet::network
