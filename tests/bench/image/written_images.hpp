// The images that the tests' fixtures wrote, the slots of a box that is switched off, and an engineer's
// requests.
#pragma once

#include "board/box/slot.hpp"
#include "tests/bench/image/emulated_box.hpp"
#include "tests/toolchain/program.hpp"
#include "toolchain/tools/image/slots.hpp"
#include "toolchain/tools/image/tool.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace tappet::bench {

/// One folder for each image.
inline std::filesystem::path image(const char* name) { return std::filesystem::path{IMAGES} / name; }

inline init::BootState slot(const EmulatedBox& box, std::size_t number) {
    return image::read_slot(box.disk(), image::partitions()[number]).value_or(init::BootState{});
}

/// The version has proven itself: the next start is a trial, or will be when both slots have been read.
inline bool has_kept(const EmulatedBox& box, std::size_t number) {
    const init::SlotState state = slot(box, number).state;
    return state == init::SlotState::good || state == init::SlotState::installed;
}

/// Changes a byte while the box is off: `behind` bytes after the first occurrence of these bytes in a slot.
inline void change_byte(const EmulatedBox& box, std::size_t number, const std::string& bytes,
                        std::size_t behind) {
    const image::Partition& partition = image::partitions()[number];
    std::fstream disk{box.disk(), std::ios::binary | std::ios::in | std::ios::out};
    std::string slot(partition.bytes(), '\0');
    const auto begin = static_cast<std::streamoff>(partition.first_sector * image::sector_bytes);
    disk.seekg(begin);
    disk.read(slot.data(), static_cast<std::streamsize>(slot.size()));
    const std::size_t at = slot.find(bytes);
    if (at == std::string::npos) throw std::runtime_error("the slot does not hold these bytes");
    disk.seekp(begin + static_cast<std::streamoff>(at + behind));
    disk.put(static_cast<char>(slot[at + behind] ^ 0x55));
}

/// Runs tappet-image like an engineer at a desk.
inline std::string asked(const std::string& words) {
    return run_line(std::string{TAPPET_IMAGE} + " " + words).text;
}

/// The last line of a start: slots, buttons and the service are ready, and the machine has armed.
inline constexpr const char* is_complete = "service: it listens";

} // namespace tappet::bench
