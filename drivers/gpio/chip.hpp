// Finds a GPIO chip by path or label, and checks in advance that the wanted lines exist and are free.
#pragma once

#include "drivers/gpio/device.hpp"
#include "kernel/base/text.hpp"

#include <expected>
#include <memory>

struct gpiod_chip;

namespace tappet::gpio {

struct CloseChip {
    void operator()(gpiod_chip* chip) const noexcept;
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

/// Not real-time.
std::expected<Chip, Sentence> open_chip(std::string_view path_or_label);
std::expected<void, Sentence> check_lines(gpiod_chip* chip, const Settings& settings);

} // namespace tappet::gpio
