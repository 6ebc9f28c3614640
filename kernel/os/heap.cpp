// The arena's lock, its accounts, and the effect of sealing.
#include "kernel/os/heap.hpp"

#include "kernel/base/contract.hpp"
#include "kernel/os/heap_allocator.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <linux/futex.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tappet::os::heap {

namespace {

// A priority-inheriting lock: a low-priority thread inside malloc must not keep the stopping one waiting
// behind everything between them. pthread's needs an initialiser that runs; malloc is called before any does.
class Lock {
public:
    Lock() noexcept {
        auto nobody = std::uint32_t{0};
        const auto self = static_cast<std::uint32_t>(syscall(SYS_gettid));
        if (!word_.compare_exchange_strong(nobody, self, std::memory_order_acquire)) wait();
    }
    ~Lock() {
        auto self = static_cast<std::uint32_t>(syscall(SYS_gettid));
        if (!word_.compare_exchange_strong(self, 0, std::memory_order_release))
            syscall(SYS_futex, &word_, FUTEX_UNLOCK_PI_PRIVATE, 0, nullptr, nullptr, 0);
    }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

private:
    static void wait() noexcept {
        while (syscall(SYS_futex, &word_, FUTEX_LOCK_PI_PRIVATE, 0, nullptr, nullptr, 0) != 0) {
            // A signal came, or the owner is ending: try again. Any other error would let two threads in.
            const int error = errno;
            TAPPET_CONTRACT(error == EINTR || error == EAGAIN, Contract::heap_lock_failed, error);
        }
    }

    static constinit std::atomic<std::uint32_t> word_;
    static_assert(sizeof word_ == 4 && std::atomic<std::uint32_t>::is_always_lock_free,
                  "the kernel's futex word");
};
constinit std::atomic<std::uint32_t> Lock::word_{0};

constinit Allocator allocator;
constinit std::atomic<State> now{State::open};
constinit std::atomic<bool> counts{false};
constinit std::atomic<std::uint64_t> allocations{0}, mappings{0}, releases{0}, refusals{0};
constinit std::array<Record, max_records> records{};
constinit std::atomic<std::size_t> claimed_records{0}, written_records{0};

void record(std::size_t bytes, std::uintptr_t caller) noexcept {
    const std::size_t slot = claimed_records.fetch_add(1, std::memory_order_relaxed);
    if (slot >= max_records) return;
    Record& entry = records[slot];
    entry.bytes = bytes;
    entry.caller = caller;
    entry.thread = static_cast<int>(syscall(SYS_gettid));
    prctl(PR_GET_NAME, entry.thread_name.data());
    written_records.fetch_add(1, std::memory_order_release);
}

void note_allocation(std::size_t bytes, std::uintptr_t caller) noexcept {
    if (now.load(std::memory_order_acquire) != State::sealed) return;
    allocations.fetch_add(1, std::memory_order_relaxed);
    record(bytes, caller);
    const int kept = errno;
    TAPPET_CONTRACT(false, Contract::allocation_after_seal, bytes, caller);
    errno = kept;
}

void note_exhaustion(std::size_t bytes) noexcept {
    refusals.fetch_add(1, std::memory_order_relaxed);
    const Use left = use();
    TAPPET_CONTRACT(false, Contract::heap_exhausted, bytes, left.free_bytes, left.largest_free_bytes);
    errno = ENOMEM;
}

// Call it under the lock.
Allocator::Piece checked(const void* piece) noexcept { return allocator.look_at(piece); }

void complain(Allocator::Piece found, const void* piece) noexcept {
    TAPPET_CONTRACT(found != Allocator::Piece::foreign, Contract::heap_foreign_pointer, piece);
    TAPPET_CONTRACT(found != Allocator::Piece::free, Contract::heap_double_free, piece);
    TAPPET_CONTRACT(found != Allocator::Piece::damaged, Contract::heap_damaged, piece);
}

void* obtain(const Arena& arena, std::size_t bytes, std::size_t align) noexcept {
    const Lock lock;
    if (!allocator.is_open()) allocator.open({arena.begin, arena.bytes});
    return allocator.allocate(bytes, align);
}

} // namespace

