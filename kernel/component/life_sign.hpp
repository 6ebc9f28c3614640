// A sign of life: a number that grows while an activity runs or a value is written, for whoever watches it.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet {

/// What a watchdog gets at configure, by the row option watches(...). Real-time, any thread.
struct LifeSign {
    const void* watched = nullptr;
    const void* owner = nullptr; ///< whose life decides whether signs are expected
    std::uint64_t (*count)(const void* watched) noexcept TAPPET_REALTIME = nullptr;
    /// False while it was stopped on purpose: its silence means nothing.
    bool (*expected)(const void* owner) noexcept TAPPET_REALTIME = nullptr;
    /// True while it rests, nobody has woken it and no time is due for it: an activity without a period may
    /// be silent for hours. That its device is ready while it gets no processor is not seen. Null: it never
    /// rests.
    bool (*rests)(const void* owner, Time now) noexcept TAPPET_REALTIME = nullptr;
};

} // namespace tappet
