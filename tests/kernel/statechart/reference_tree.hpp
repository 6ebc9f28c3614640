// The states of the reference interpreter as a tree of names: who is inside whom, which are active, and which
// a transition enters.
#pragma once

#include "kernel/statechart/table.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace tappet {

class ReferenceTree {
public:
    using Name = std::string_view;
    using Names = std::vector<Name>;

protected:
    enum class Phase : std::uint8_t { fresh, under_way, waits, ran, asked, done, held };
    struct Active {
        Phase phase = Phase::fresh;
        int stage = 0;
        Time entered{};
    };
    explicit ReferenceTree(const StateMachineTable& table) : table_{table} {
        for (const StateRow& row : table_.states)
            if (row.parent.empty()) arrange(row.name);
    }

    [[nodiscard]] const StateRow& state(Name name) const {
        for (const StateRow& row : table_.states)
            if (row.name == name) return row;
        std::abort();
    }
    [[nodiscard]] Names regions(Name name) const {
        Names found;
        for (const StateRow& row : table_.states)
            if (row.parent == name && std::ranges::find(found, row.region) == found.end())
                found.push_back(row.region);
        return found;
    }
    void arrange(Name name) {
        order_.push_back(name);
        for (Name region : regions(name))
            for (const StateRow& row : table_.states)
                if (row.parent == name && row.region == region) arrange(row.name);
    }
    [[nodiscard]] Names chain(Name name) const {
        Names up;
        for (; !name.empty(); name = state(name).parent) up.insert(up.begin(), name);
        return up;
    }
    [[nodiscard]] bool inside(Name name, Name outer) const {
        return std::ranges::count(chain(name), outer) != 0;
    }
    [[nodiscard]] Name initial_top() const {
        for (const StateRow& row : table_.states)
            if (row.initial && row.parent.empty()) return row.name;
        std::abort();
    }
    [[nodiscard]] Names listed() const {
        Names found;
        for (Name name : order_)
            if (active_.contains(name)) found.push_back(name);
        return found;
    }
    [[nodiscard]] std::optional<Name> child(Name outer, Name region) const {
        for (const StateRow& row : table_.states)
            if (row.parent == outer && row.region == region && active_.contains(row.name)) return row.name;
        return {};
    }
    [[nodiscard]] bool in_final() const {
        return std::ranges::any_of(active_, [this](const auto& each) { return state(each.first).final; });
    }
    /// The outermost state that a transition leaves, and the depth of what stays around it.
    [[nodiscard]] std::size_t shared(Name from, Name to) const {
        Names source = chain(from), target = chain(to);
        source.pop_back(); // neither of the two stays
        target.pop_back();
        std::size_t depth = 0;
        while (depth < source.size() && depth < target.size() && source[depth] == target[depth]) ++depth;
        return depth;
    }
    void collect(Names& into, Name name, Name target, EntryKind enters) const {
        into.push_back(name);
        const Names way = chain(target);
        for (Name region : regions(name)) {
            const auto at = std::ranges::find(way, name);
            if (at != way.end() && at + 1 != way.end() && state(*(at + 1)).region == region) {
                collect(into, *(at + 1), target, enters);
                continue;
            }
            const bool deep = enters == EntryKind::deep_history && inside(name, target);
            std::optional<Name> next;
            if (deep || (enters == EntryKind::shallow_history && name == target)) {
                next = child(name, region);
                if (const auto last = last_.find({name, region}); !next && last != last_.end())
                    next = last->second;
            }
            for (const StateRow& row : table_.states)
                if (!next && row.parent == name && row.region == region && row.initial) next = row.name;
            collect(into, *next, target, enters);
        }
    }
    [[nodiscard]] Names entries(Name target, std::size_t kept, EntryKind enters) const {
        Names names;
        collect(names, chain(target)[kept], target, enters);
        return names;
    }

    StateMachineTable table_;
    Names order_; // all states, each before those inside it
    std::map<Name, Active> active_;
    std::map<std::pair<Name, Name>, Name> last_; // by composite and region
};

} // namespace tappet
