// What a component that decides itself when it runs is told (thesis 4.2.2: loop and breakLoop).
#pragma once

#include "kernel/base/time.hpp"

namespace tappet {

/// Given to `void loop(LoopControl&)` of a component that blocks: it runs in an activity of its own, which is
/// not_real_time, from the start of that activity and again upon each wake after it returned. It returns when
/// wait() or serve() says so. One that blocks anywhere else has `void break_loop()` too, which is called on
/// a thread of its own and lets loop() return soon (by a pipe, a shutdown of its socket). Under virtual time
/// it blocks in wait() only: elsewhere the whole world would wait for it. In real time there is none: a
/// thread waits in its activity only, so that what lies between two waits is timed and analysed as a step.
/// What would be a loop there is on_device(...), a Timer that is armed anew, or a program.
class LoopControl {
public:
    struct World {
        void* self = nullptr;
        bool (*wait)(void* self, Duration time) noexcept = nullptr;
        bool (*serve)(void* self) noexcept = nullptr;
        const Time* now = nullptr;
    };
    explicit constexpr LoopControl(const World& world) noexcept : world_{world} {}

    /// Sleeps for so long, or until something wakes the activity or one of its timers is due; then serves.
    /// False: return from loop().
    [[nodiscard]] bool wait(Duration time) noexcept { return world_.wait(world_.self, time); }
    /// Runs what waits for the component: timers, messages, commands; and brings now() up to date, with which
    /// its outputs are stamped: after each blocking call. False: return from loop().
    [[nodiscard]] bool serve() noexcept { return world_.serve(world_.self); }
    /// When it was served last.
    [[nodiscard]] Time now() const noexcept { return *world_.now; }

private:
    World world_;
};

} // namespace tappet