void seal() noexcept {
    if (state() == State::sealed) return;
    counts.store(owns_malloc(), std::memory_order_release);
    now.store(State::sealed, std::memory_order_release);
}
void release() noexcept { now.store(State::released, std::memory_order_release); }
State state() noexcept TAPPET_REALTIME { return now.load(std::memory_order_acquire); }

bool owns_malloc() noexcept {
    void* piece = std::malloc(1);
    // The compiler might otherwise remove a pair of calls whose result is unused.
    asm volatile("" : "+r"(piece) : : "memory");
    const bool ours = [&] {
        const Lock lock;
        return allocator.contains(piece);
    }();
    std::free(piece);
    return ours;
}

bool seal_counts() noexcept TAPPET_REALTIME { return counts.load(std::memory_order_acquire); }

std::uint64_t allocations_after_seal() noexcept TAPPET_REALTIME {
    return allocations.load(std::memory_order_relaxed);
}
std::uint64_t mappings_after_seal() noexcept TAPPET_REALTIME {
    return mappings.load(std::memory_order_relaxed);
}
std::uint64_t releases_after_seal() noexcept TAPPET_REALTIME {
    return releases.load(std::memory_order_relaxed);
}
std::uint64_t refused_allocations() noexcept TAPPET_REALTIME {
    return refusals.load(std::memory_order_relaxed);
}

Use use() noexcept {
    const Lock lock;
    return {allocator.capacity_bytes(), allocator.used_bytes(), allocator.high_water_bytes(),
            allocator.free_bytes(), allocator.largest_free_bytes()};
}

std::size_t used_bytes() noexcept {
    const Lock lock;
    return allocator.used_bytes();
}

std::size_t high_water_bytes() noexcept {
    const Lock lock;
    return allocator.high_water_bytes();
}

std::span<const Record> records_after_seal() noexcept TAPPET_REALTIME {
    return {records.data(), std::min(written_records.load(std::memory_order_acquire), max_records)};
}

void* allocate(const Arena& arena, std::size_t bytes, std::size_t align, std::uintptr_t caller) noexcept {
    void* piece = obtain(arena, bytes, align);
    note_allocation(bytes, caller);
    if (piece == nullptr) note_exhaustion(bytes);
    return piece;
}

void* reallocate(const Arena& arena, void* piece, std::size_t bytes, std::uintptr_t caller) noexcept {
    if (piece == nullptr) return allocate(arena, bytes, Allocator::alignment, caller);
    void* moved = nullptr;
    auto found = Allocator::Piece::in_use;
    {
        const Lock lock;
        found = checked(piece);
        if (found == Allocator::Piece::in_use) moved = allocator.resize(piece, bytes);
    }
    complain(found, piece);
    note_allocation(bytes, caller);
    if (moved == nullptr) note_exhaustion(bytes);
    return moved;
}

void deallocate(void* piece) noexcept {
    if (piece == nullptr) return;
    if (now.load(std::memory_order_relaxed) == State::sealed)
        releases.fetch_add(1, std::memory_order_relaxed);
    auto found = Allocator::Piece::in_use;
    {
        const Lock lock;
        found = checked(piece);
        if (found == Allocator::Piece::in_use) allocator.release(piece);
    }
    complain(found, piece);
}

std::size_t usable_bytes(void* piece) noexcept {
    if (piece == nullptr) return 0;
    const Lock lock;
    return allocator.usable_bytes(piece);
}

bool may_map(std::size_t bytes, std::uintptr_t caller) noexcept {
    if (now.load(std::memory_order_acquire) != State::sealed) return true;
    mappings.fetch_add(1, std::memory_order_relaxed);
    record(bytes, caller);
    TAPPET_CONTRACT(false, Contract::mapping_after_seal, bytes, caller);
    return false;
}

} // namespace tappet::os::heap
