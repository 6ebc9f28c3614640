// A few threads for what takes long, with a bounded queue.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tappet::network {

class Workers {
public:
    Workers(std::size_t threads, std::size_t waiting);
    /// Waits for the work under way; drops the rest.
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// Returns false when too many tasks wait.
    [[nodiscard]] bool post(std::function<void()> task);

private:
    void work();

    std::size_t waiting_;
    std::mutex mutex_{};
    std::condition_variable wake_{};
    std::deque<std::function<void()>> tasks_{};
    bool ending_ = false;
    std::vector<std::thread> threads_{};
};

} // namespace tappet::network
