// The faults of a machine of the swarm, from without and within: its devices, its components, its activities.
#include "toolchain/machine/swarm.hpp"

#include <algorithm>

namespace tappet {

namespace {

constexpr Duration longest_fault = 5s; // of faults that end by themselves

} // namespace

void SwarmRun::strike() {
    const Duration lasts{std::min<std::int64_t>(
        random_.between(1, std::int64_t{1} << random_.between(17, 33)), longest_fault.count())};
    if (anything_goes_ && service_ != nowhere && (only_people_ || random_.one_in(3)))
        return strike_people(lasts);
    const std::uint64_t what = random_.below(100);
    if (what < 16) {
        if (const Sentence trouble = rules_->trouble(random_, lasts); !trouble.empty()) {
            ++verdict_.faults["plant"];
            say(trouble.view());
        }
    } else if (what < 38 && !drivers_.empty()) {
        const std::size_t c = drivers_[random_.below(drivers_.size())];
        strike_device(of_.machine.table.components[c].device, lasts);
    } else if (what < 50) {
        strike_component(lasts);
    } else if (what < 74) {
        strike_activity(lasts);
    } else if (what < 97 && service_ != nowhere) {
        strike_people(lasts);
    } else {
        restart(random_.one_in(2));
    }
}

std::vector<std::size_t> SwarmRun::components_on(std::string_view device) const {
    std::vector<std::size_t> found;
    for (const std::size_t c : drivers_)
        if (of_.machine.table.components[c].device == device) found.push_back(c);
    return found;
}

std::vector<std::size_t> SwarmRun::components_of(std::size_t activity) const {
    std::vector<std::size_t> found;
    for (std::size_t c = 0; c < of_.machine.index.activity.size(); ++c)
        if (of_.machine.index.activity[c] == activity) found.push_back(c);
    return found;
}

void SwarmRun::strike_device(std::string_view device, Duration lasts) {
    TwinFault struck = run_.devices().strike(device, random_, run_.now(), anything_goes_);
    if (struck.misleads > Duration{}) wires_.excuse_axes(run_.now() + struck.misleads);
    if (struck.end)
        return begin(struck.kind, struck.texts.front(), lasts,
                     struck.strikes_driver ? components_on(device) : std::vector<std::size_t>{},
                     [this, end = std::move(struck.end)] { return end(run_.now()); });
    if (!struck.kind.empty()) ++verdict_.faults[std::string{struck.kind}];
    for (const Sentence& text : struck.texts) say(text.view());
}

void SwarmRun::strike_component(Duration lasts) {
    const std::size_t c = random_.below(of_.machine.table.components.size());
    const Sentence text{"component \"", of_.machine.table.components[c].name, "\" "};
    const bool restarts = random_.one_in(2);
    const auto ticket = std::make_shared<LifeTicket>(
        run_.instance().life().ask_component(c, restarts ? LifeChange::restart : LifeChange::stop));
    const auto is_over = [this, c, ticket] {
        MachineLife& life = run_.instance().life();
        return life.answer_of_component(c, *ticket).outcome != LifeOutcome::pending &&
               life.state_of(c) == ComponentState::running;
    };
    begin(restarts ? "component restarted" : "component stopped",
          Sentence{text}.add(restarts ? "restarts" : "stops"), restarts ? 1ms : lasts, {c},
          [this, c, ticket, is_over] {
              if (is_over()) return true;
              MachineLife& life = run_.instance().life();
              const LifeAnswer answer = life.answer_of_component(c, *ticket);
              if (answer.outcome == LifeOutcome::refused)
                  refusal_ = life.describe(of_.machine.index.activity[c], answer);
              *ticket = life.ask_component(c, LifeChange::start);
              return false;
          });
    faults_.back().is_over = is_over;
}

void SwarmRun::hang(std::size_t a, Duration lasts) {
    const auto is_same = [of = components_of(a)](const Fault& each) {
        return each.of_activity && each.components == of;
    };
    if (std::ranges::any_of(faults_, is_same)) return; // one would end the other
    run_.world().hang(a, run_.now() + lasts);
    begin("activity hangs", Sentence{"activity \"", of_.machine.table.activities[a].name, "\" hangs"}, lasts,
          components_of(a), [this, a] { return run_.world().hang(a, run_.now()), true; });
}

void SwarmRun::strike_activity(Duration lasts) {
    const std::size_t a = random_.below(of_.machine.table.activities.size());
    Sentence text{"activity \"", of_.machine.table.activities[a].name, "\" "};
    const auto runs = [this, a] {
        if (run_.instance().engines()[a].is_active()) return true;
        refusal_ = run_.world().change_activity(a, LifeChange::start);
        return refusal_.empty();
    };
    switch (random_.below(4)) {
    case 0:
    case 1: // as long as watchdogs wait
        return hang(a, std::max(lasts, Duration{std::int64_t{1} << random_.between(20, 32)}));
    case 2:
        begin("activity restarted", text.add("restarts"), 1ms, components_of(a), runs);
        return static_cast<void>(run_.world().change_activity(a, LifeChange::restart));
    default:
        begin("activity stopped", text.add("stops"), lasts, components_of(a), runs);
        faults_.back().is_over = [this, a] { return run_.instance().engines()[a].is_active(); };
        return static_cast<void>(run_.world().change_activity(a, LifeChange::stop));
    }
}

} // namespace tappet
