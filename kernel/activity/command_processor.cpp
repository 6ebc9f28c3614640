// Acceptance of commands, and their end when their component stops.
#include "kernel/activity/command_processor.hpp"

namespace tappet {

CommandState CommandProcessor::take_up(CommandSlot& slot) noexcept TAPPET_REALTIME {
    const bool planned = slot.route().planned;
    // A command that a row plans always has a place; there may be too many others.
    if (count_ == followed_.size() || (!planned && requests_at_work_ == requests_)) {
        slot.reject();
        return CommandState::rejected;
    }
    if (!slot.begin()) return CommandState::rejected;
    if (!planned) ++requests_at_work_;
    followed_[count_++] = &slot;
    return CommandState::accepted;
}

namespace detail {

// A named function of its own: inlined, it would hide the loop's counter from the check of the object code.
void fail_one(CommandSlot& slot) noexcept TAPPET_REALTIME;
[[gnu::noinline]] void fail_one(CommandSlot& slot) noexcept TAPPET_REALTIME { slot.fail(); }

} // namespace detail

void CommandProcessor::fail(std::uint32_t part) noexcept TAPPET_REALTIME {
    static_cast<void>(follow([part](std::uint32_t of, CommandSlot& slot) noexcept TAPPET_REALTIME {
        if (of != part) return false;
        detail::fail_one(slot);
        return true;
    }));
}

void CommandProcessor::reject_sent() noexcept TAPPET_REALTIME {
    static_cast<void>(
        serve([](std::uint32_t, CommandSlot& slot) noexcept TAPPET_REALTIME { slot.reject(); }));
}

} // namespace tappet
