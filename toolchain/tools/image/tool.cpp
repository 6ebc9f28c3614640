// SPDX-License-Identifier: Apache-2.0
#include "toolchain/tools/image/tool.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include <sys/wait.h>
#include <unistd.h>

namespace tappet::image {

namespace {

[[noreturn]] void become(const std::vector<std::string>& words, int output) {
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::setenv("SOURCE_DATE_EPOCH", standing_clock, 1);
    ::setenv("E2FSPROGS_FAKE_TIME", standing_clock, 1);
    ::setenv("TZ", "UTC", 1);
    ::setenv("LC_ALL", "C", 1);
    ::setenv("PATH", "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", 1); // for sgdisk: sbin
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    ::dprintf(STDERR_FILENO, "%s", std::strerror(errno));
    ::_exit(127);
}

} // namespace

std::string run_tool(const std::vector<std::string>& words, Trouble trouble) {
    int ends[2];
    if (::pipe(ends) != 0) throw Fault("no pipe is left to run " + words[0]);
    const pid_t pid = ::fork();
    if (pid == 0) {
        ::close(ends[0]);
        become(words, ends[1]);
    }
    ::close(ends[1]);
    std::string said;
    std::array<char, 4096> piece{};
    for (ssize_t count = 0; (count = ::read(ends[0], piece.data(), piece.size())) > 0;)
        said.append(piece.data(), static_cast<std::size_t>(count));
    ::close(ends[0]);
    int status = 0;
    ::waitpid(pid, &status, 0);
    if (trouble == Trouble::is_a_fault && (!WIFEXITED(status) || WEXITSTATUS(status) != 0))
        throw Fault(words[0] + " failed: " + (said.empty() ? "without a message" : said) +
                    (WIFEXITED(status) && WEXITSTATUS(status) == 127 ? "; run ci/setup once as root" : ""));
    return said;
}

std::string read_file(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    if (!file) throw Fault("cannot read " + path.string() + "; build it first, or run ci/setup once as root");
    return {std::istreambuf_iterator<char>{file}, {}};
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    std::ofstream file{path, std::ios::binary};
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file.flush())
        throw Fault("cannot write " + path.string() + "; check the folder's rights and the space");
}

} // namespace tappet::image
