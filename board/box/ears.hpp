// SPDX-License-Identifier: Apache-2.0
// What PID 1 hears: signals, the notices of its children, what they print, and the power buttons.
#pragma once

#include "board/init/system.hpp"

#include <functional>
#include <string_view>
#include <vector>

namespace tappet::box {

class Ears {
public:
    /// From here on signals wait, and NOTIFY_SOCKET leads here.
    [[nodiscard]] init::Done open();
    /// What is there by then.
    void open_power_buttons();

    /// Until something comes, or the time is over.
    void wait(std::chrono::milliseconds time) const;
    /// Some of it; what is left makes the next wait short.
    void take_prints(const std::function<void(std::string_view piece)>& take) const;
    /// Of who is of our own user: nobody else says that the machine has armed or has proven itself.
    void take_notices(const std::function<void(std::string_view notice)>& take) const;
    void take_signals(const std::function<void(int signal)>& take) const;
    [[nodiscard]] bool power_button_was_pressed() const;

    /// Where a child prints to.
    [[nodiscard]] int mouth() const { return mouth_; }

private:
    int signals_ = -1;
    int notices_ = -1;
    int prints_ = -1;
    int mouth_ = -1;
    std::vector<int> buttons_{};
};

} // namespace tappet::box
