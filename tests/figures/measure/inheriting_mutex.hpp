// A peer of lock-free exchange: a mutex as the thesis configured it.
#pragma once

#include <pthread.h>

namespace tappet::figures {

/// Without priority inheritance the experiment could not be made: "the high priority threads would almost
/// fail immediately" (thesis 4.4.4). Not real-time: it blocks.
class InheritingMutex {
public:
    InheritingMutex() {
        pthread_mutexattr_t attributes;
        pthread_mutexattr_init(&attributes);
        pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
        pthread_mutex_init(&mutex_, &attributes);
        pthread_mutexattr_destroy(&attributes);
    }
    ~InheritingMutex() { pthread_mutex_destroy(&mutex_); }
    InheritingMutex(const InheritingMutex&) = delete;
    InheritingMutex& operator=(const InheritingMutex&) = delete;

    void lock() noexcept { pthread_mutex_lock(&mutex_); }
    /// Returns true when it had to wait for another holder.
    bool lock_told() noexcept {
        if (pthread_mutex_trylock(&mutex_) == 0) return false;
        lock();
        return true;
    }
    void unlock() noexcept { pthread_mutex_unlock(&mutex_); }

private:
    pthread_mutex_t mutex_{};
};

} // namespace tappet::figures
