// Connect and disconnect one reaction row while the machine runs (thesis 4.6.2: the handle).
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/component/facet_member.hpp"

#include <atomic>
#include <cstdint>
#include <utility>

namespace tappet {

/// A member of a component that a row names with handled_by(...). A copy stands for the same row. Everything
/// is real-time and wait-free, from any thread, also from a reaction of the same or another event.
///
/// After disconnect() returned, no emission begun later reaches the reaction, and waiting earlier emissions
/// are dropped when their turn comes. The guarantee has two limits: a reaction that another thread has begun
/// to run may still be running, and an emission in progress on another thread may run a synchronous reaction
/// that it already found connected. When connect() and disconnect() run at the same time, the one whose
/// atomic operation comes last holds, and an emission in between may be dropped.
class EventHandle : FacetMember<member::handle> {
public:
    EventHandle() = default;
    /// `epoch`: that of an asynchronous row, else null. Start-up makes the handles that rows name.
    EventHandle(std::atomic<std::uint64_t>& connected, std::uint64_t bit,
                std::atomic<std::uint32_t>* epoch) noexcept
        : connected_{&connected}, bit_{bit}, epoch_{epoch} {}

    /// Connects the row. No effect on a row that is connected, or on a handle that no row names.
    void connect() const noexcept TAPPET_REALTIME {
        if (connected_ == nullptr) return;
        // Here and below the result stays unused: with it both compilers would emit a compare-and-exchange
        // loop.
        connected_->fetch_or(bit_, std::memory_order_release); // connect.bit
    }
    void disconnect() const noexcept TAPPET_REALTIME {
        if (connected_ == nullptr) return;
        connected_->fetch_and(~bit_, std::memory_order_release);                // disconnect.bit
        if (epoch_ != nullptr) epoch_->fetch_add(1, std::memory_order_release); // disconnect.epoch
    }
    [[nodiscard]] bool connected() const noexcept TAPPET_REALTIME {
        if (connected_ == nullptr) return false;
        const std::uint64_t rows =
            connected_->load(std::memory_order_acquire); // no step: nobody acts upon it
        return (rows & bit_) != 0;
    }
    /// Returns whether the handle stands for a row.
    [[nodiscard]] bool valid() const noexcept TAPPET_REALTIME { return connected_ != nullptr; }

private:
    std::atomic<std::uint64_t>* connected_ = nullptr;
    std::uint64_t bit_ = 0;
    std::atomic<std::uint32_t>* epoch_ = nullptr;
};

/// Keeps a row connected as long as it lives.
class ScopedEventHandle {
    static constexpr EventHandle nothing{};

public:
    ScopedEventHandle() = default;
    explicit ScopedEventHandle(const EventHandle& handle) noexcept TAPPET_REALTIME : handle_{handle} {
        handle_.connect();
    }
    ~ScopedEventHandle() TAPPET_REALTIME { handle_.disconnect(); }
    ScopedEventHandle(ScopedEventHandle&& other) noexcept TAPPET_REALTIME
        : handle_{std::exchange(other.handle_, nothing)} {}
    ScopedEventHandle& operator=(ScopedEventHandle&& other) noexcept TAPPET_REALTIME {
        if (this == &other) return *this;
        handle_.disconnect();
        handle_ = std::exchange(other.handle_, nothing);
        return *this;
    }
    ScopedEventHandle(const ScopedEventHandle&) = delete;
    ScopedEventHandle& operator=(const ScopedEventHandle&) = delete;

    [[nodiscard]] bool connected() const noexcept TAPPET_REALTIME { return handle_.connected(); }

private:
    EventHandle handle_ = nothing; // a copy is no member that interface() lists
};

} // namespace tappet
