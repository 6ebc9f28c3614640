// Takes the offset of each line of the map from the binding.
#include "drivers/gpio/real_chip.hpp"

#include "drivers/gpio/line_map.hpp"

namespace tappet::gpio {

std::expected<void, Sentence> RealChip::open(const DevicePlace& to) {
    address_ = to.address;
    const auto& map = *static_cast<const std::span<const LineRow>*>(to.map);
    place(map, [&to](std::string_view name) { return offset_of(to.bound, name); }, lines_);
    return chip_.open({to.address, std::span{lines_}.first(map.size())});
}

std::expected<void, Sentence> RealChip::prepare_safe_ending() {
    if (chip_.make_safe()) return {};
    return std::unexpected(
        Sentence{"GPIO chip \"", address_,
                 "\" does not take the safe values of its lines; see that it is still there"});
}

} // namespace tappet::gpio
