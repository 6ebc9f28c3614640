// The command processor of an engine (thesis 4.5.2, 5.3): accepts the commands that peers sent, the most
// urgent senders' first, and follows each accepted command to its end. There is room for every planned
// command, so none overflows.
#pragma once

#include "kernel/component/command.hpp"

#include <span>

namespace tappet {

/// Used only by the engine's thread, except inbox().post().
class CommandProcessor {
public:
    /// Sets up the processor, before the first cycle. `followed` has a place for each command that may be at
    /// work; `requests` of these places are for commands that no row of the table plans. Both outlive the
    /// processor.
    void place(std::span<CommandMailbox> mailboxes, std::span<CommandSlot*> followed,
               std::size_t requests) noexcept {
        inbox_.place(mailboxes);
        followed_ = followed;
        requests_ = requests;
        count_ = 0;
        requests_at_work_ = 0;
    }
    [[nodiscard]] CommandInbox& inbox() noexcept TAPPET_REALTIME { return inbox_; }
    [[nodiscard]] bool pending() const noexcept TAPPET_REALTIME { return inbox_.pending(); }
    /// Returns whether a command was sent or is at work.
    [[nodiscard]] bool has_work() const noexcept TAPPET_REALTIME { return count_ != 0 || pending(); }

    /// Gives each sent command, with the part that it is for, to visit(part, slot), which calls take_up().
    /// Returns their number.
    template <class Visit>
    std::size_t serve(Visit&& visit) noexcept TAPPET_REALTIME {
        return inbox_.serve([&visit](const CommandNotice& sent) noexcept TAPPET_REALTIME {
            visit(static_cast<std::uint32_t>(sent.part), *static_cast<CommandSlot*>(sent.slot));
        });
    }
    /// Runs the action; an accepted command is followed from now on. Returns its state.
    CommandState take_up(CommandSlot& slot) noexcept TAPPET_REALTIME;

    /// Gives each command at work, oldest first, to visit(part, slot), which calls slot.follow() and returns
    /// whether the command has ended. Returns whether any has.
    template <class Visit>
    bool follow(Visit&& visit) noexcept TAPPET_REALTIME {
        std::size_t kept = 0;
        const std::size_t count = count_; // no completion can change this bound: a counted loop
        for (std::size_t i = 0; i < count; ++i) {
            CommandSlot* const slot = followed_[i];
            // Read before: when the command has ended, its sender may send it elsewhere.
            const std::uint32_t part = slot->route().part;
            const bool planned = slot->route().planned;
            if (!visit(part, *slot))
                followed_[kept++] = slot;
            else if (!planned)
                --requests_at_work_;
        }
        const bool ended = kept != count;
        count_ = kept;
        return ended;
    }

    /// Fails the commands at work of a component that stops.
    void fail(std::uint32_t part) noexcept TAPPET_REALTIME;
    /// Rejects commands that were sent but not accepted, when the engine stops.
    void reject_sent() noexcept TAPPET_REALTIME;

    [[nodiscard]] std::size_t at_work() const noexcept TAPPET_REALTIME { return count_; }

private:
    CommandInbox inbox_{};
    std::span<CommandSlot*> followed_{};
    std::size_t count_ = 0;
    std::size_t requests_ = 0;
    std::size_t requests_at_work_ = 0;
};

} // namespace tappet
