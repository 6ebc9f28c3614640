// Opens the camera as the board and the binding say.
#include "drivers/camera/real_camera.hpp"

namespace tappet::camera {

std::expected<void, Sentence> RealCamera::open(const DevicePlace& place) {
    return video_.open(place.address, camera_facts(place.of_board, place.bound));
}

ProvidedDevice RealCamera::provided(std::string_view name) noexcept {
    return {type_id<Device>, name, static_cast<Device*>(&video_)};
}

} // namespace tappet::camera
