// A measuring thread that the rest of the machine disturbs as little as can be: a real-time priority, a
// processor of its own, memory that stays, processors that do not sleep deeply.
#pragma once

#include <string>

namespace tappet::figures {

/// While it lives, the thread that made it runs so. What the system refuses is left as it was and told by
/// refused().
class Undisturbed {
public:
    static constexpr int priority = 60; ///< SCHED_FIFO
    /// `processor`: where it runs; -1: anywhere.
    explicit Undisturbed(int processor);
    ~Undisturbed();
    Undisturbed(const Undisturbed&) = delete;
    Undisturbed& operator=(const Undisturbed&) = delete;

    /// What the system refused, for the notes of a result; empty: nothing.
    [[nodiscard]] const std::string& refused() const { return refused_; }

private:
    int latency_ = -1;
    std::string refused_{};
};

/// Linux stops real-time threads that use more than 95 % of a second: a measuring thread that ran for so long
/// rests a tenth of it.
void rest_after(double busy_ns);

} // namespace tappet::figures
