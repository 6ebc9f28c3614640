// Limits, Landlock, capabilities and seccomp (see landlock(7), seccomp(2)).
#include "toolchain/tools/gateway/sandbox.hpp"

#include "toolchain/tools/gateway/bounds.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>

#include <fcntl.h>
#include <linux/capability.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tappet::network {

namespace {

// clang-format off
/// The calls of the kernel that the gateway makes after its start. Every other one fails with EPERM.
constexpr std::array calls{
    // sockets that exist, and those to machines
    SCMP_SYS(accept4), SCMP_SYS(accept), SCMP_SYS(connect), SCMP_SYS(recvfrom), SCMP_SYS(recvmsg), SCMP_SYS(sendto), SCMP_SYS(sendmsg),
    SCMP_SYS(shutdown), SCMP_SYS(getsockopt), SCMP_SYS(setsockopt), SCMP_SYS(getsockname), SCMP_SYS(getpeername),
    SCMP_SYS(poll), SCMP_SYS(ppoll), SCMP_SYS(epoll_wait), SCMP_SYS(epoll_pwait), SCMP_SYS(epoll_ctl), SCMP_SYS(epoll_create1),
    SCMP_SYS(eventfd2), SCMP_SYS(timerfd_create), SCMP_SYS(timerfd_settime), SCMP_SYS(timerfd_gettime), SCMP_SYS(ioctl), SCMP_SYS(fcntl),
    // files within Landlock's folders
    SCMP_SYS(read), SCMP_SYS(readv), SCMP_SYS(pread64), SCMP_SYS(write), SCMP_SYS(writev), SCMP_SYS(pwrite64), SCMP_SYS(close),
    SCMP_SYS(open), SCMP_SYS(openat), SCMP_SYS(stat), SCMP_SYS(lstat), SCMP_SYS(fstat), SCMP_SYS(newfstatat), SCMP_SYS(statx), SCMP_SYS(lseek),
    SCMP_SYS(getdents64), SCMP_SYS(rename), SCMP_SYS(renameat), SCMP_SYS(renameat2), SCMP_SYS(unlink), SCMP_SYS(unlinkat),
    SCMP_SYS(fsync), SCMP_SYS(fdatasync), SCMP_SYS(ftruncate), SCMP_SYS(access), SCMP_SYS(faccessat), SCMP_SYS(readlink), SCMP_SYS(readlinkat),
    // memory; never executable: see below
    SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(brk), SCMP_SYS(madvise),
    // threads, time, random numbers, the end
    SCMP_SYS(futex), SCMP_SYS(set_robust_list), SCMP_SYS(rseq), SCMP_SYS(sched_yield), SCMP_SYS(sched_getaffinity), SCMP_SYS(gettid), SCMP_SYS(getpid),
    SCMP_SYS(getuid), SCMP_SYS(geteuid), SCMP_SYS(getgid), SCMP_SYS(getegid), SCMP_SYS(restart_syscall),
    SCMP_SYS(clock_gettime), SCMP_SYS(clock_nanosleep), SCMP_SYS(nanosleep), SCMP_SYS(gettimeofday), SCMP_SYS(getrandom),
    SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(sigaltstack), SCMP_SYS(exit), SCMP_SYS(exit_group)};
// clang-format on

constexpr std::uint64_t reading = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t writing =
    reading | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_REG;
constexpr std::uint64_t all_of_files = LANDLOCK_ACCESS_FS_EXECUTE | writing | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                                       LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR |
                                       LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
                                       LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;

std::string add_folder(int rules, const std::string& folder, std::uint64_t allowed) {
    landlock_path_beneath_attr row{};
    row.allowed_access = allowed;
    row.parent_fd = ::open(folder.c_str(), O_PATH | O_CLOEXEC | O_DIRECTORY);
    if (row.parent_fd < 0) return "'" + folder + "' cannot be opened: " + std::strerror(errno);
    const long added = ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &row, 0);
    const int error = errno;
    ::close(row.parent_fd);
    return added == 0 ? "" : "'" + folder + "': " + std::strerror(error);
}

/// Returns the error; `missing`: the kernel has no Landlock.
std::string confine_files(const Sandbox& sandbox, bool& missing) {
    landlock_ruleset_attr all{};
    all.handled_access_fs = all_of_files;
    const long made = ::syscall(SYS_landlock_create_ruleset, &all, sizeof all, 0);
    missing = made < 0 && (errno == ENOSYS || errno == EOPNOTSUPP);
    if (made < 0) return missing ? "" : std::string{"Landlock refuses its rules: "} + std::strerror(errno);
    const int rules = static_cast<int>(made);
    std::string fault;
    for (const std::string& folder : sandbox.readable)
        if (fault.empty()) fault = add_folder(rules, folder, reading);
    for (const std::string& folder : sandbox.writable)
        if (fault.empty()) fault = add_folder(rules, folder, writing);
    if (fault.empty() && ::syscall(SYS_landlock_restrict_self, rules, 0) != 0)
        fault = std::string{"Landlock: "} + std::strerror(errno);
    ::close(rules);
    return fault;
}

