// What a browser tells a behaviour to do, on its way to the engine that runs it.
#pragma once

#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/slots/behaviour_action.hpp"

#include <cstdint>
#include <string_view>

namespace tappet::browsing {

/// False: there is no such action.
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
    BehaviourSlot* slot = nullptr; ///< that holds the unit; null: a row's own
    const Engine* engine = nullptr;
    std::size_t part = 0;
    StateIndex state = no_state; ///< that is requested
    BehaviourAction action = BehaviourAction::start;
    bool done = false;
};

/// The characters of a word of a request: what stands between its outer quotes, \" and \\ for themselves.
/// False: it is not quoted well.
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
