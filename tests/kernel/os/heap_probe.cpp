// A small static firmware with a sealed heap. After sealing it executes the action named by its argument and
// prints the counts. Exit: 0 no breach, 3 a contract was broken and reported, 2 the heap is not the arena, 1
// any other failure.
#include "kernel/base/contract.hpp"
#include "kernel/os/heap.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

TAPPET_HEAP_ARENA(512 * 1024)

namespace {

namespace heap = tappet::os::heap;

std::atomic<int> broken{0};
std::atomic<int> last_id{0};

void stop_safely(const tappet::ContractViolation& breach) noexcept TAPPET_REALTIME {
    broken.fetch_add(1);
    last_id.store(static_cast<int>(breach.id));
}

// Keeps the compiler from optimising the object away.
template <class T> T* kept(T* pointer) {
    asm volatile("" : "+r"(pointer) : : "memory");
    return pointer;
}

struct Action {
    std::string_view name;
    void (*act)();
};

struct alignas(64) Line {
    char characters[64];
};

void expects_refusal(const void* mapped) {
    if (mapped != MAP_FAILED || errno != ENOMEM) std::exit(1);
}

// A stack without a cached spare in glibc: glibc maps one, by its internal name.
void start_thread_with_new_stack() {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, std::size_t{64} << 20);
    pthread_t thread{};
    if (pthread_create(&thread, &attributes, [](void*) -> void* { return nullptr; }, nullptr) == 0)
        std::exit(1);
}

void print_on_the_stack() {
    char text[64];
    std::snprintf(text, sizeof text, "%d %s", 7, "seven");
    kept(text);
}

void open_a_file() {
    if (FILE* file = std::fopen("/proc/self/stat", "r")) std::fclose(file);
}

void align_the_posix_way() {
    void* piece = nullptr;
    if (posix_memalign(&piece, 64, 100) == 0) std::free(kept(piece));
}

constexpr Action actions[] = {
    {"nothing", [] {}},
    {"stack", print_on_the_stack},
    {"malloc", [] { std::free(kept(std::malloc(100))); }},
    {"calloc", [] { std::free(kept(std::calloc(10, 10))); }},
    {"realloc", [] { std::free(kept(std::realloc(nullptr, 100))); }},
    {"aligned_alloc", [] { std::free(kept(std::aligned_alloc(64, 128))); }},
    {"memalign", [] { std::free(kept(memalign(64, 128))); }},
    {"posix_memalign", align_the_posix_way},
    {"new", [] { delete kept(new int{3}); }},
    {"new_array", [] { delete[] kept(new int[30]); }},
    {"new_aligned", [] { delete kept(new Line{}); }},
    {"string", [] { kept(std::string(100, 'x').data()); }},
    {"strdup", [] { std::free(kept(strdup("inside the C library"))); }},
    {"fopen", open_a_file},
    {"thread", [] { std::thread{[] {}}.join(); }},
    {"thread_stack", start_thread_with_new_stack},
    {"mmap", [] { expects_refusal(mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)); }},
    {"sbrk", [] { expects_refusal(sbrk(4096)); }},
};

// Before sealing, the arena serves all allocations of a program.
bool configures() {
    std::vector<std::string> names;
    for (int i = 0; i < 100; ++i) names.emplace_back(50, static_cast<char>('a' + i % 26));
    std::vector<std::thread> threads;
    std::atomic<int> wrong{0};
    for (int t = 0; t < 3; ++t)
        threads.emplace_back([&wrong, t] {
            for (std::size_t i = 1; i < 400; ++i) {
                const std::size_t bytes = 1 + i * 7 % 900;
                auto* piece = kept(static_cast<unsigned char*>(std::malloc(bytes)));
                std::memset(piece, t, bytes);
                piece = static_cast<unsigned char*>(std::realloc(piece, bytes * 2));
                for (std::size_t b = 0; b < bytes; ++b) wrong += piece[b] != t;
                std::free(piece);
            }
        });
    for (auto& thread : threads) thread.join();
    return wrong == 0 && names.back()[0] == static_cast<char>('a' + 99 % 26) && heap::used_bytes() > 5000 &&
           heap::high_water_bytes() >= heap::used_bytes();
}

int after_sealing(const Action& action) {
    tappet::install_contract_handler(stop_safely);
    heap::seal();
    if (!heap::seal_counts()) return 2;
    action.act();
    heap::release();
    std::printf("allocations %llu mappings %llu releases %llu contract %d\n",
                static_cast<unsigned long long>(heap::allocations_after_seal()),
                static_cast<unsigned long long>(heap::mappings_after_seal()),
                static_cast<unsigned long long>(heap::releases_after_seal()), last_id.load());
    for (const heap::Record& record : heap::records_after_seal())
        std::printf("record %zu bytes by %s at 0x%zx\n", record.bytes, record.thread_name.data(),
                    static_cast<std::size_t>(record.caller));
    return broken.load() == 0 ? 0 : 3;
}

} // namespace

int main(int count, char** arguments) {
    const std::string_view wanted = count > 1 ? arguments[1] : "";
    if (!heap::owns_malloc()) return 2;
    if (!configures()) return 1;
    if (wanted == "exhaust") { // no handler: the contract prints and aborts
        while (kept(std::malloc(10'000)) != nullptr) {
        }
        return 1;
    }
    if (wanted == "exhaust_handled") {
        tappet::install_contract_handler(stop_safely);
        while (kept(std::malloc(10'000)) != nullptr) {
        }
        std::printf("contract %d refused %llu\n", last_id.load(),
                    static_cast<unsigned long long>(heap::refused_allocations()));
        return 3;
    }
    if (wanted == "exhaust_new") { // in a separate thread, like an activity
        tappet::install_contract_handler(
            [](const tappet::ContractViolation& breach) noexcept TAPPET_REALTIME {
                stop_safely(breach);
                TAPPET_ESCAPE("what the machine's handler does with a thread that must not go on",
                              if (breach.id == tappet::Contract::memory_not_there) pause());
            });
        std::thread{[] {
            while (kept(new char[10'000]) != nullptr) {
            }
        }}.detach();
        while (last_id.load() != static_cast<int>(tappet::Contract::memory_not_there)) usleep(1000);
        std::printf("contract %d, and the process goes on\n", last_id.load());
        std::fflush(stdout);
        std::_Exit(3);
    }
    if (wanted == "free_twice" || wanted == "free_foreign") {
        static int elsewhere = 0;
        void* piece = wanted == "free_twice" ? std::malloc(10) : &elsewhere;
        if (wanted == "free_twice") std::free(kept(piece));
        std::free(kept(piece));
        return 1;
    }
    if (wanted == "unhandled") {
        heap::seal();
        std::free(kept(std::malloc(10)));
        return 1;
    }
    for (const Action& action : actions)
        if (action.name == wanted) return after_sealing(action);
    return 1;
}
