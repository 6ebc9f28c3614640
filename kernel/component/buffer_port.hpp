// Buffered data flow ports (thesis 4.4): every value arrives, in order, or is counted. Each row is a ring of
// its own, so that many writers on one input and many readers of one output stay wait-free.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/component/port.hpp"
#include "kernel/exchange/local_ring.hpp"
#include "kernel/exchange/ring.hpp"

namespace tappet {

/// How many rows one buffered port may stand in; the table's check says so by name.
inline constexpr std::size_t max_buffer_rows = 8;

/// One row's ring: wait-free between two activities, plain inside one.
template <class T>
struct BufferLane {
    Ring<T>* across = nullptr;
    LocalRing<T>* inside = nullptr;
    [[nodiscard]] bool push(const T& value) const noexcept TAPPET_REALTIME {
        return inside != nullptr ? inside->push(value) : across->push(value);
    }
    [[nodiscard]] bool pop(T& into) const noexcept TAPPET_REALTIME {
        return inside != nullptr ? inside->pop(into) : across->pop(into);
    }
};

template <class T>
class BufferOutput {
public:
    using Value = T;

    /// Gives the value to every connected reader. False when one of them had no room (its row says what is
    /// lost).
    bool push(const T& value) noexcept TAPPET_REALTIME {
        bool all = true;
        const std::size_t count = lanes_.size(); // a bound that no push can move: a counted loop
        for (std::size_t i = 0; i < count; ++i) all &= lanes_[i].push(value);
        waker_();
        return all;
    }

private:
    friend struct PortAccess;
    Bounded<BufferLane<T>, max_buffer_rows> lanes_{};
    Waker waker_{};
};

template <class T>
class BufferInput {
public:
    using Value = T;

    /// The oldest value of the first row that has one. False when all are empty.
    bool pop(T& into) noexcept TAPPET_REALTIME {
        const std::size_t count = lanes_.size();
        for (std::size_t i = 0; i < count; ++i)
            if (lanes_[i].pop(into)) return true;
        return false;
    }

private:
    friend struct PortAccess;
    Bounded<BufferLane<T>, max_buffer_rows> lanes_{};
};

} // namespace tappet
