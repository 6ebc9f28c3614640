// The messages of init, and the file that keeps them.
#include "board/box/voice.hpp"

#include "tests/toolchain/folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tappet::box {
namespace {

struct AVoice : testing::Test {
    test::Folder folder;
    std::string file = folder / "box.log";
    std::string kept() const { return test::contents_of(file); }
};

TEST_F(AVoice, keeps_messages_from_before_and_after_its_file_opened) {
    Voice voice;
    voice.say("first");
    ASSERT_TRUE(voice.keep_in(file));
    voice.say("second");
    voice.let_go();
    EXPECT_THAT(kept(), testing::MatchesRegex("init: .*first\ninit: .*second\n"));
    voice.say("nobody keeps this");
}

TEST_F(AVoice, does_not_wait_for_a_hung_disk) {
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0); // nobody reads it: when it is full its writer blocks
    const int reader = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    Voice voice;
    ASSERT_TRUE(voice.keep_in(file));
    const auto began = std::chrono::steady_clock::now();
    for (int i = 0; i < 20'000; ++i)
        voice.say("the power button ends it, and the machine is to stop before this is kept");
    voice.let_go();
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds{60})
        << "but it would wait for ever";
    ::close(reader);
}

} // namespace
} // namespace tappet::box
