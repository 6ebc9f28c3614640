// A sign of life: a number that grows while an activity runs or a value is written; watchdogs read it.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet {

/// The sign that a watchdog gets at configure, by the row option watches(...). Real-time, any thread.
struct LifeSign {
    const void* watched = nullptr;
    const void* owner = nullptr; ///< its life decides whether signs are expected
    std::uint64_t (*count)(const void* watched) noexcept TAPPET_REALTIME = nullptr;
    /// Returns false while it was stopped on purpose: then silence means nothing.
    bool (*expected)(const void* owner) noexcept TAPPET_REALTIME = nullptr;
    /// Returns true while it rests, nobody has woken it and no time is due for it: an activity without a
    /// period may be silent for hours. This does not detect a ready device whose activity gets no processor.
    /// Null: it never rests.
    bool (*rests)(const void* owner, Time now) noexcept TAPPET_REALTIME = nullptr;
};

} // namespace tappet
