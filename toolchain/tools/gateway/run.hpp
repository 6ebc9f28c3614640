// A browser's command that runs in the gateway for a user elsewhere: its output, its files, its end.
#pragma once

#include "kernel/component/role.hpp"
#include "toolchain/tools/browser/program.hpp"
#include "toolchain/tools/gateway/message.hpp"
#include "toolchain/tools/gateway/sessions.hpp"

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>

namespace tappet::network {

/// One run. Its thread waits while the client reads too slowly, so that memory stays bounded.
class Run : public std::enable_shared_from_this<Run> {
public:
    /// `wake`: called on the run's thread when something waits to be sent.
    Run(const Message& message, LoggedIn who, std::string directory, std::string black_boxes,
        std::function<void()> wake);

    /// Runs the command to its end, on a thread of its own.
    void run();
    /// Interrupts it, as ^C does.
    void stop() { stop_ = 2; }
    /// Interrupts it; its output goes nowhere.
    void leave();
    /// Returns the next message to the client; nothing: none waits.
    [[nodiscard]] std::optional<std::string> next();
    /// Returns the exit code once everything has been taken.
    [[nodiscard]] std::optional<int> exit_code();

private:
    class Stream;
    /// Queues a message; waits for room. Returns false when the client has gone.
    bool put(std::string fields);

    std::uint32_t id_;
    std::vector<std::string> words_;
    browser::FarFiles::Given files_{};
    std::optional<browser::Size> screen_{};
    browser::User user_;
    std::string directory_;
    std::string black_boxes_;
    std::function<void()> wake_;
    browser::StopFlag stop_{0};

    std::mutex mutex_{};
    std::condition_variable room_{};
    std::deque<std::string> waiting_{};
    std::size_t bytes_ = 0;
    bool is_left_ = false;
    std::optional<int> code_{};
};

/// Returns whether a command only looks. All others are logged.
[[nodiscard]] bool only_looks(std::string_view command);

} // namespace tappet::network
