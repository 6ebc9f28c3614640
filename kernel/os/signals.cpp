// The signals that request the end, and those without a meaning for a machine.
#include "kernel/os/signals.hpp"

#include <csignal>

namespace tappet::os {

namespace {

// Every signal whose default would end or freeze the process with its outputs as they are. Excluded are those
// that nobody can catch, and those that report a fault in the program: these are no requests.
constexpr int ask_to_end[] = {SIGINT,  SIGTERM,   SIGHUP,  SIGQUIT,   SIGTSTP, SIGUSR1, SIGUSR2,
                              SIGALRM, SIGVTALRM, SIGPROF, SIGSTKFLT, SIGPOLL, SIGPWR,  SIGXCPU};
// A reader that went away, a terminal that others use, a file that may not grow: the call that is affected
// reports it.
constexpr int told_by_the_call[] = {SIGPIPE, SIGTTIN, SIGTTOU, SIGXFSZ};

void act(int number, void (*handler)(int)) noexcept {
    struct sigaction action{};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigaction(number, &action, nullptr);
}

} // namespace

void on_termination(void (*handler)(int) noexcept) noexcept {
    for (const int number : ask_to_end) act(number, handler == nullptr ? SIG_DFL : handler);
    for (int number = SIGRTMIN; number <= SIGRTMAX; ++number)
        act(number, handler == nullptr ? SIG_DFL : handler);
    for (const int number : told_by_the_call) act(number, handler == nullptr ? SIG_DFL : SIG_IGN);
}

} // namespace tappet::os
