// The border of a camera, common to the real one and its twin: decides which frames are good, and counts the
// others.
#pragma once

#include "drivers/camera/device.hpp"

namespace tappet::camera {

class CheckedFrames : public Device {
public:
    static constexpr std::size_t most_waiting = 8; ///< frames that a device holds for its component
    /// Linux converts the clock of a USB camera to its own, with an error of some ms. A stamp that is ahead
    /// by no more becomes the present; a later one is of the future.
    static constexpr Duration ahead_at_most = 10ms;

    Taken take(Frame& frame, Time oldest, Time now) noexcept TAPPET_REALTIME final;
    bool give_back() noexcept TAPPET_REALTIME final;
    void begin_anew() noexcept TAPPET_REALTIME final;
    [[nodiscard]] Counters counters() const noexcept TAPPET_REALTIME final { return count_; }

protected:
    /// A frame as the device delivers it.
    struct Raw {
        std::span<const std::byte> bytes{};
        std::uint32_t sequence = 0;
        Time stamp{};
        bool is_flawed = false; ///< the device says so
    };
    enum class Fetched : std::uint8_t { nothing, frame, failed };

    /// Takes the next frame from the device. Does not wait.
    virtual Fetched fetch(Raw& raw) noexcept TAPPET_REALTIME = 0;
    /// Gives the frame fetched last back to the device.
    virtual bool release() noexcept TAPPET_REALTIME = 0;

    /// Frames of another size are flawed.
    void expect(Format format, Size size, std::size_t row_bytes) noexcept;
    void forget_counts() noexcept { count_ = {}; }

private:
    [[nodiscard]] bool is_good(const Raw& raw, Time oldest, Time now) noexcept TAPPET_REALTIME;

    Format format_ = Format::yuyv;
    std::size_t row_bytes_ = 0;
    std::size_t bytes_ = 0;
    Counters count_{};
    bool is_first_ = true;
    std::uint32_t sequence_ = 0; // of the last frame
    Time stamp_{};               // of the last good frame
};

} // namespace tappet::camera
