// A terminal that is drawn on: its size, keys without a return, and everything as it was afterwards.
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
    /// Takes the terminal at standard input and output over.
    Screen();
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// Both ends are a terminal that knows cursor movements.
    [[nodiscard]] static bool possible();
    [[nodiscard]] Size size() const;
    void show(const std::vector<std::string>& lines) const;
    /// The next key, if one comes within `patience`.
    [[nodiscard]] std::optional<Key> key(std::chrono::milliseconds patience) const;

private:
    termios before_{};
};

} // namespace tappet::browser
