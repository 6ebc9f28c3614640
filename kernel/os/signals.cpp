// SIGINT and SIGTERM as one request to end.
#include "kernel/os/signals.hpp"

#include <csignal>
#include <initializer_list>

namespace tappet::os {

void on_termination(void (*handler)(int) noexcept) noexcept {
    struct sigaction action{};
    if (handler == nullptr)
        action.sa_handler = SIG_DFL;
    else
        action.sa_handler = handler;
    for (const int number : {SIGINT, SIGTERM}) sigaction(number, &action, nullptr);
}

} // namespace tappet::os
