// Code that looks similar but is not wait-free: each of these must be refused, otherwise the check sees
// nothing.
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace {

struct Node {
    Node* next;
};

struct OneSlot {
    std::atomic<std::uint64_t> generation;
    std::array<std::atomic<std::uint64_t>, 40> words;
};

struct Counted {
    std::atomic<std::size_t> count;
    std::array<std::atomic<std::uint64_t>, 40> words;
};

} // namespace

extern "C" {

void retry_push(std::atomic<Node*>& head, Node* node) noexcept {
    node->next = head.load(std::memory_order_relaxed);
    while (
        !head.compare_exchange_weak(node->next, node, std::memory_order_release, std::memory_order_relaxed)) {
    }
}

#if defined(__aarch64__)
/// The source has no loop: before the atomic instructions of version 8.1, the compiler generates it.
[[gnu::target("no-lse")]] std::uint64_t retry_add_without_lse(std::uint64_t& word) noexcept {
    return __atomic_fetch_add(&word, 1, __ATOMIC_ACQ_REL);
}
#endif

/// The source has no loop: the compiler generates it, because the result is used and x86-64 has no "or" that
/// returns it. aarch64 has one: there this retries nothing.
bool retry_set_bit(std::atomic<std::uint64_t>& word, std::uint64_t bits) noexcept {
    return (word.fetch_or(bits, std::memory_order_acq_rel) & bits) != bits;
}

void retry_wait_for_flag(const std::atomic<bool>& flag) noexcept {
    while (!flag.load(std::memory_order_acquire)) {
    }
}

/// A sequence lock: the reader retries as long as the writer writes.
void retry_read(const OneSlot& slot, std::uint64_t* into) noexcept {
    std::uint64_t before = 0;
    do {
        before = slot.generation.load(std::memory_order_acquire);
        for (std::size_t i = 0; i < slot.words.size(); ++i)
            into[i] = slot.words[i].load(std::memory_order_acquire);
    } while ((before & 1) != 0 || slot.generation.load(std::memory_order_relaxed) != before);
}

/// A count is no bound while others can raise it.
std::uint64_t retry_while_more_comes(const Counted& queue) noexcept {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < queue.count.load(std::memory_order_acquire); ++i)
        sum += queue.words[i % 40].load(std::memory_order_relaxed);
    return sum;
}

/// A counter that a failure resets counts nothing.
bool retry_with_a_counter_that_is_set_back(const OneSlot& slot) noexcept {
    std::uint64_t seen = slot.generation.load(std::memory_order_acquire);
    for (std::size_t i = 0; i < slot.words.size(); ++i)
        if (slot.words[i].load(std::memory_order_acquire) != seen) {
            seen = slot.generation.load(std::memory_order_acquire);
            i = 0;
        }
    return seen != 0;
}

/// Calls a function that is not inlined, and finally itself.
[[gnu::noinline]] std::uint64_t retry_by_recursion(const std::atomic<std::uint64_t>& word,
                                                   std::uint64_t seen) noexcept {
    const std::uint64_t now = word.load(std::memory_order_acquire);
    return now == seen ? now : 1 + retry_by_recursion(word, now);
}

/// Bounded and without a cycle: must not be refused.
std::uint64_t counted_sum(const Counted& queue) noexcept {
    std::uint64_t sum = 0;
    for (const auto& word : queue.words) sum += word.load(std::memory_order_acquire);
    return sum;
}

} // extern "C"
