// Memory and page faults: touched pages are resident, used stack is detected, and the counters show the
// difference.
#include "kernel/os/memory.hpp"

#include "kernel/base/random.hpp"
#include "kernel/os/faults.hpp"
#include "kernel/os/heap.hpp"

#include <gtest/gtest.h>

#include <alloca.h>
#include <vector>

#include <pthread.h>
#include <sys/mman.h>

namespace tappet::os {
namespace {

class Pages {
public:
    explicit Pages(std::size_t count)
        : bytes_{count * page_bytes()},
          at_{mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)} {
        madvise(at_, bytes_, MADV_NOHUGEPAGE); // one fault a page, whatever the box's setting
    }
    ~Pages() { munmap(at_, bytes_); }
    Pages(const Pages&) = delete;
    Pages& operator=(const Pages&) = delete;
    [[nodiscard]] std::span<std::byte> span() const { return {static_cast<std::byte*>(at_), bytes_}; }

private:
    std::size_t bytes_;
    void* at_;
};

TEST(PageFaults, increase_with_each_fresh_page_but_not_with_touched_ones) {
    if (heap::sanitizer_owns_malloc) GTEST_SKIP() << "a sanitizer has pages of its own beside each of ours";
    const Pages pages{200};
    const PageFaults before = page_faults_of_this_thread();
    touch(pages.span());
    const PageFaults fresh = page_faults_of_this_thread() - before;
    EXPECT_GE(fresh.minor, 200u);
    const PageFaults again = page_faults_of_this_thread();
    for (std::byte& byte : pages.span()) byte = std::byte{7};
    const PageFaults touched = page_faults_of_this_thread() - again;
    EXPECT_LT(touched.minor, 20u) << "the pages are there already";
}

TEST(PageFaults, are_counted_per_thread) {
    const PageFaults process = page_faults_of_this_process();
    const PageFaults mine = page_faults_of_this_thread();
    pthread_t thread{};
    ASSERT_EQ(pthread_create(
                  &thread, nullptr,
                  [](void*) -> void* {
                      const Pages pages{500};
                      touch(pages.span());
                      return nullptr;
                  },
                  nullptr),
              0);
    pthread_join(thread, nullptr);
    EXPECT_GE((page_faults_of_this_process() - process).minor, 500u);
    EXPECT_LT((page_faults_of_this_thread() - mine).minor, 250u);
}

TEST(Memory, keeps_its_content_when_touched) {
    std::vector<std::byte> bytes(3 * page_bytes() + 17);
    Random random{99};
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.below(256));
    const auto copy = bytes;
    touch(bytes);
    touch({});
    EXPECT_EQ(bytes, copy);
}

struct StackUse {
    std::size_t touched;
    std::size_t used;
    std::uint64_t faults;
};

[[gnu::noinline]] void use_stack(std::size_t bytes) {
    auto* area = static_cast<volatile std::byte*>(alloca(bytes));
    for (std::size_t i = 0; i < bytes; i += 64) area[i] = std::byte{1};
}

void* touch_then_use(void* context) {
    auto& use = *static_cast<StackUse*>(context);
    touch_stack(use.touched);
    const PageFaults before = page_faults_of_this_thread();
    use_stack(use.used);
    use.faults = (page_faults_of_this_thread() - before).minor;
    return nullptr;
}

StackUse on_stack(const Pages& stack, StackUse use) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstack(&attributes, stack.span().data(), stack.span().size());
    pthread_t thread{};
    EXPECT_EQ(pthread_create(&thread, &attributes, touch_then_use, &use), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
    return use;
}

TEST(Memory, makes_a_touched_stack_free_of_page_faults) {
    if (heap::sanitizer_owns_malloc) GTEST_SKIP() << "a sanitizer has pages of its own beside each of ours";
    const std::size_t used = 64 * page_bytes();
    EXPECT_GE(on_stack(Pages{128}, {0, used, 0}).faults, 50u) << "without touching, each page is a fault";
    EXPECT_LT(on_stack(Pages{128}, {used + 16 * page_bytes(), used, 0}).faults, 5u);
}

TEST(Memory, measures_the_used_depth_of_a_painted_stack) {
    const Pages stack{64};
    paint_stack(stack.span());
    EXPECT_EQ(stack_high_water_bytes(stack.span()), 0u);
    std::size_t last = 0;
    for (const std::size_t used : {std::size_t{20'000}, std::size_t{60'000}, std::size_t{150'000}}) {
        static_cast<void>(on_stack(stack, {0, used, 0}));
        const std::size_t found = stack_high_water_bytes(stack.span());
        EXPECT_GE(found, used);
        EXPECT_LT(found, used + 20'000);
        EXPECT_GT(found, last);
        last = found;
    }
}

TEST(Memory, reports_an_overflowed_stack_as_fully_used) {
    const Pages pages{4};
    const std::span stack = pages.span();
    paint_stack(stack);
    stack[page_bytes()] = std::byte{0}; // the page below is its guard
    EXPECT_EQ(stack_high_water_bytes(stack), stack.size() - page_bytes());
}

TEST(Memory, usage_grows_by_touched_bytes) {
    if (heap::sanitizer_owns_malloc) GTEST_SKIP() << "a sanitizer keeps memory of its own";
    const std::size_t before = rss_bytes();
    EXPECT_GT(before, 100'000u);
    const Pages pages{2000};
    touch(pages.span());
    EXPECT_GE(rss_bytes(), before + 1900 * page_bytes());
}

TEST(Memory, is_locked_or_reports_a_cure) {
    if (heap::sanitizer_owns_malloc) GTEST_SKIP() << "a sanitizer makes mlockall do nothing";
    EXPECT_FALSE(memory_is_locked());
    const auto locked = lock_memory();
    if (locked) {
        EXPECT_TRUE(memory_is_locked());
        const Pages pages{50}; // locked at once: no page fault on use
        const PageFaults before = page_faults_of_this_thread();
        touch(pages.span());
        EXPECT_LT((page_faults_of_this_thread() - before).minor, 5u);
        unlock_memory();
    } else {
        EXPECT_NE(locked.error().view().find("CAP_IPC_LOCK"), std::string_view::npos)
            << locked.error().view();
    }
    EXPECT_FALSE(memory_is_locked());
}

} // namespace
} // namespace tappet::os
