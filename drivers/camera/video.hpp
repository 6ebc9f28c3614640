// A camera behind Linux's video devices (V4L2), which stream into memory that both share.
#pragma once

#include "drivers/camera/checked_frames.hpp"

#include <array>
#include <expected>
#include <string_view>

namespace tappet::camera {

class Video final : public CheckedFrames {
public:
    static constexpr unsigned buffers = 4;

    Video() = default;
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;
    ~Video() override { close(); }

    /// Opens the camera and lets it stream until close(). Not real-time. Refuses a camera that does not offer
    /// exactly the format, size, rate and exposure: the error says what it offers. On failure nothing stays
    /// open.
    std::expected<void, Sentence> open(std::string_view path, const CameraFacts& wanted);
    void close() noexcept;

    [[nodiscard]] int wait_handle() const noexcept TAPPET_REALTIME override { return fd_; }
    void set_listener(Listener, void*) noexcept override {} // the descriptor becomes readable instead

protected:
    Fetched fetch(Raw& raw) noexcept TAPPET_REALTIME override;
    bool release() noexcept TAPPET_REALTIME override;

private:
    std::expected<void, Sentence> set_up(const CameraFacts& wanted);
    std::expected<void, Sentence> share_memory();

    int fd_ = -1;
    std::array<std::span<std::byte>, buffers> memory_{};
    unsigned fetched_ = 0; // the buffer fetched last
};

} // namespace tappet::camera
