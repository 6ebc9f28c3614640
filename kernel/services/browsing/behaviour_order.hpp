// A browser's order to a behaviour, on its way to the engine that runs the behaviour.
#pragma once

#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/slots/behaviour_action.hpp"

#include <cstdint>
#include <string_view>

namespace tappet::browsing {

/// Parses an action. False: there is no such action.
constexpr bool parse(std::string_view text, BehaviourAction& action) noexcept {
    for (std::size_t i = 0; i < behaviour_actions.size(); ++i)
        if (behaviour_actions[i] == text) {
            action = static_cast<BehaviourAction>(i);
            return true;
        }
    return false;
}

struct BehaviourOrder {
    BehaviourUnit* unit = nullptr;
    BehaviourSlot* slot = nullptr; ///< holds the unit; null: the unit is a row's own
    const Engine* engine = nullptr;
    std::size_t part = 0;
    StateIndex state = no_state; ///< the requested state
    BehaviourAction action = BehaviourAction::start;
    bool done = false;
};

/// Passes the characters of a request's word to `put`: those between its outer quotes, with escaped quotes
/// and backslashes unescaped. False: the quoting is wrong.
template <class Put>
constexpr bool unquote(std::string_view word, const Put& put) {
    const bool quoted = word.size() >= 2 && word.front() == '"' && word.back() == '"';
    if (quoted) word = word.substr(1, word.size() - 2);
    for (std::size_t i = 0; i < word.size(); ++i) {
        if (quoted && word[i] == '\\') ++i;
        if (i == word.size()) return false;
        put(word[i]);
    }
    return true;
}

} // namespace tappet::browsing
