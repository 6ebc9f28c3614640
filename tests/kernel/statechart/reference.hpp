// A second interpreter of the flat form, to compare the first with: it walks the hierarchy by names at run
// time, with heap and maps, and shares nothing with the resolver or the execution but the rows.
#pragma once

#include "kernel/statechart/table.hpp"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tappet {

class ReferenceMachine {
public:
    ReferenceMachine(StateMachineTable table, void* component) : table_{table}, component_{component} {}

    void start(Time now) {
        if (!active_.empty()) return;
        busy_ = true;
        conditions_left_ = false;
        for (const StateRow& row : table_.states)
            if (row.initial && row.parent.empty()) enter(row.name, now);
        ++transitions;
        busy_ = false;
        settle(now);
    }
    void deactivate() {
        if (active_.empty() || busy_) return;
        raised_.clear();
        busy_ = leaving_ = true;
        leave_down_to(0);
        leaving_ = busy_ = final_wanted_ = conditions_left_ = false;
        ++transitions;
    }
    void dispatch(std::string_view event, Time now) {
        const auto names_it = [event](const TransitionRow& row) {
            return row.on_event && row.event == event;
        };
        if (active_.empty() || leaving_ || std::ranges::none_of(table_.transitions, names_it)) return;
        if (busy_ || !raised_.empty()) {
            if (raised_.size() < 8)
                raised_.emplace_back(event);
            else
                ++lost;
            if (!busy_) settle(now);
            return;
        }
        busy_ = true;
        take_event(event, now);
        busy_ = false;
        settle(now);
    }
    void step(Time now) {
        if (active_.empty() || busy_) return;
        busy_ = true;
        stepped_at_ = now;
        serve_final(now);
        std::set<std::string_view> ran;
        held_.clear();
        entered_now_ = active_;
        conditions_left_ = false;
        for (int taken = 0;;) {
            const std::vector<std::string_view> fresh = std::exchange(entered_now_, {});
            for (std::string_view name : fresh) {
                if (state(name).run.empty()) continue;
                if (!ran.insert(name).second)
                    held_.insert(name);
                else
                    call(state(name).run.call);
            }
            if (final_wanted_) {
                serve_final(now);
                if (!entered_now_.empty()) continue;
            }
            if (!take_condition(now)) break;
            serve_final(now);
            if (++taken == 8) {
                conditions_left_ = true;
                break;
            }
        }
        if (!conditions_left_)
            for (std::string_view name : std::vector{active_})
                if (!held_.contains(name)) call(state(name).handle.call);
        held_.clear();
        busy_ = false;
        settle(now);
    }
    void request_final(Time now, std::string_view why) {
        if (active_.empty() || leaving_ || (!busy_ && in_final())) return;
        final_wanted_ = true;
        final_reason_ = why;
        if (!busy_) settle(now);
    }
    void request_initial(Time now) {
        if (busy_ || active_.empty() || !in_final()) return;
        busy_ = true;
        leave_down_to(0);
        for (const StateRow& row : table_.states)
            if (row.initial && row.parent.empty()) enter(row.name, now);
        ++transitions;
        busy_ = false;
        settle(now);
    }

    [[nodiscard]] std::string path() const {
        std::string text;
        for (std::string_view name : active_) text.append("/").append(name);
        return text;
    }
    [[nodiscard]] bool left_over() const { return conditions_left_ || !raised_.empty(); }
    [[nodiscard]] Time next_timeout() const {
        if (active_.empty()) return never;
        if (left_over()) return stepped_at_;
        Time earliest = never;
        for (const TransitionRow& row : table_.transitions)
            for (std::string_view name : active_)
                if (row.timed && row.from == name && entered_.at(name) + row.after > stepped_at_)
                    earliest = std::min(earliest, entered_.at(name) + row.after);
        return earliest;
    }
    std::size_t transitions = 0;
    std::size_t lost = 0;
    std::string reason;

private:
    void call(StateProgram program) const {
        if (program != nullptr) program(component_);
    }
    [[nodiscard]] const StateRow& state(std::string_view name) const {
        for (const StateRow& row : table_.states)
            if (row.name == name) return row;
        std::abort();
    }
    [[nodiscard]] bool in_final() const { return state(active_.back()).final; }
    [[nodiscard]] std::vector<std::string_view> chain(std::string_view name) const {
        std::vector<std::string_view> up;
        for (; !name.empty(); name = state(name).parent) up.insert(up.begin(), name);
        return up;
    }
    void enter(std::string_view target, Time now) {
        for (std::string_view name : chain(target)) {
            if (std::find(active_.begin(), active_.end(), name) != active_.end()) continue;
            active_.push_back(name);
            entered_[name] = now;
            entered_now_.push_back(name);
            call(state(name).entry.call);
        }
        for (const StateRow& row : table_.states)
            if (row.initial && row.parent == target) return enter(row.name, now);
    }
    void leave_down_to(std::size_t level) {
        while (active_.size() > level) {
            call(state(active_.back()).exit.call);
            held_.erase(active_.back());
            std::erase(entered_now_, active_.back());
            active_.pop_back();
        }
    }
    void fire(const TransitionRow& row, Time now) {
        if (!row.because.empty()) reason = row.because;
        call(row.then.call);
        if (!row.to.empty()) {
            auto source = chain(row.from);
            auto target = chain(row.to);
            source.pop_back(); // neither of the two stays
            target.pop_back();
            std::size_t shared = 0;
            while (shared < source.size() && shared < target.size() && source[shared] == target[shared])
                ++shared;
            leave_down_to(shared);
            enter(row.to, now);
        }
        ++transitions;
    }
    bool take_event(std::string_view event, Time now) {
        for (auto name = active_.rbegin(); name != active_.rend(); ++name)
            for (const TransitionRow& row : table_.transitions) {
                if (row.from != *name || !row.on_event || row.event != event) continue;
                if (!row.guard.empty() && !row.guard.call(component_)) continue;
                fire(row, now);
                return true;
            }
        return false;
    }
    bool take_condition(Time now) {
        for (auto name = active_.rbegin(); name != active_.rend(); ++name)
            for (const TransitionRow& row : table_.transitions) {
                if (row.from != *name || row.on_event || held_.contains(*name)) continue;
                if (row.timed && now - entered_[*name] < row.after) continue;
                if (!row.guard.empty() && !row.guard.call(component_)) continue;
                fire(row, now);
                return true;
            }
        return false;
    }
    void serve_final(Time now) {
        if (!final_wanted_) return;
        final_wanted_ = false;
        if (in_final()) return;
        if (!final_reason_.empty()) reason = final_reason_;
        leave_down_to(0);
        for (const StateRow& row : table_.states)
            if (row.final) enter(row.name, now);
        ++transitions;
    }
    void settle(Time now) {
        busy_ = true;
        for (int n = 0; n < 8; ++n) {
            serve_final(now);
            if (raised_.empty()) break;
            const std::string event = raised_.front();
            raised_.pop_front();
            take_event(event, now);
        }
        serve_final(now);
        busy_ = false;
    }

    StateMachineTable table_;
    void* component_;
    std::vector<std::string_view> active_; // from the outside
    std::map<std::string_view, Time> entered_;
    std::vector<std::string_view> entered_now_; // since the run programs were looked at
    std::set<std::string_view> held_;           // entered again in the step in which they ran
    std::deque<std::string> raised_;
    std::string final_reason_;
    Time stepped_at_{};
    bool busy_ = false;
    bool leaving_ = false;
    bool final_wanted_ = false;
    bool conditions_left_ = false;
};

} // namespace tappet