std::string confine_calls() {
    const std::unique_ptr<void, decltype(&seccomp_release)> filter{seccomp_init(SCMP_ACT_ERRNO(EPERM)),
                                                                   &seccomp_release};
    if (filter == nullptr) return "seccomp has no memory";
    int error = seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_TSYNC, 1);
    const auto allow = [&](int call, auto... conditions) {
        if (error == 0)
            error =
                seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, sizeof...(conditions), conditions...);
    };
    for (const int call : calls) allow(call);
    // New sockets go to machines only; new memory runs no code; new threads, but no process.
    allow(SCMP_SYS(socket), scmp_arg_cmp{0, SCMP_CMP_EQ, AF_UNIX, 0});
    for (const int call : {SCMP_SYS(mmap), SCMP_SYS(mprotect)})
        allow(call, scmp_arg_cmp{2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0});
    constexpr std::uint64_t thread = 0x00010000; // CLONE_THREAD
    allow(SCMP_SYS(clone), scmp_arg_cmp{0, SCMP_CMP_MASKED_EQ, thread, thread});
    // glibc asks for clone3 first, whose flags a filter cannot see, and takes clone when it is unknown.
    if (error == 0) error = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
    // abort() signals the own process; no other one is signalled.
    allow(SCMP_SYS(tgkill), scmp_arg_cmp{0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(::getpid()), 0});
    // Its own limits may be read, not raised.
    allow(SCMP_SYS(prlimit64), scmp_arg_cmp{2, SCMP_CMP_EQ, 0, 0});
    if (error == 0) error = seccomp_load(filter.get());
    return error == 0 ? "" : std::string{"seccomp: "} + std::strerror(-error);
}

std::string drop_capabilities() {
    for (int capability = 0; ::prctl(PR_CAPBSET_READ, capability, 0, 0, 0) >= 0; ++capability)
        static_cast<void>(::prctl(PR_CAPBSET_DROP, capability, 0, 0, 0)); // only who has some can drop some
    static_cast<void>(::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0));
    __user_cap_header_struct head{_LINUX_CAPABILITY_VERSION_3, 0};
    std::array<__user_cap_data_struct, 2> none{};
    return ::syscall(SYS_capset, &head, none.data()) == 0
               ? ""
               : std::string{"capabilities: "} + std::strerror(errno);
}

bool limit(__rlimit_resource what, rlim_t most) {
    rlimit now{};
    if (::getrlimit(what, &now) != 0) return false;
    const rlim_t value = std::min(most, now.rlim_max);
    const rlimit wanted{value, value};
    return ::setrlimit(what, &wanted) == 0;
}

std::string step_back(const Sandbox& sandbox) {
    sched_param ordinary{};
    if (::sched_setscheduler(0, SCHED_OTHER, &ordinary) != 0 || ::setpriority(PRIO_PROCESS, 0, 10) != 0)
        return std::string{"its priority: "} + std::strerror(errno);
    if (sandbox.processors.empty()) return {};
    cpu_set_t set;
    CPU_ZERO(&set);
    for (const unsigned each : sandbox.processors) CPU_SET(each, &set);
    return ::sched_setaffinity(0, sizeof set, &set) == 0
               ? ""
               : std::string{"--processors: "} + std::strerror(errno);
}

} // namespace

std::expected<std::vector<std::string>, std::string> apply(const Sandbox& sandbox) {
    const auto unsafe = [](const std::string& what) {
        return std::unexpected("the gateway cannot confine itself, " + what);
    };
    if (const std::string fault = step_back(sandbox); !fault.empty()) return unsafe(fault);
    if (!limit(RLIMIT_NOFILE, bounds.descriptors) || !limit(RLIMIT_AS, bounds.memory_bytes) ||
        !limit(RLIMIT_CORE, 0))
        return unsafe(std::string{"its limits: "} + std::strerror(errno));
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || ::prctl(PR_SET_DUMPABLE, 0, 0, 0, 0) != 0)
        return unsafe(std::string{"no_new_privs: "} + std::strerror(errno));
    std::vector<std::string> without;
    bool missing = false;
    if (const std::string fault = confine_files(sandbox, missing); !fault.empty()) return unsafe(fault);
    if (missing) without.emplace_back("Landlock");
    if (const std::string fault = drop_capabilities(); !fault.empty()) return unsafe(fault);
    if (const std::string fault = confine_calls(); !fault.empty()) return unsafe(fault);
    return without;
}

std::expected<std::vector<unsigned>, std::string> processors_from(std::string_view text) {
    std::vector<unsigned> all;
    const auto wrong = std::unexpected("--processors: \"" + std::string{text} +
                                       "\" is no list of processors; write for example 0,2-3");
    while (!text.empty()) {
        const std::string_view part = text.substr(0, text.find(','));
        text.remove_prefix(std::min(text.size(), part.size() + 1));
        unsigned from = 0;
        const auto first = std::from_chars(part.data(), part.data() + part.size(), from);
        unsigned to = from;
        const char* end = first.ptr;
        if (end != part.data() + part.size() && *end == '-') {
            const auto last = std::from_chars(end + 1, part.data() + part.size(), to);
            if (last.ec != std::errc{}) return wrong;
            end = last.ptr;
        }
        if (first.ec != std::errc{} || end != part.data() + part.size() || to < from || to >= CPU_SETSIZE)
            return wrong;
        for (unsigned each = from; each <= to; ++each) all.push_back(each);
    }
    return all.empty() ? std::expected<std::vector<unsigned>, std::string>{wrong} : all;
}

} // namespace tappet::network
