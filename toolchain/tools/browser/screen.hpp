// A terminal for drawing: its size, keys without return, and its state restored afterwards.
#pragma once

#include "toolchain/tools/browser/watch_view.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <termios.h>

namespace tappet::browser {

enum class Key { quit, up, down, page_up, page_down, other };

class Screen {
public:
    /// Takes over the terminal at standard input and output.
    Screen();
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// Returns true when both ends are a terminal with cursor movements.
    [[nodiscard]] static bool possible();
    [[nodiscard]] Size size() const;
    void show(const std::vector<std::string>& lines) const;
    /// Returns the next key, if one comes within `patience`.
    [[nodiscard]] std::optional<Key> key(std::chrono::milliseconds patience) const;

private:
    termios before_{};
};

} // namespace tappet::browser
