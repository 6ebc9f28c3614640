// SPDX-License-Identifier: Apache-2.0
// Runs its function each time it is woken.
#include "kernel/machine/worlds/makers_thread.hpp"

#include "kernel/os/memory.hpp"

namespace tappet {

namespace {

thread_local MakersThread* current_makers = nullptr;

} // namespace

std::expected<void, Sentence> MakersThread::create(std::string_view name, std::span<std::byte> stack,
                                                   void (*work)(void*), void* context) {
    work_ = work;
    context_ = context;
    ended_.store(false);
    os::paint_stack(stack);
    plan_ = {name, 0, -1, stack, [](void* self) noexcept { static_cast<MakersThread*>(self)->live(); }, this};
    return thread_.start(plan_);
}

void MakersThread::live() noexcept {
    current_makers = this;
    while (!ended_.load(std::memory_order_acquire)) {
        waiter_.wait_for_wake();
        work_(context_);
    }
}

void MakersThread::end(int milliseconds) noexcept {
    ended_.store(true, std::memory_order_release);
    wake();
    if (!thread_.join_within(milliseconds)) thread_.abandon();
}

void MakersThread::note_breach() noexcept TAPPET_REALTIME {
    MakersThread* here = nullptr;
    TAPPET_ESCAPE("thread-local memory of the main program", here = current_makers);
    if (here != nullptr) here->is_lost_.store(true, std::memory_order_release);
}

} // namespace tappet
