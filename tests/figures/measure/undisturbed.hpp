// A measuring thread with as little disturbance as possible: a real-time priority, a processor of its own,
// locked memory, processors that do not sleep deeply.
#pragma once

#include <string>

namespace tappet::figures {

/// While it exists, the thread that made it runs so. Refusals of the system change nothing and are listed by
/// refused().
class Undisturbed {
public:
    static constexpr int priority = 60; ///< SCHED_FIFO
    /// `processor`: the one to run on; -1: any.
    explicit Undisturbed(int processor);
    ~Undisturbed();
    Undisturbed(const Undisturbed&) = delete;
    Undisturbed& operator=(const Undisturbed&) = delete;

    /// The refusals of the system, for the notes of a result; empty: none.
    [[nodiscard]] const std::string& refused() const { return refused_; }

private:
    int latency_ = -1;
    std::string refused_{};
};

/// Linux stops real-time threads that use more than 95 % of a second: a measuring thread rests for a tenth of
/// its busy time.
void rest_after(double busy_ns);

} // namespace tappet::figures
