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
    EXPECT_EQ(synced, (std::vector<std::string>{path + ".new", directory}));
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

TEST_F(ReplaceFile, refuses_a_missing_directory) {
    EXPECT_FALSE(replace_file((directory + "/no/where").c_str(), "new"));
}

} // namespace
} // namespace tappet::os
