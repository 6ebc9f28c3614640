// The counterparts of the connectors: the same data behind a mutex with priority inheritance.
#pragma once

#include "tests/figures/measure/inheriting_mutex.hpp"

#include <cstddef>
#include <vector>

namespace tappet::experiments {

using figures::InheritingMutex;

/// The last value. Each call returns whether it had to wait.
template <class T>
class LockedData {
public:
    bool write(const T& value) noexcept {
        const bool waited = mutex_.lock_told();
        value_ = value;
        mutex_.unlock();
        return waited;
    }
    bool read(T& into) noexcept {
        const bool waited = mutex_.lock_told();
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
        const bool waited = mutex_.lock_told();
        const bool has_room = used_ < values_.size();
        if (has_room) values_[(first_ + used_++) % values_.size()] = value;
        mutex_.unlock();
        return {has_room, waited};
    }
    Answer pop(T& into) noexcept {
        const bool waited = mutex_.lock_told();
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
