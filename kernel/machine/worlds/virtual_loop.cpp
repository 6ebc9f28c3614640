// Passes the turn between a loop and the world.
#include "kernel/machine/worlds/virtual_loop.hpp"

#include "kernel/base/contract.hpp"

#include <algorithm>

namespace tappet {

VirtualLoop::VirtualLoop(Engine& engine, const os::Clock& clock, std::span<std::byte> stack) noexcept
    : engine_{engine}, clock_{clock}, part_{*engine.looping()} {
    plan_ = {
        engine.name(), 0, -1, stack, [](void* self) noexcept { static_cast<VirtualLoop*>(self)->live(); },
        this};
}

VirtualLoop::~VirtualLoop() {
    if (!thread_.running()) return;
    break_off();
    ending_ = true;
    loops_turn_.wake();
}

void VirtualLoop::live() noexcept {
    take_turn(loops_turn_);
    while (!ending_) {
        LoopControl control{
            {this,
             [](void* self, Duration time) noexcept { return static_cast<VirtualLoop*>(self)->wait(time); },
             [](void* self) noexcept { return static_cast<VirtualLoop*>(self)->serve(); },
             engine_.now_address()}};
        part_.type->loop(part_.component_, control);
        in_loop_ = false;
        worlds_turn_.wake();
        take_turn(loops_turn_);
    }
}

void VirtualLoop::run(bool woken) noexcept {
    if (in_loop_) {
        resume(woken);
        return;
    }
    engine_.run(woken);
    if (!is_running(part_.state)) return;
    if (!thread_.running())
        TAPPET_CONTRACT(thread_.start(plan_).has_value(), Contract::precondition, plan_.stack.size());
    in_loop_ = true;
    resume(false);
}

void VirtualLoop::resume(bool woken) noexcept {
    woken_ = woken;
    loops_turn_.wake();
    take_turn(worlds_turn_);
}

void VirtualLoop::break_off() noexcept {
    if (!in_loop_) return;
    ends_ = true;
    if (part_.type->break_loop != nullptr) part_.type->break_loop(part_.component_);
    for (int n = 0; in_loop_; ++n) {
        TAPPET_CONTRACT(n < most_waits_after_the_end, Contract::step_limit_exceeded, most_waits_after_the_end,
                        n + 1);
        resume(false);
    }
    ends_ = false;
}

bool VirtualLoop::wait(Duration time) noexcept {
    wakes_at_ = clock_.now() + time;
    worlds_turn_.wake();
    take_turn(loops_turn_);
    if (!ends_) engine_.run(woken_);
    return !ends_;
}

bool VirtualLoop::serve() noexcept {
    if (!ends_) engine_.run(false);
    return !ends_;
}

Time VirtualLoop::next_wake() const noexcept {
    return in_loop_ ? std::min(wakes_at_, engine_.next_wake()) : engine_.next_wake();
}

} // namespace tappet
