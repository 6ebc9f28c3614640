// Real-time annotations. A function marked TAPPET_REALTIME takes no lock, no heap, no blocking system call;
// clang proves it for the whole call tree (-Werror=function-effects), g++ reads it as documentation.
#pragma once

#if defined(__clang__)
// Written after noexcept, as part of the function's type: void step() noexcept TAPPET_REALTIME;
#define TAPPET_REALTIME [[clang::nonblocking]]
#define TAPPET_PRAGMA(text) _Pragma(#text)
#else
#define TAPPET_REALTIME
#endif

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
#include <sanitizer/rtsan_interface.h>
#define TAPPET_SANITIZER_PAUSE const __rtsan::ScopedDisabler tappet_sanitizer_pause
#endif
#endif
#if !defined(TAPPET_SANITIZER_PAUSE)
#define TAPPET_SANITIZER_PAUSE static_cast<void>(0)
#endif

// The only escape from the check: runs a statement that the compiler cannot prove to be real-time. The reason
// is part of the call, and the test `house` prints the list of all uses. Example:
//     TAPPET_ESCAPE("the activity's own wait", ppoll(fds, n, &left, nullptr));
#if defined(__clang__)
#define TAPPET_ESCAPE(reason, ...)                                                                           \
    do {                                                                                                     \
        static_assert(sizeof(reason) > 1, "an escape hatch states its reason");                              \
        TAPPET_PRAGMA(clang diagnostic push)                                                                 \
        TAPPET_PRAGMA(clang diagnostic ignored "-Wfunction-effects")                                         \
        TAPPET_SANITIZER_PAUSE;                                                                              \
        __VA_ARGS__;                                                                                         \
        TAPPET_PRAGMA(clang diagnostic pop)                                                                  \
    } while (false)
#else
#define TAPPET_ESCAPE(reason, ...)                                                                           \
    do {                                                                                                     \
        static_assert(sizeof(reason) > 1, "an escape hatch states its reason");                              \
        __VA_ARGS__;                                                                                         \
    } while (false)
#endif
