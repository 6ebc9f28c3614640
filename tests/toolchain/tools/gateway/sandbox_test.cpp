// The confined process: what it can still do, and what it cannot.
#include "tests/toolchain/folder.hpp"
#include "toolchain/tools/gateway/sandbox.hpp"

#include <gmock/gmock.h>

#include <cerrno>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::network {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Runs the check in a confined child; returns its exit code, which is the number of the first check that
/// failed.
template <class Check> int confined(const Sandbox& sandbox, Check&& check) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(apply(sandbox) ? check() : 99);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool opens(const std::string& path, int flags) {
    const int file = ::open(path.c_str(), flags | O_CLOEXEC, 0600);
    if (file >= 0) ::close(file);
    return file >= 0;
}

TEST(Sandbox, leaves_only_its_folders) {
    const test::Folder readable, writable, other;
    std::ofstream{readable / "a"} << "text";
    std::ofstream{other / "a"} << "text";
    const int failed = confined({{readable.string()}, {writable.string()}, {}}, [&] {
        if (!opens(readable / "a", O_RDONLY)) return 1;
        if (opens(readable / "a", O_WRONLY)) return 2;
        if (opens(readable / "b", O_WRONLY | O_CREAT)) return 3;
        if (!opens(writable / "b", O_WRONLY | O_CREAT)) return 4;
        if (::rename((writable / "b").c_str(), (writable / "c").c_str()) != 0) return 5;
        if (opens(other / "a", O_RDONLY)) return 6;
        if (opens("/etc/passwd", O_RDONLY)) return 7;
        return 0;
    });
    EXPECT_EQ(failed, 0);
}

TEST(Sandbox, leaves_no_other_program_process_or_network) {
    const int failed = confined({}, [] {
        char program[] = "/bin/true";
        char* words[] = {program, nullptr};
        ::execve(program, words, words);
        if (::fork() >= 0) return 1;
        if (::socket(AF_INET, SOCK_STREAM, 0) >= 0) return 2;
        const int local = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
        if (local < 0) return 3;
        if (::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED)
            return 4;
        if (::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED)
            return 5;
        if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0) return 6;
        if (::setuid(0) == 0 || ::kill(::getppid(), 0) == 0) return 7;
        const pid_t parent = ::getppid();
        if (::syscall(SYS_tgkill, parent, parent, 0) == 0 || ::syscall(SYS_tkill, parent, 0) == 0) return 11;
        if (::syscall(SYS_tgkill, ::getpid(), ::gettid(), 0) != 0) return 12;
        if (::listen(local, 1) == 0) return 8;
        const rlimit more{4096, 4096};
        if (::setrlimit(RLIMIT_NOFILE, &more) == 0) return 9;
        bool ran = false;
        std::thread{[&] { ran = true; }}.join();
        return ran ? 0 : 10;
    });
    EXPECT_EQ(failed, 0);
}

TEST(Sandbox, limits_descriptors_and_memory) {
    const int failed = confined({}, [] {
        int last = 0;
        int count = 0;
        for (; count < 5000 && last >= 0; ++count) last = ::fcntl(0, F_DUPFD_CLOEXEC, 3);
        if (count > 1100) return 1;
        if (::mmap(nullptr, std::size_t{2} << 30, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1,
                   0) != MAP_FAILED)
            return 2;
        return 0;
    });
    EXPECT_EQ(failed, 0);
}

TEST(Sandbox, steps_back_behind_the_machine) {
    const int failed = confined({{}, {}, {0}}, [] {
        cpu_set_t set;
        if (::sched_getaffinity(0, sizeof set, &set) != 0 || CPU_COUNT(&set) != 1 || !CPU_ISSET(0, &set))
            return 1;
        return 0;
    });
    EXPECT_EQ(failed, 0);
}

TEST(Sandbox, refuses_to_go_on_without_a_folder) {
    const pid_t child = ::fork();
    if (child == 0) {
        const auto applied = apply({{"/nowhere"}, {}, {}});
        ::_exit(!applied && applied.error().contains("'/nowhere'") ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
}

TEST(Processors, are_read_as_a_list) {
    EXPECT_THAT(*processors_from("0,2-4"), ElementsAre(0u, 2u, 3u, 4u));
    for (const char* wrong : {"", "a", "1-", "3-2", "1,,2", "0-5000", "1 2"})
        EXPECT_FALSE(processors_from(wrong)) << wrong;
}

} // namespace
} // namespace tappet::network
