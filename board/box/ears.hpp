// SPDX-License-Identifier: Apache-2.0
// The inputs of PID 1: signals, the notices and the output of its children, and the power buttons.
#pragma once

#include "board/init/system.hpp"

#include <functional>
#include <string_view>
#include <vector>

namespace tappet::box {

class Ears {
public:
    /// Starts to queue signals, and sets NOTIFY_SOCKET to this.
    [[nodiscard]] init::Done open();
    /// Opens the buttons that are present at this time.
    void open_power_buttons();

    /// Waits until something arrives, or the time is over.
    void wait(std::chrono::milliseconds time) const;
    /// Takes some of the output; a rest makes the next wait() short.
    void take_prints(const std::function<void(std::string_view piece)>& take) const;
    /// Takes notices of init's own user only: no other may report that the machine armed or proved itself.
    void take_notices(const std::function<void(std::string_view notice)>& take) const;
    void take_signals(const std::function<void(int signal)>& take) const;
    [[nodiscard]] bool power_button_was_pressed() const;

    /// Returns the descriptor for a child's output.
    [[nodiscard]] int mouth() const { return mouth_; }

private:
    int signals_ = -1;
    int notices_ = -1;
    int prints_ = -1;
    int mouth_ = -1;
    std::vector<int> buttons_{};
};

} // namespace tappet::box
