// A line typed at the browser on a running machine: from the command line through the socket into the engine
// and back to the exit code (thesis 3.4.6, 4.8).
#include "tests/kernel/services/interpreter/line_rig.hpp"
#include "tests/toolchain/tools/browser/outcome.hpp"

#include <atomic>
#include <thread>

namespace tappet::press {
namespace {

using browser::Outcome;
using testing::HasSubstr;
using testing::IsEmpty;

/// The machine's time runs in a thread of its own, while the program waits for answers.
class Execute : public Lines {
protected:
    void SetUp() override {
        Lines::SetUp();
        interpreter().longest.set(24h); // in the machine's time, which runs fast
        time = std::thread{[this] {
            while (!is_over) {
                run(10ms);
                std::this_thread::yield();
            }
        }};
    }
    ~Execute() override {
        is_over = true;
        time.join();
    }
    Outcome type(std::vector<std::string> words, browser::StopFlag* signal = nullptr) {
        words.insert(words.begin(), {"--socket", path(), "--timeout", "60s"});
        return browser::run_words(words, signal);
    }
    std::atomic<bool> is_over{false};
    std::thread time;
};

TEST_F(Execute, prints_a_value_or_done) {
    EXPECT_EQ(type({"execute", "gauge.force * 2 + 1"}).out, "26\n");
    EXPECT_EQ(type({"execute", "gauge.all_homed()"}).out, "true\n");
    EXPECT_EQ(type({"execute", "set gauge.target = 35.0"}).out, "done\n");
    EXPECT_EQ(type({"execute", "gauge.target", "*", "2"}).out, "70\n") << "words are a line as well";
    EXPECT_EQ(type({"execute", "var int stroke; do ram.move_to(20, stroke)"}).out, "stroke = 1\n");
    EXPECT_EQ(type({"execute", "\"a \\\"text\\\"\""}).out, "\"a \\\"text\\\"\"\n");
    EXPECT_THAT(type({"execute", "1 + 1", "--json"}).out, HasSubstr(R"("final":true,"value":2})"));
}

TEST_F(Execute, ends_with_the_exit_code_of_the_failure) {
    const Outcome refused = type({"execute", "gauge.forse"});
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.errors, HasSubstr(R"(line:1:7: "gauge" has no "forse"; did you mean "force"?)"));
    const Outcome failed = type({"execute", "var int n; do ram.move_to(-1, n)"});
    EXPECT_EQ(failed.code, 4);
    EXPECT_THAT(failed.out, IsEmpty());
    EXPECT_THAT(failed.errors, HasSubstr(R"(line:1:12: "ram.move_to" was rejected)"));
    EXPECT_THAT(type({"execute", "1 +\n2"}).errors, HasSubstr("a line has no breaks"));
    EXPECT_EQ(type({"execute"}).code, 2);
    EXPECT_EQ(type({"execute", "1", "--stop"}).code, 2);
}

TEST_F(Execute, cancels_a_line_on_a_signal_and_on_request) {
    browser::StopFlag signal{SIGINT};
    const Outcome ended = type({"execute", "wait gauge.force > 1000"}, &signal);
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.errors, HasSubstr("it was broken off"));
    EXPECT_EQ(type({"execute", "--stop"}).code, 1) << "none is at work";
    Outcome waited;
    std::thread waits{[&] { waited = type({"execute", "wait gauge.force > 1000"}); }};
    while (type({"execute", "--stop"}).code != 0) std::this_thread::yield();
    waits.join();
    EXPECT_THAT(waited.errors, HasSubstr("it was broken off"));
}

} // namespace
} // namespace tappet::press
