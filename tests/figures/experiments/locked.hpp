// What the connectors are compared with: the same data behind a mutex with priority inheritance.
#pragma once

#include <cstddef>
#include <vector>

#include <pthread.h>

namespace tappet::experiments {

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

    /// True when it had to wait for whoever held it.
    bool lock() noexcept {
        if (pthread_mutex_trylock(&mutex_) == 0) return false;
        pthread_mutex_lock(&mutex_);
        return true;
    }
    void unlock() noexcept { pthread_mutex_unlock(&mutex_); }

private:
    pthread_mutex_t mutex_{};
};

/// The last value. Each call answers whether it had to wait.
template <class T>
class LockedData {
public:
    bool write(const T& value) noexcept {
        const bool waited = mutex_.lock();
        value_ = value;
        mutex_.unlock();
        return waited;
    }
    bool read(T& into) noexcept {
        const bool waited = mutex_.lock();
        into = value_;
        mutex_.unlock();
        return waited;
    }

private:
    InheritingMutex mutex_{};
    T value_{};
};

/// All values, in order.
template <class T>
class LockedBuffer {
public:
    explicit LockedBuffer(std::size_t capacity) : values_(capacity) {}

    struct Answer {
        bool done; ///< there was room, or a value
        bool waited;
    };
    Answer push(const T& value) noexcept {
        const bool waited = mutex_.lock();
        const bool has_room = used_ < values_.size();
        if (has_room) values_[(first_ + used_++) % values_.size()] = value;
        mutex_.unlock();
        return {has_room, waited};
    }
    Answer pop(T& into) noexcept {
        const bool waited = mutex_.lock();
        const bool has_value = used_ > 0;
        if (has_value) {
            into = values_[first_];
            first_ = (first_ + 1) % values_.size();
            --used_;
        }
        mutex_.unlock();
        return {has_value, waited};
    }

private:
    InheritingMutex mutex_{};
    std::vector<T> values_;
    std::size_t first_ = 0;
    std::size_t used_ = 0;
};

} // namespace tappet::experiments
