// A file is replaced atomically, and stays replaced after a power failure.
#include "kernel/os/terminal.hpp"

#include "tests/kernel/os/folder.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

std::vector<std::string> synced;
bool disk_fails = false;

} // namespace

/// Replaces the library's function: records what was flushed to the disk, or fails.
extern "C" int fsync(int file) {
    std::error_code none;
    synced.push_back(std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(file), none));
    if (disk_fails) errno = EIO;
    return disk_fails ? -1 : static_cast<int>(syscall(SYS_fsync, file));
}

namespace tappet::os {
namespace {

struct ReplaceFile : testing::Test {
    test::Folder folder;
    std::string directory = folder.path;
    std::string path = directory + "/summary.json";

    ReplaceFile() {
        std::ofstream{path} << "old";
        synced.clear();
        disk_fails = false;
    }

    [[nodiscard]] std::string contents() const {
        std::ifstream file{path};
        return {std::istreambuf_iterator<char>{file}, {}};
    }
    [[nodiscard]] std::ptrdiff_t files() const {
        std::filesystem::directory_iterator all{directory};
        return std::distance(begin(all), end(all));
    }
};

TEST_F(ReplaceFile, flushes_the_file_and_then_its_directory_to_the_disk) {
    EXPECT_TRUE(replace_file(path.c_str(), "new"));
    EXPECT_EQ(contents(), "new");
    EXPECT_EQ(files(), 1);
    EXPECT_EQ(synced, (std::vector<std::string>{path + ".tappet-new", directory}));
}

TEST_F(ReplaceFile, finds_the_directory_of_a_bare_name) {
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(directory);
    EXPECT_TRUE(replace_file("summary.json", "new"));
    std::filesystem::current_path(before);
    EXPECT_EQ(contents(), "new");
    ASSERT_EQ(synced.size(), 2u);
    EXPECT_EQ(synced[1], directory);
}

TEST_F(ReplaceFile, keeps_the_old_file_and_nothing_else_when_writing_fails) {
    disk_fails = true;
    EXPECT_FALSE(replace_file(path.c_str(), "new"));
    EXPECT_EQ(contents(), "old");
    EXPECT_EQ(files(), 1);
}

TEST_F(ReplaceFile, leaves_no_file_behind_when_the_rename_fails) {
    std::filesystem::remove(path);
    std::filesystem::create_directory(path);
    EXPECT_FALSE(replace_file(path.c_str(), "new"));
    EXPECT_EQ(files(), 1);
}

TEST_F(ReplaceFile, replaces_the_file_that_a_link_leads_to_and_keeps_the_link) {
    std::filesystem::create_symlink(path, directory + "/first");
    std::filesystem::create_symlink("first", directory + "/second");
    EXPECT_TRUE(replace_file((directory + "/second").c_str(), "new"));
    EXPECT_EQ(contents(), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(directory + "/second"));
    EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(path)));
    EXPECT_EQ(files(), 3);
}

TEST_F(ReplaceFile, refuses_a_link_to_nothing) {
    std::filesystem::create_symlink(directory + "/nothing", directory + "/link");
    EXPECT_FALSE(replace_file((directory + "/link").c_str(), "new"));
    EXPECT_TRUE(std::filesystem::is_symlink(directory + "/link"));
}

TEST_F(ReplaceFile, keeps_the_mode_of_the_file) {
    ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
    EXPECT_TRUE(replace_file(path.c_str(), "new"));
    struct stat facts{};
    ASSERT_EQ(::stat(path.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 07777, 0600u);
}

TEST_F(ReplaceFile, writes_into_a_pipe_and_a_device) {
    const std::string pipe = directory + "/pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_FALSE(replace_file(pipe.c_str(), "new")) << "nobody reads it";
    const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    EXPECT_TRUE(replace_file(pipe.c_str(), "new"));
    char got[4] = {};
    EXPECT_EQ(::read(reader, got, 3), 3);
    EXPECT_STREQ(got, "new");
    ::close(reader);
    struct stat facts{};
    ASSERT_EQ(::stat(pipe.c_str(), &facts), 0);
    EXPECT_TRUE(S_ISFIFO(facts.st_mode));
    EXPECT_TRUE(replace_file("/dev/null", "new"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(ReplaceFile, does_not_write_through_a_link_at_its_own_name) {
    std::ofstream{directory + "/victim"} << "precious";
    std::filesystem::create_symlink(directory + "/victim", path + ".tappet-new");
    EXPECT_TRUE(replace_file(path.c_str(), "new"));
    EXPECT_EQ(contents(), "new");
    std::ifstream victim{directory + "/victim"};
    EXPECT_EQ((std::string{std::istreambuf_iterator<char>{victim}, {}}), "precious");
}

TEST_F(ReplaceFile, leaves_a_users_file_beside_it_alone) {
    std::ofstream{path + ".new"} << "mine";
    EXPECT_TRUE(replace_file(path.c_str(), "new"));
    EXPECT_TRUE(std::filesystem::exists(path + ".new"));
}

TEST_F(ReplaceFile, refuses_a_missing_directory) {
    EXPECT_FALSE(replace_file((directory + "/no/where").c_str(), "new"));
}

} // namespace
} // namespace tappet::os
