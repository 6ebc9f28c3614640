// A camera of the host world: the machine takes its frames as from a Device, the plant shows it images.
#pragma once

#include "drivers/camera/checked_frames.hpp"
#include "drivers/camera/far_end.hpp"
#include "drivers/twin/ring.hpp"
#include "kernel/base/random.hpp"

#include <atomic>
#include <vector>

namespace tappet::camera {

/// Injected faults of the next images.
struct Faults {
    std::uint32_t lose_next = 0;   ///< numbered, and never delivered
    std::uint32_t lose_one_in = 0; ///< and one in this many of the others; 0: none
    std::uint32_t flaw_next = 0;   ///< delivered with the device's mark of an error
    std::uint32_t cut_next = 0;    ///< delivered with half of their pixels
    std::uint32_t repeat_next = 0; ///< delivered twice, with the same number
    std::uint32_t late_next = 0;   ///< delivered with a stamp that is `late_by` earlier
    Duration late_by = 10s;
};

/// The Device's calls belong to the machine's thread; show(), deliver() and the faults belong to the plant's.
/// They share only a ring and a flag.
class Twin final : public CheckedFrames, public Wires {
public:
    static constexpr std::size_t buffers = 4; ///< as many as the real device asks for

    explicit Twin(std::uint64_t seed = 1) noexcept : random_{seed} {}

    /// Sets the size of the images. Not real-time, before either thread runs.
    void open(Size size) noexcept;

    [[nodiscard]] int wait_handle() const noexcept TAPPET_REALTIME override { return -1; }
    /// `ready` is called in the plant's thread.
    void set_listener(Listener ready, void* context) noexcept override;

    // The plant's side; not real-time.
    bool show(std::span<const Colour> pixels, Time stamp) noexcept override;
    /// Calls the listener when something has arrived since the last call.
    void deliver() noexcept;
    /// Fault: unplugs the camera. Every call is refused, and the listener is called, as a descriptor hangs
    /// up. `false` brings it back.
    void set_removed(bool removed) noexcept;
    [[nodiscard]] Faults& faults() noexcept { return faults_; }

protected:
    Fetched fetch(Raw& raw) noexcept TAPPET_REALTIME override;
    bool release() noexcept TAPPET_REALTIME override;

private:
    struct Buffer {
        std::vector<std::byte> bytes{}; ///< the plant's thread alone lets it grow
        std::uint32_t sequence = 0;
        Time stamp{};
        bool is_flawed = false;
    };
    void send(std::span<const Colour> pixels, std::uint32_t sequence, Time stamp, bool is_flawed) noexcept;

    twin::Ring<Buffer, buffers> frames_{};
    std::atomic<bool> removed_{false};
    Size size_{};
    // Used by the plant's thread only.
    Random random_;
    Faults faults_{};
    std::uint32_t sequence_ = 0;
    bool arrived_ = false;
    Listener ready_ = nullptr;
    void* context_ = nullptr;
};

} // namespace tappet::camera
