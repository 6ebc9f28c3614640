// One judgement of each frame: number, mark, size, time.
#include "drivers/camera/checked_frames.hpp"

#include <algorithm>

namespace tappet::camera {

void CheckedFrames::expect(Format format, Size size, std::size_t row_bytes) noexcept {
    format_ = format;
    row_bytes_ = row_bytes;
    bytes_ =
        row_bytes * (size.rows - 1) + size.columns * row_of(format).bytes; // the last row need not be padded
    is_first_ = true;
}

Taken CheckedFrames::take(Frame& frame, Time oldest, Time now) noexcept TAPPET_REALTIME {
    belongs_to_.used();
    Raw raw;
    switch (fetch(raw)) {
    case Fetched::nothing: return Taken::nothing;
    case Fetched::failed: ++count_.failures; return Taken::failed;
    case Fetched::frame: break;
    }
    if (!is_good(raw, oldest, now)) return give_back() ? Taken::refused : Taken::failed;
    ++count_.frames;
    frame = {raw.bytes, format_, row_bytes_, std::min(raw.stamp, now)};
    return Taken::frame;
}

bool CheckedFrames::give_back() noexcept TAPPET_REALTIME {
    if (release()) return true;
    ++count_.failures;
    return false;
}

void CheckedFrames::begin_anew() noexcept TAPPET_REALTIME {
    belongs_to_.used();
    Raw raw;
    for (std::size_t i = 0; i < most_waiting; ++i)
        if (fetch(raw) != Fetched::frame || !give_back()) break;
    is_first_ = true;
}

bool CheckedFrames::is_good(const Raw& raw, Time oldest, Time now) noexcept TAPPET_REALTIME {
    const std::uint32_t ahead = is_first_ ? 1 : raw.sequence - sequence_; // wraps like the kernel's own count
    const bool is_earlier = ahead == 0 || ahead > UINT32_MAX / 2;
    if (is_earlier || (!is_first_ && raw.stamp <= stamp_)) ++count_.repeated;
    if (is_earlier) return false;
    count_.lost += ahead - 1;
    sequence_ = raw.sequence;
    if (!is_first_ && raw.stamp <= stamp_) return false;
    if (raw.is_flawed || raw.bytes.size() < bytes_ || raw.stamp > now + ahead_at_most) {
        ++count_.flawed;
        return false;
    }
    is_first_ = false;
    stamp_ = raw.stamp;
    if (raw.stamp >= oldest) return true;
    ++count_.late;
    return false;
}

} // namespace tappet::camera
