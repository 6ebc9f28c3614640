// What the reference interpreter runs: programs and conditions of a table as functions of the test, and work
// that stands still where a program waits.
#pragma once

#include "kernel/statechart/table.hpp"

#include <coroutine>
#include <cstdlib>
#include <functional>
#include <utility>

namespace tappet {

enum class ReferenceAnswer : std::uint8_t { no, yes, waits, failed };

/// Programs and conditions of the table; a program's stage is 0 at its beginning.
struct ReferenceCode {
    std::function<ReferenceAnswer(ProgramIndex, int& stage)> run{};
    std::function<ReferenceAnswer(ConditionIndex)> test{};
    std::byte* data = nullptr;
};

/// Work that stands still where it says co_await.
class ReferenceWork {
public:
    struct promise_type {
        ReferenceWork get_return_object() {
            return ReferenceWork{std::coroutine_handle<promise_type>::from_promise(*this)};
        }
        std::suspend_always initial_suspend() noexcept { return {}; }
        std::suspend_always final_suspend() noexcept { return {}; }
        void return_void() {}
        void unhandled_exception() { std::abort(); }
    };
    explicit ReferenceWork(std::coroutine_handle<promise_type> handle) : handle_{handle} {}
    ReferenceWork(ReferenceWork&& other) noexcept : handle_{std::exchange(other.handle_, nullptr)} {}
    ReferenceWork& operator=(ReferenceWork&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~ReferenceWork() {
        if (handle_) handle_.destroy();
    }
    bool resume() {
        handle_.resume();
        return handle_.done();
    }

private:
    std::coroutine_handle<promise_type> handle_;
};

} // namespace tappet
