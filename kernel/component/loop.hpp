// The control of a component that decides itself when it runs (thesis 4.2.2: loop and breakLoop).
#pragma once

#include "kernel/base/time.hpp"

namespace tappet {

/// The argument of `void loop(LoopControl&)` of a component that blocks. loop() runs in an activity of its
/// own, which is not_real_time: from the start of that activity, and again upon each wake after it returned.
/// It must return when wait() or serve() says so. A component that blocks anywhere else also has `void
/// break_loop()`, which is called on a thread of its own and makes loop() return soon (by a pipe, a shutdown
/// of its socket). Under virtual time it blocks in wait() only: elsewhere the whole world would wait for it.
/// Real-time activities have no loop(): their threads wait only in the activity, so that the code between two
/// waits is timed and analysed as a step. Use on_device(...), a Timer that is armed anew, or a program there.
class LoopControl {
public:
    struct World {
        void* self = nullptr;
        bool (*wait)(void* self, Duration time) noexcept = nullptr;
        bool (*serve)(void* self) noexcept = nullptr;
        const Time* now = nullptr;
    };
    explicit constexpr LoopControl(const World& world) noexcept : world_{world} {}

    /// Sleeps for `time`, or until something wakes the activity or one of its timers is due; then serves.
    /// False: return from loop().
    [[nodiscard]] bool wait(Duration time) noexcept { return world_.wait(world_.self, time); }
    /// Runs the component's due timers, messages and commands, and updates now(), with which its outputs are
    /// stamped. Call it after each blocking call. False: return from loop().
    [[nodiscard]] bool serve() noexcept { return world_.serve(world_.self); }
    /// Returns the time of the last wait() or serve().
    [[nodiscard]] Time now() const noexcept { return *world_.now; }

private:
    World world_;
};

} // namespace tappet
