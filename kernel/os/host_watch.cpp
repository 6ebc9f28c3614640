// The program's own malloc family and pthread_mutex_lock pass each call on to glibc's; a system call raises
// SIGSYS and is then made by hand. Only the first use in a cycle is seen: after it, the watch is off until
// the next cycle.
#include "kernel/os/host_watch.hpp"

#include "kernel/os/crash.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <utility>

#include <cxxabi.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <pthread.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <ucontext.h>
#include <unistd.h>

extern "C" {
// glibc's own, under names that it exports for programs with a malloc of their own.
// NOLINTBEGIN(bugprone-reserved-identifier)
void* __libc_malloc(std::size_t) noexcept;
void* __libc_calloc(std::size_t, std::size_t) noexcept;
void* __libc_realloc(void*, std::size_t) noexcept;
void* __libc_memalign(std::size_t, std::size_t) noexcept;
void __libc_free(void*) noexcept;
// NOLINTEND(bugprone-reserved-identifier)
}

namespace tappet::os::host_watch {

namespace {

// The kernel reads it at each system call of the thread: 1 raises SIGSYS.
thread_local constinit volatile char raises = 0;
thread_local constinit bool watches = false;

constinit std::string_view machine{};
constinit int longest_cycle_s = 0;

struct Seen {
    std::array<Use, max_uses> uses{};
    std::size_t used = 0;
    std::uint64_t cycles = 0;
    std::string_view activity{}; ///< empty: outside of cycles
    std::uint64_t cycle = 0;     ///< number of the present or the last one
};
constinit Seen seen{};

constexpr std::size_t most_frames = 24;

/// Returns the first address at or outside of `from` on the stack that lies in the program's own code, and
/// not in a template of the standard library.
std::uintptr_t caller(void* from) noexcept {
    std::array<void*, most_frames> frames{};
    const int count = ::backtrace(frames.data(), most_frames);
    const auto end = frames.begin() + count;
    Dl_info program{}, each{};
    if (::dladdr(reinterpret_cast<void*>(&caller), &program) == 0) return 0;
    for (auto frame = std::find(frames.begin(), end, from); frame != end; ++frame) {
        if (::dladdr(*frame, &each) == 0 || each.dli_fbase != program.dli_fbase) continue;
        const std::string_view name = each.dli_sname == nullptr ? "" : each.dli_sname;
        if (!name.starts_with("_ZNSt") && !name.starts_with("_ZSt") && !name.starts_with("_ZNKSt"))
            return reinterpret_cast<std::uintptr_t>(*frame);
    }
    return 0;
}

void note(std::string_view what, void* from) noexcept {
    raises = 0;
    watches = false;
    ++seen.cycles;
    const std::uintptr_t at = caller(from);
    for (Use& use : std::span{seen.uses}.first(seen.used))
        if (use.caller == at && use.what == what) {
            ++use.cycles;
            return;
        }
    if (seen.used < max_uses) seen.uses[seen.used++] = {what, seen.activity, at, 1};
}

#ifdef __x86_64__
void* instruction_of(const mcontext_t& context) noexcept {
    return reinterpret_cast<void*>(context.gregs[REG_RIP]);
}

constexpr std::pair<long, std::string_view> names[] = {
    {SYS_read, "the system call read"},
    {SYS_write, "the system call write"},
    {SYS_open, "the system call open"},
    {SYS_close, "the system call close"},
    {SYS_poll, "the system call poll"},
    {SYS_mmap, "the system call mmap"},
    {SYS_munmap, "the system call munmap"},
    {SYS_brk, "the system call brk"},
    {SYS_ioctl, "the system call ioctl"},
    {SYS_select, "the system call select"},
    {SYS_sched_yield, "the system call sched_yield"},
    {SYS_nanosleep, "the system call nanosleep"},
    {SYS_sendto, "the system call sendto"},
    {SYS_recvfrom, "the system call recvfrom"},
    {SYS_futex, "the system call futex"},
    {SYS_openat, "the system call openat"},
    {SYS_clock_nanosleep, "the system call clock_nanosleep"},
    {SYS_epoll_wait, "the system call epoll_wait"},
    {SYS_getrandom, "the system call getrandom"},
    {SYS_writev, "the system call writev"}};

void on_system_call(int, siginfo_t* info, void* context) noexcept {
    raises = 0;
    auto& next = static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP];
    const auto name =
        std::ranges::find(names, long{info->si_syscall}, &std::pair<long, std::string_view>::first);
    if (info->si_syscall != SYS_rt_sigreturn) // of another signal's handler
        note(name != std::end(names) ? name->second : "a system call", reinterpret_cast<void*>(next));
    next -= 2; // back to the instruction `syscall`, which is now let through
}

bool see_system_calls() noexcept {
    struct sigaction action{};
    action.sa_sigaction = &on_system_call;
    action.sa_flags = SA_SIGINFO;
    return ::sigaction(SIGSYS, &action, nullptr) == 0 &&
           ::prctl(PR_SET_SYSCALL_USER_DISPATCH, PR_SYS_DISPATCH_ON, 0, 0, &raises) == 0;
}
#else
void* instruction_of(const mcontext_t& context) noexcept { return reinterpret_cast<void*>(context.pc); }
bool see_system_calls() noexcept { return false; }
#endif

void end_program(const Sentence& what, void* at) noexcept {
    Use use;
    use.caller = caller(at);
    const std::string_view in = seen.activity;
    Sentence text{machine,
                  ": ",
                  what,
                  in.empty() ? " outside of the machine's cycles" : " in activity \"",
                  in,
                  in.empty() ? ", " : "\", ",
                  place_of(use),
                  "\n"};
    static_cast<void>(::write(2, text.view().data(), text.view().size()));
}

void on_fault(int number, siginfo_t*, void* context) noexcept {
    raises = 0;
    watches = false;
    ::alarm(2); // naming the place needs the heap, which may be what is broken
    struct sigaction action{};
    action.sa_handler = SIG_DFL;
    ::sigaction(number, &action, nullptr);
    const auto& machine_context = static_cast<ucontext_t*>(context)->uc_mcontext;
    end_program(Sentence{"signal ", signal_name(number)}, instruction_of(machine_context));
    ::raise(number); // delivered when this handler returns
}

// Each second of processor time.
void on_second(int, siginfo_t*, void* context) noexcept {
    raises = 0; // this cycle's further system calls are not seen
    static constinit std::uint64_t cycle = 0;
    static constinit int seconds = 0;
    seconds = seen.activity.empty() || seen.cycle != cycle ? 0 : seconds + 1;
    cycle = seen.cycle;
    if (seconds < longest_cycle_s) return;
    const auto& machine_context = static_cast<ucontext_t*>(context)->uc_mcontext;
    end_program(Sentence{"a cycle has used ", std::int64_t{seconds}, " s of processor time and does not end"},
                instruction_of(machine_context));
    std::abort();
}

void take_faults() noexcept {
    alignas(64) static constinit std::array<std::byte, 64 * 1024> stack{}; // the thread's own may be used up
    stack_t own{};
    own.ss_sp = stack.data();
    own.ss_size = stack.size();
    ::sigaltstack(&own, nullptr);
    struct sigaction action{};
    action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_RESTART;
    action.sa_sigaction = &on_fault;
    for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) ::sigaction(number, &action, nullptr);
    action.sa_sigaction = &on_second;
    ::sigaction(SIGPROF, &action, nullptr);
    const itimerval each_second{{1, 0}, {1, 0}};
    ::setitimer(ITIMER_PROF, &each_second, nullptr);
}

} // namespace

