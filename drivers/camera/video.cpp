// The calls of V4L2 in order. While the machine runs, only a buffer is taken and given back: two ioctls that
// do not wait.
#include "drivers/camera/video.hpp"

#include "drivers/camera/offers.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace tappet::camera {

namespace {

v4l2_buffer buffer(unsigned index = 0) noexcept TAPPET_REALTIME {
    v4l2_buffer made{};
    made.index = index;
    made.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    made.memory = V4L2_MEMORY_MMAP;
    return made;
}

Sentence refused(std::string_view what, int error) {
    return Sentence{what, ": ", std::string_view{std::strerror(error)}, "; end the program that uses it"};
}

} // namespace

std::expected<void, Sentence> Video::open(std::string_view path, const CameraFacts& wanted) {
    close();
    fd_ = ::open(std::string{path}.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (fd_ < 0)
        return std::unexpected(
            Sentence{"it cannot be opened: ", std::string_view{std::strerror(errno)},
                     "; plug the camera in and load its driver, or name another device in the "
                     "board (v4l2-ctl --list-devices lists them)"});
    auto done = set_up(wanted);
    if (done) done = share_memory();
    if (!done) close();
    return done;
}

std::expected<void, Sentence> Video::set_up(const CameraFacts& wanted) {
    v4l2_capability found{};
    constexpr std::uint32_t needed = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    if (request(fd_, VIDIOC_QUERYCAP, &found) != 0 || (found.device_caps & needed) != needed)
        return std::unexpected(Sentence{"it is no camera that streams; name another device in the board "
                                        "(v4l2-ctl --list-devices lists them)"});
    const auto row_bytes = set_picture(fd_, wanted);
    if (!row_bytes) return std::unexpected(row_bytes.error());
    expect(wanted.format, wanted.size, *row_bytes);
    return {};
}

std::expected<void, Sentence> Video::share_memory() {
    v4l2_requestbuffers asked{};
    asked.count = buffers;
    asked.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    asked.memory = V4L2_MEMORY_MMAP;
    if (const int error = request(fd_, VIDIOC_REQBUFS, &asked); error != 0)
        return std::unexpected(refused("it does not share its memory", error));
    if (asked.count < 2)
        return std::unexpected(Sentence{"it has memory for fewer than 2 frames; take a smaller size"});
    for (unsigned i = 0; i < std::min(asked.count, buffers); ++i) {
        v4l2_buffer each = buffer(i);
        if (const int error = request(fd_, VIDIOC_QUERYBUF, &each); error != 0)
            return std::unexpected(refused("it does not show its memory", error));
        if ((each.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC)
            return std::unexpected(
                Sentence{"its driver does not stamp frames with the box's monotonic time, so "
                         "their age is unknown; use another camera"});
        void* const at = ::mmap(nullptr, each.length, PROT_READ, MAP_SHARED, fd_, each.m.offset);
        if (at == MAP_FAILED) return std::unexpected(refused("its memory cannot be mapped", errno));
        memory_[i] = {static_cast<std::byte*>(at), each.length};
        if (const int error = request(fd_, VIDIOC_QBUF, &each); error != 0)
            return std::unexpected(refused("it does not take its memory back", error));
    }
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (const int error = request(fd_, VIDIOC_STREAMON, &type); error != 0)
        return std::unexpected(refused("it does not stream", error));
    forget_counts();
    return {};
}

void Video::close() noexcept {
    for (std::span<std::byte>& each : memory_) {
        if (!each.empty()) ::munmap(each.data(), each.size());
        each = {};
    }
    if (fd_ >= 0) ::close(fd_); // ends the stream
    fd_ = -1;
}

CheckedFrames::Fetched Video::fetch(Raw& raw) noexcept TAPPET_REALTIME {
    v4l2_buffer filled = buffer();
    int error = 0;
    TAPPET_ESCAPE("the driver's own input, which does not wait",
                  error = ::ioctl(fd_, VIDIOC_DQBUF, &filled) == 0 ? 0 : errno);
    if (error != 0) return error == EAGAIN || error == EINTR ? Fetched::nothing : Fetched::failed;
    fetched_ = filled.index;
    if (fetched_ >= buffers) return Fetched::failed; // the kernel names only buffers that were given to it
    raw.bytes = memory_[fetched_].first(std::min<std::size_t>(filled.bytesused, memory_[fetched_].size()));
    raw.sequence = filled.sequence;
    raw.stamp = at_ns(filled.timestamp.tv_sec * 1'000'000'000L + filled.timestamp.tv_usec * 1'000L);
    raw.is_flawed = (filled.flags & V4L2_BUF_FLAG_ERROR) != 0;
    return Fetched::frame;
}

bool Video::release() noexcept TAPPET_REALTIME {
    v4l2_buffer empty = buffer(fetched_);
    int result = -1;
    TAPPET_ESCAPE("gives a buffer back, without waiting", result = ::ioctl(fd_, VIDIOC_QBUF, &empty));
    return result == 0;
}

} // namespace tappet::camera
