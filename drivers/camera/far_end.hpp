// The other end of a camera's wire: the scene before its lens.
#pragma once

#include "drivers/camera/image.hpp"
#include "drivers/twin/far_end.hpp"

#include <cstdint>
#include <span>

namespace tappet::camera {

/// A camera as seen from its scene.
class Wires {
public:
    Wires() = default;
    Wires(const Wires&) = delete;
    Wires& operator=(const Wires&) = delete;
    virtual ~Wires() = default;

    /// Lets the camera send this image at once. Returns false when it is not of the camera's size.
    virtual bool show(std::span<const Colour> pixels, Time stamp) noexcept = 0;
};

///     camera::FarEnd eye{ends, "tracking-camera"};
///     eye.show(image.pixels, now);
class FarEnd final : public tappet::FarEnd {
public:
    FarEnd(FarEnds& of, std::string_view device) : tappet::FarEnd{of, device, "camera"} {}

    /// Sends an image, row by row from the top, at the camera's time `stamp`. Counts refused ones.
    void show(std::span<const Colour> pixels, Time stamp) noexcept {
        if (wires_ == nullptr || !wires_->show(pixels, stamp)) ++refused_;
    }
    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }
    [[nodiscard]] Wires& wire() noexcept { return *wires_; }

    void take(Time) override {}
    void give(Time) override {}

protected:
    bool take_wire(const ProvidedDevice& wire) noexcept override {
        if (wire.type != type_id<Wires>) return false;
        wires_ = static_cast<Wires*>(wire.device);
        return true;
    }

private:
    Wires* wires_ = nullptr;
    std::uint64_t refused_ = 0;
};

} // namespace tappet::camera