bool prepare(std::string_view of_machine, int longest_s) noexcept {
    machine = of_machine;
    longest_cycle_s = longest_s;
    std::array<void*, 1> first{};
    ::backtrace(first.data(), 1); // its first call loads a library
    take_faults();
    return see_system_calls();
}

void enter(std::string_view activity, bool is_real_time) noexcept {
    seen.activity = activity;
    ++seen.cycle;
    watches = is_real_time;
    raises = is_real_time;
}

void leave() noexcept {
    raises = 0;
    watches = false;
    seen.activity = {};
}

std::span<const Use> uses() noexcept { return std::span{seen.uses}.first(seen.used); }
std::uint64_t cycles() noexcept { return seen.cycles; }

Sentence place_of(const Use& use) noexcept {
    Dl_info info{};
    if (use.caller == 0 || ::dladdr(reinterpret_cast<void*>(use.caller), &info) == 0 ||
        info.dli_sname == nullptr)
        return Sentence{"in code without an exported name"};
    int fault = 0;
    char* const plain = abi::__cxa_demangle(info.dli_sname, nullptr, nullptr, &fault);
    std::string_view name = fault == 0 ? plain : info.dli_sname;
    constexpr std::string_view entry =
        "tappet::detail::describe<"; // the entry that calls a component's step, start, ..
    const std::size_t ends = name.find(">()::");
    const bool is_entry = name.starts_with(entry) && ends != name.npos;
    if (is_entry) name = name.substr(entry.size(), ends - entry.size());
    const Sentence place{is_entry ? "in a function of component type " : "in ", name};
    std::free(plain);
    return place;
}

namespace {

using Lock = int (*)(pthread_mutex_t*);
constinit std::atomic<Lock> glibc_lock{nullptr};

} // namespace

} // namespace tappet::os::host_watch

#define TAPPET_NOTE(what)                                                                                    \
    if (tappet::os::host_watch::watches)                                                                     \
    tappet::os::host_watch::note(what, __builtin_extract_return_addr(__builtin_return_address(0)))

extern "C" {

void* malloc(std::size_t bytes) noexcept {
    TAPPET_NOTE("malloc");
    return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) noexcept {
    TAPPET_NOTE("calloc");
    return __libc_calloc(count, bytes);
}
void* realloc(void* piece, std::size_t bytes) noexcept {
    TAPPET_NOTE("realloc");
    return __libc_realloc(piece, bytes);
}
void* aligned_alloc(std::size_t align, std::size_t bytes) noexcept {
    TAPPET_NOTE("aligned_alloc");
    return __libc_memalign(align, bytes);
}
void free(void* piece) noexcept {
    if (piece != nullptr) TAPPET_NOTE("free");
    __libc_free(piece);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
    using namespace tappet::os::host_watch;
    TAPPET_NOTE("pthread_mutex_lock");
    Lock lock = glibc_lock.load(std::memory_order_acquire);
    if (lock == nullptr) {
        lock = reinterpret_cast<Lock>(::dlsym(RTLD_NEXT, "pthread_mutex_lock"));
        glibc_lock.store(lock, std::memory_order_release);
    }
    return lock(mutex);
}

} // extern "C"
