// Numbers its images as Linux does: also those for which no buffer is free.
#include "drivers/camera/twin.hpp"

namespace tappet::camera {

namespace {

bool strike(std::uint32_t& next) noexcept {
    if (next == 0) return false;
    --next;
    return true;
}

} // namespace

void Twin::open(Size size) noexcept {
    size_ = size;
    expect(Format::rgb24, size, size.columns * row_of(Format::rgb24).bytes);
}

void Twin::set_listener(Listener ready, void* context) noexcept {
    ready_ = ready;
    context_ = context;
}

bool Twin::show(std::span<const Colour> pixels, Time stamp) noexcept {
    if (pixels.size() != size_.columns * size_.rows) return false;
    ++sequence_;
    const bool drawn = random_.one_in(faults_.lose_one_in);
    if (strike(faults_.lose_next) || drawn || removed_.load(std::memory_order_relaxed)) return true;
    const bool is_flawed = strike(faults_.flaw_next);
    if (strike(faults_.late_next)) stamp -= faults_.late_by;
    if (strike(faults_.cut_next)) pixels = pixels.first(pixels.size() / 2);
    send(pixels, sequence_, stamp, is_flawed);
    if (strike(faults_.repeat_next)) send(pixels, sequence_, stamp, is_flawed);
    return true;
}

void Twin::send(std::span<const Colour> pixels, std::uint32_t sequence, Time stamp, bool is_flawed) noexcept {
    Buffer* const free = frames_.room();
    if (free == nullptr) return; // the next number shows it
    free->bytes.clear();
    for (const Colour& each : pixels)
        for (const std::uint8_t part : {each.red, each.green, each.blue})
            free->bytes.push_back(std::byte{part});
    free->sequence = sequence;
    free->stamp = stamp;
    free->is_flawed = is_flawed;
    frames_.add();
    arrived_ = true;
}

void Twin::deliver() noexcept {
    if (arrived_ && ready_ != nullptr) ready_(context_);
    arrived_ = false;
}

void Twin::set_removed(bool removed) noexcept {
    removed_.store(removed, std::memory_order_release);
    arrived_ |= removed;
}

CheckedFrames::Fetched Twin::fetch(Raw& raw) noexcept TAPPET_REALTIME {
    if (removed_.load(std::memory_order_acquire)) return Fetched::failed;
    const Buffer* const next = frames_.front();
    if (next == nullptr) return Fetched::nothing;
    raw = {next->bytes, next->sequence, next->stamp, next->is_flawed};
    return Fetched::frame;
}

bool Twin::release() noexcept TAPPET_REALTIME {
    frames_.drop();
    return !removed_.load(std::memory_order_acquire);
}

} // namespace tappet::camera
