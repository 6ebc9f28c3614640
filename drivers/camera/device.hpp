// A camera as its component sees it; implemented by Linux's video devices and by the twin.
#pragma once

#include "drivers/camera/kind.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/component/one_activity.hpp"
#include "kernel/component/wire_counters.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tappet::camera {

/// A frame in the device's memory.
struct Frame {
    std::span<const std::byte> bytes{}; ///< row by row; valid until Device::give_back()
    Format format = Format::yuyv;
    std::size_t row_bytes = 0; ///< from one row to the next
    Time stamp{};              ///< of the device's driver: begin of the exposure or end of the transfer
};

enum class Taken : std::uint8_t {
    nothing, ///< no frame has arrived
    frame,   ///< a good one, which must be given back
    refused, ///< a frame arrived, was counted and given back; ask again
    failed   ///< the device refuses: it is gone
};

/// Since the device was opened.
struct Counters {
    std::uint64_t frames = 0;   ///< good ones
    std::uint64_t lost = 0;     ///< by their sequence numbers: no buffer was free, or the wire dropped them
    std::uint64_t flawed = 0;   ///< marked by the device, incomplete, or with a time of the future
    std::uint64_t repeated = 0; ///< with the number or the time of an earlier one
    std::uint64_t late = 0;     ///< too old
    std::uint64_t failures = 0; ///< refused calls
    bool operator==(const Counters&) const = default;

    void tell(WireCounters& into) const noexcept {
        into.add("camera_frames_lost", lost + flawed + repeated + late);
    }
};

/// All calls are real-time and belong to one activity.
class Device {
public:
    virtual ~Device() = default;

    /// Takes the next frame, oldest first. One with a stamp before `oldest` is late, one of the future, as
    /// seen at `now`, flawed.
    virtual Taken take(Frame& frame, Time oldest, Time now) noexcept TAPPET_REALTIME = 0;
    /// Returns the memory of the frame taken last. Returns false when the device refuses.
    virtual bool give_back() noexcept TAPPET_REALTIME = 0;
    /// Drops what has arrived; the next frame is the first, and none was lost before it.
    virtual void begin_anew() noexcept TAPPET_REALTIME = 0;
    [[nodiscard]] virtual Counters counters() const noexcept TAPPET_REALTIME = 0;

    /// Returns the descriptor to wait on; -1 for a twin, which calls its listener instead.
    [[nodiscard]] virtual int wait_handle() const noexcept TAPPET_REALTIME = 0;
    using Listener = void (*)(void*) noexcept TAPPET_REALTIME;
    virtual void set_listener(Listener ready, void* context) noexcept = 0;

protected:
    OneActivity belongs_to_; ///< checked by every call that belongs to the activity; copies do not have it
};

} // namespace tappet::camera
