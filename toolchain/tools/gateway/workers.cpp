// Threads that take tasks from one queue.
#include "toolchain/tools/gateway/workers.hpp"

namespace tappet::network {

Workers::Workers(std::size_t threads, std::size_t waiting) : waiting_{waiting} {
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Workers::~Workers() {
    {
        const std::lock_guard lock{mutex_};
        ending_ = true;
    }
    wake_.notify_all();
    for (std::thread& each : threads_) each.join();
}

bool Workers::post(std::function<void()> task) {
    {
        const std::lock_guard lock{mutex_};
        if (tasks_.size() >= waiting_) return false;
        tasks_.push_back(std::move(task));
    }
    wake_.notify_one();
    return true;
}

void Workers::work() {
    for (;;) {
        std::function<void()> task;
        {
            std::unique_lock lock{mutex_};
            wake_.wait(lock, [this] { return ending_ || !tasks_.empty(); });
            if (ending_) return;
            task = std::move(tasks_.front());
            tasks_.pop_front();
        }
        task();
    }
}

} // namespace tappet::network
