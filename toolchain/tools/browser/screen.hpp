// A terminal for drawing: its size, keys without return, and its state restored afterwards. It is this
// program's own, or one elsewhere.
#pragma once

#include "toolchain/tools/browser/watch_view.hpp"

#include <chrono>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::browser {

enum class Key { quit, up, down, page_up, page_down, other };

/// A terminal that is taken over until the end of this object.
class Screen {
public:
    Screen() = default;
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;
    virtual ~Screen() = default;

    /// Returns true when both ends of this program are a terminal with cursor movements.
    [[nodiscard]] static bool possible();
    [[nodiscard]] virtual Size size() const = 0;
    void show(const std::vector<std::string>& lines) const;
    /// Returns the next key, if one comes within `patience`.
    [[nodiscard]] virtual std::optional<Key> key(std::chrono::milliseconds patience) const = 0;

private:
    virtual void put(std::string_view text) const = 0;
};

/// The terminal at standard input and output. Its state is restored at the end.
[[nodiscard]] std::unique_ptr<const Screen> own_screen();
/// A terminal elsewhere, behind `out`: of fixed size, and without keys, for which `pause` waits. Its own
/// program ends the line.
[[nodiscard]] std::unique_ptr<const Screen> far_screen(std::ostream& out, Size size,
                                                       std::function<void(std::chrono::milliseconds)> pause);
/// Restores a terminal that a line elsewhere drew on.
inline constexpr std::string_view screen_ends = "\x1b[?7h\x1b[?25h\x1b[?1049l";

} // namespace tappet::browser
