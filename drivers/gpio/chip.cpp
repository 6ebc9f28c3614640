// Chips are numbered in the order of their detection, so a board names them by label where it can.
#include "drivers/gpio/chip.hpp"

#include <cerrno>
#include <cstring>
#include <dirent.h>
#include <gpiod.h>
#include <string>

namespace tappet::gpio {
namespace {

Chip find_by_label(std::string_view label) {
    struct CloseDirectory {
        void operator()(DIR* directory) const noexcept { ::closedir(directory); }
    };
    const std::unique_ptr<DIR, CloseDirectory> devices{::opendir("/dev")};
    if (!devices) return nullptr;
    while (const dirent* entry = ::readdir(devices.get())) {
        const std::string path = std::string{"/dev/"} + entry->d_name;
        if (!path.starts_with("/dev/gpiochip")) continue;
        Chip chip{gpiod_chip_open(path.c_str())};
        gpiod_chip_info* info = chip ? gpiod_chip_get_info(chip.get()) : nullptr;
        const bool found = info != nullptr && label == gpiod_chip_info_get_label(info);
        gpiod_chip_info_free(info);
        if (found) return chip;
    }
    return nullptr;
}

} // namespace

void CloseChip::operator()(gpiod_chip* chip) const noexcept { gpiod_chip_close(chip); }

std::expected<Chip, Sentence> open_chip(std::string_view path_or_label) {
    const bool is_path = path_or_label.starts_with('/');
    errno = ENODEV;
    Chip chip =
        is_path ? Chip{gpiod_chip_open(std::string{path_or_label}.c_str())} : find_by_label(path_or_label);
    if (chip) return chip;
    if (is_path)
        return std::unexpected{
            Sentence{"GPIO chip \"", path_or_label, "\" cannot be opened: ", strerrordesc_np(errno),
                     "; load its driver or name another in the board (gpiodetect lists them)"}};
    return std::unexpected{
        Sentence{"no GPIO chip is labelled \"", path_or_label,
                 "\": load its driver or name another in the board (gpiodetect lists them)"}};
}

std::expected<void, Sentence> check_lines(gpiod_chip* chip, const Settings& settings) {
    for (const Line& line : settings.lines) {
        const Sentence who{"GPIO line \"", line.name,     "\", line ", line.offset,
                           " of chip \"",  settings.chip, "\","};
        gpiod_line_info* info = gpiod_chip_get_line_info(chip, line.offset);
        if (info == nullptr)
            return std::unexpected{
                Sentence{who, " does not exist: correct the offset in the board (gpioinfo lists them)"}};
        const bool used = gpiod_line_info_is_used(info);
        const char* consumer = gpiod_line_info_get_consumer(info);
        const Sentence by{consumer != nullptr ? consumer : "the kernel"};
        gpiod_line_info_free(info);
        if (used)
            return std::unexpected{
                Sentence{who, " is in use by \"", by, "\": stop that, or name another line in the board"}};
    }
    return {};
}

} // namespace tappet::gpio
