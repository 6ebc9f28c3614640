// Buffered data flow ports (thesis 4.4): every value arrives in order, or its loss is counted. Each row is a
// ring of its own, so that many writers of one input and many readers of one output stay wait-free.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/component/port.hpp"
#include "kernel/exchange/local_ring.hpp"
#include "kernel/exchange/ring.hpp"

namespace tappet {

/// Most rows that may name one buffered port; the table's check refuses more, by name.
inline constexpr std::size_t max_buffer_rows = 8;

/// The rings of a port's rows: plain ones inside its activity, wait-free ones to or from others. Two lists,
/// so that the loop over each is a counted loop.
template <class T>
struct BufferRings {
    Bounded<LocalRing<T>*, max_buffer_rows> inside{};
    Bounded<Ring<T>*, max_buffer_rows> across{};
};

template <class T>
class BufferOutput : FacetMember<member::port> {
public:
    using Value = T;

    /// Gives the value to every connected reader. Returns false when one of them had no room (its row says
    /// what is lost), or when the component does not run.
    bool push(const T& value) noexcept TAPPET_REALTIME {
        if (dropped_ != nullptr) [[unlikely]] {
            dropped_->fetch_add(1, std::memory_order_relaxed); // no step: counted for the report
            return false;
        }
        bool all = true;
        // No push can change these bounds, so both loops are counted loops.
        const std::size_t inside = rings_.inside.size(), across = rings_.across.size();
        for (std::size_t i = 0; i < inside; ++i) all &= rings_.inside[i]->push(value);
        for (std::size_t i = 0; i < across; ++i) all &= rings_.across[i]->push(value);
        waker_();
        return all;
    }

private:
    friend struct PortAccess;
    BufferRings<T> rings_{};
    Waker waker_{};
    DroppedWrites* dropped_ = nullptr;
};

template <class T>
class BufferInput : FacetMember<member::port> {
public:
    using Value = T;

    /// Takes the oldest value of the first row that has one; rows inside the activity come before others.
    /// Returns false when all are empty.
    bool pop(T& into) noexcept TAPPET_REALTIME {
        const std::size_t inside = rings_.inside.size(), across = rings_.across.size();
        for (std::size_t i = 0; i < inside; ++i)
            if (rings_.inside[i]->pop(into)) return true;
        for (std::size_t i = 0; i < across; ++i)
            if (rings_.across[i]->pop(into)) return true;
        return false;
    }
    [[nodiscard]] bool empty() const noexcept TAPPET_REALTIME {
        const std::size_t inside = rings_.inside.size(), across = rings_.across.size();
        bool none = true;
        for (std::size_t i = 0; i < inside; ++i) none &= rings_.inside[i]->empty();
        for (std::size_t i = 0; i < across; ++i) none &= rings_.across[i]->empty();
        return none;
    }

private:
    friend struct PortAccess;
    BufferRings<T> rings_{};
};

} // namespace tappet
