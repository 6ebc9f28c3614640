// The floors by themselves: limits that no framework can beat, measured first to describe the machine.
#include "tests/figures/floors/two_threads.hpp"
#include "tests/figures/measure/candidates.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <mutex>

#include <sys/syscall.h>
#include <unistd.h>

namespace {

using namespace tappet::figures;

template <std::size_t bytes>
struct Packet {
    std::array<std::byte, bytes> content{};
};
template <std::size_t bytes>
Packet<bytes> from{};
template <std::size_t bytes>
Packet<bytes> into{};

template <std::size_t bytes>
void struct_copy(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        keep(from<bytes>);
        into<bytes> = from<bytes>;
        keep(into<bytes>);
    }
}

std::uint64_t plain = 0;
std::atomic<std::uint64_t> word{0};
void release_store(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) word.store(i, std::memory_order_release);
}
void exchange(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) plain += word.exchange(i, std::memory_order_acq_rel);
    keep(plain);
}
void atomic_or(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) word.fetch_or(i, std::memory_order_release);
}
void ordered_store(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) word.store(i, std::memory_order_seq_cst);
}
void compare_exchange(std::size_t times) {
    std::uint64_t expected = word.load(std::memory_order_relaxed);
    for (std::size_t i = 0; i < times; ++i)
        if (word.compare_exchange_strong(expected, expected + 1, std::memory_order_acq_rel)) ++expected;
}
std::mutex mutex;
void lock_and_unlock(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        const std::lock_guard lock{mutex};
        ++plain;
    }
}

void read_clock(std::size_t times) {
    timespec now{};
    for (std::size_t i = 0; i < times; ++i) {
        clock_gettime(CLOCK_MONOTONIC, &now);
        keep(now);
    }
}
void system_call(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) syscall(SYS_getppid);
}

[[gnu::noinline]] void callee(void* context) { ++*static_cast<std::uint64_t*>(context); }
void (*volatile pointer)(void*) = &callee;
void function_pointer_call(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) pointer(&plain);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = read_options(argc, argv);
    Result result{.program = "floors"};
    std::vector<Group> groups;
    groups.push_back({"floors.copy",
                      "copy of a struct",
                      "",
                      64,
                      {{"8 bytes", Standing::floor, &struct_copy<8>},
                       {"160 bytes", Standing::floor, &struct_copy<160>},
                       {"4096 bytes", Standing::floor, &struct_copy<4096>}}});
    groups.push_back({"floors.word",
                      "one word, one core",
                      "",
                      64,
                      {{"release store", Standing::floor, &release_store},
                       {"seq_cst store", Standing::floor, &ordered_store},
                       {"exchange", Standing::floor, &exchange},
                       {"compare_exchange", Standing::floor, &compare_exchange},
                       {"fetch_or, result unused", Standing::floor, &atomic_or},
                       {"std::mutex, lock and unlock, nobody else there", Standing::floor, &lock_and_unlock},
                       {"call through a function pointer", Standing::floor, &function_pointer_call}}});
    groups.push_back({"floors.system",
                      "the operating system, one thread",
                      "",
                      16,
                      {{"clock_gettime(CLOCK_MONOTONIC)", Standing::floor, &read_clock},
                       {"shortest system call (getppid)", Standing::floor, &system_call}}});
    run_candidates(options, argv, groups, result);
    measure_two_threads(options, result);
    return finish(options, result);
}
