// One seed of a swarm: what strikes when, and what is asked of the machine afterwards.
#include "toolchain/machine/swarm.hpp"

#include "drivers/can/signal_map.hpp"
#include "drivers/gpio/line_map.hpp"
#include "kernel/machine/check/time.hpp"

#include <algorithm>

namespace tappet {

namespace {

constexpr Duration first_work_within = 60s;
constexpr Duration longest_pause = 4s; // between two faults
constexpr Duration longest_fault = 5s; // of those that end by themselves
constexpr Duration again = 50ms;       // a part that does not start yet is asked again
constexpr Duration at_rest = 500ms;    // after a stop

bool is_driver(const ComponentRow& row) {
    return drives(row, "can") || drives(row, "gpio") || drives(row, "modbus");
}

} // namespace

std::vector<Duration> analysed_responses(const AcceptedMachine& machine) {
    std::vector<int> processors;
    for (const ActivityPlan& plan : machine.plan.activities) processors.push_back(plan.processor);
    std::vector<Duration> responses(processors.size());
    for (std::size_t a = 0; a < responses.size(); ++a)
        if (machine.table.activities[a].real_time)
            responses[a] =
                Duration{checks::worst_response(machine.table, machine.index.rank, processors, a).worst_ns};
    return responses;
}

SwarmRun::SwarmRun(const SwarmOf& of, std::uint64_t seed, Tell tell)
    : of_{of},
      tell_{std::move(tell)},
      random_{seed},
      plant_{of.plant(seed)},
      run_{of.machine, *plant_, seed},
      struck_{of.machine.table.components.size()} {
    const auto rows = of.machine.table.components;
    for (std::size_t c = 0; c < rows.size(); ++c)
        if (is_driver(rows[c])) drivers_.push_back(c);
    run_.judge_by([this](Time now) { judge(now); });
}

SwarmVerdict SwarmRun::go() {
    if (start(false)) {
        if (!run_until_works(first_work_within) && verdict_.broken.empty())
            verdict_.broken = Sentence{"it did not begin to work, though nothing was wrong"};
        storm(run_.now() + Duration{random_.between(5'000'000'000, 60'000'000'000)});
        const Time peace = run_.now();
        say("everything is mended");
        end_faults(true);
        while (!faults_.empty() && verdict_.broken.empty() && run_.now() < peace + rules_->works_within()) {
            run_until(run_.now() + again);
            end_faults(true);
        }
        if (!run_until_works(rules_->works_within()) && verdict_.broken.empty()) {
            verdict_.waited_for = rules_->waits_for();
            if (!faults_.empty()) verdict_.waited_for += ": " + std::string{refusal_.view()};
            say(Sentence{"it waits for ", verdict_.waited_for}.view());
            if (verdict_.waited_for.empty())
                verdict_.broken = Sentence{"it does not work again and does not say why not"};
            stop();
            forget_faults();
            for (const std::size_t c : drivers_) // somebody has looked at the bus
                if (const ComponentRow& row = of_.machine.table.components[c]; drives(row, "can"))
                    static_cast<void>(run_.devices().controller(row.device).restart());
            if (verdict_.broken.empty() && start(true) && !run_until_works(first_work_within) &&
                verdict_.broken.empty())
                verdict_.broken = Sentence{"it does not work again after its restart; it waits for \"",
                                           rules_->waits_for(), "\""};
        } else {
            verdict_.back = run_.now() - peace;
        }
        stop();
    }
    if (verdict_.at == Time{}) verdict_.at = run_.now();
    verdict_.time = run_.now() - Time{};
    return std::move(verdict_);
}

bool SwarmRun::start(bool is_again) {
    auto started = is_again ? run_.start_again() : run_.start();
    if (!started) {
        verdict_.broken = Sentence{"it did not start: ", started.error()};
        return false;
    }
    rules_ = of_.rules(run_.instance(), *plant_, struck_);
    lost_ = 0;
    return true;
}

void SwarmRun::judge(Time now) {
    if (!verdict_.broken.empty() || rules_ == nullptr) return;
    std::string_view broken = rules_->broken(now);
    if (broken.empty()) return;
    verdict_.broken = Sentence{broken};
    verdict_.at = now;
}

/// Who hangs or stands does not take what it is told, and that is counted; nobody else may lose anything.
void SwarmRun::judge_emissions() {
    const std::uint64_t lost = run_.instance().observation().lost_emissions();
    const bool all_ran = std::ranges::none_of(faults_, &Fault::of_activity);
    if (lost != lost_ && all_ran && verdict_.broken.empty())
        verdict_.broken = Sentence{"an emission was lost though every activity ran"};
    lost_ = lost;
}

void SwarmRun::run_until(Time end) {
    while (run_.now() < end && verdict_.broken.empty()) {
        const bool runs = run_.run_for(end - run_.now());
        judge_emissions();
        if (runs) continue;
        say(Sentence{"it stopped: ", run_.instance().describe_stop()}.view());
        ++verdict_.faults["stopped by itself"];
        stop();
        if (!start(true)) return;
    }
}

bool SwarmRun::run_until_works(Duration limit) {
    bool acknowledged = false;
    for (const Time end = run_.now() + limit; run_.now() < end && verdict_.broken.empty();) {
        if (rules_->works()) return true;
        if (!acknowledged && run_.now() > end - limit / 2) {
            say("somebody acknowledges by hand");
            rules_->acknowledge();
            acknowledged = true;
        }
        run_until(std::min(end, run_.now() + again));
    }
    return verdict_.broken.empty() && rules_->works();
}

void SwarmRun::storm(Time end) {
    if (is_calm_) return run_until(end);
    Time next = run_.now();
    while (run_.now() < end && verdict_.broken.empty()) {
        if (next <= run_.now()) {
            strike();
            // As often close together as far apart.
            const Duration most{std::int64_t{1} << random_.between(20, 32)};
            next = run_.now() + Duration{random_.between(0, std::min(most, longest_pause).count())};
        }
        Time until = std::min(next, end);
        for (const Fault& each : faults_) until = std::min(until, each.ends);
        run_until(std::max(until, run_.now() + 1us));
        end_faults(false);
    }
}

void SwarmRun::end_faults(bool all) {
    for (std::size_t f = 0; f < faults_.size();) {
        Fault& fault = faults_[f];
        if (!all && fault.ends > run_.now()) {
            ++f;
        } else if (!fault.end()) {
            fault.ends = run_.now() + again;
            ++f;
        } else {
            for (const std::size_t c : fault.components) struck_.end(c, run_.now());
            faults_.erase(faults_.begin() + static_cast<std::ptrdiff_t>(f));
        }
    }
}

/// Of parts that did not start again: a new machine starts them.
void SwarmRun::forget_faults() {
    for (const Fault& each : faults_)
        for (const std::size_t c : each.components) struck_.end(c, run_.now());
    faults_.clear();
}

void SwarmRun::note_responses() {
    const auto engines = run_.instance().engines();
    verdict_.responses.resize(engines.size());
    for (std::size_t a = 0; a < engines.size(); ++a) {
        verdict_.responses[a] = std::max(verdict_.responses[a], run_.world().longest_response(a));
        verdict_.woken_too_often |= engines[a].statistics().wakes_too_many != 0;
    }
    if (verdict_.woken_too_often || !verdict_.broken.empty()) return;
    const std::vector<Duration> analysed = analysed_responses(of_.machine);
    for (std::size_t a = 0; a < engines.size(); ++a)
        if (engines[a].plan().real_time && verdict_.responses[a] > analysed[a])
            verdict_.broken = Sentence{"activity \"", engines[a].name(),
                                       "\" took longer to respond than the analysis of "
                                       "its table says, though none came too often"};
}

/// In the stated order, and what it leaves on the wires stays there.
void SwarmRun::stop() {
    note_responses();
    run_.stop();
    for (const Time end = run_.now() + at_rest; run_.now() < end;) {
        run_.clock().advance_to(run_.now() + 1ms);
        run_.devices().advance(run_.now());
        judge(run_.now());
    }
    ++verdict_.restarts;
}

void SwarmRun::say(std::string_view text) {
    if (tell_) tell_(run_.now(), text);
}

void SwarmRun::begin(std::string_view kind, Sentence text, Duration lasts,
                     std::vector<std::size_t> components, std::function<bool()> end) {
    ++verdict_.faults[std::string{kind}];
    say(text.add(" (").add(lasts / 1us).add(" us)").view());
    for (const std::size_t c : components) struck_.begin(c);
    faults_.push_back(
        {run_.now() + lasts, kind.starts_with("activity"), std::move(components), std::move(end)});
}

void SwarmRun::strike() {
    const Duration lasts{std::min<std::int64_t>(
        random_.between(1, std::int64_t{1} << random_.between(17, 33)), longest_fault.count())};
    const std::uint64_t what = random_.below(100);
    if (what < 20) {
        if (const Sentence trouble = rules_->trouble(random_, lasts); !trouble.empty()) {
            ++verdict_.faults["plant"];
            say(trouble.view());
        }
    } else if (what < 50 && !drivers_.empty()) {
        const std::size_t c = drivers_[random_.below(drivers_.size())];
        const ComponentRow& row = of_.machine.table.components[c];
        if (drives(row, "can")) strike_bus(c, lasts);
        if (drives(row, "gpio")) strike_chip(c, lasts);
        if (drives(row, "modbus")) strike_server(c, lasts);
    } else if (what < 65) {
        strike_component(lasts);
    } else if (what < 98) {
        strike_activity(lasts);
    } else {
        ++verdict_.faults["machine restarted"];
        say("the machine is stopped and started");
        end_faults(true);
        stop();
        forget_faults();
        if (verdict_.broken.empty()) static_cast<void>(start(true));
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

void SwarmRun::strike_bus(std::size_t c, Duration lasts) {
    const ComponentRow& row = of_.machine.table.components[c];
    can::TwinBus& bus = run_.devices().bus(row.device);
    const auto& map = *static_cast<const can::Identifiers*>(row.type->device_map);
    Sentence text{"bus \"", row.device, "\" "};
    const std::uint64_t what = random_.below(7);
    if (what == 4) {
        bus.set_acknowledged(false);
        return begin("bus unacknowledged", text.add("acknowledges nothing"), lasts, components_on(row.device),
                     [&bus] { return bus.set_acknowledged(true), true; });
    }
    if (what == 5) {
        bus.bus_off(run_.devices().controller(row.device));
        return begin(
            "bus off", text.add("goes off"), lasts, components_on(row.device),
            [this, device = row.device] { return !can::faulted(run_.devices().controller(device).state()); });
    }
    const auto often = static_cast<std::uint32_t>(random_.between(1, 100));
    if (what == 6) {
        bus.overflow(run_.devices().controller(row.device), often);
        return begin("bus overflow", text.add("overflows by ").add(often), lasts, components_on(row.device),
                     [] { return true; });
    }
    constexpr std::array<std::string_view, 4> names{"bus loses", "bus doubles", "bus corrupts", "bus delays"};
    const std::array<can::Chance*, 4> chances{&bus.faults.lose, &bus.faults.duplicate,
                                              &bus.faults.corrupt_length, &bus.faults.delay};
    can::Chance* const chance = chances[what];
    chance->one_in = often;
    bus.faults.only = {};
    text.add(names[what].substr(4)).add(" one frame in ").add(often);
    if (chance == &bus.faults.delay) bus.faults.delay_by = Duration{random_.between(10'000, 20'000'000)};
    const std::size_t all = map.receive.size() + map.transmit.size();
    if (const std::size_t one = random_.below(2 * all); one < all) {
        bus.faults.only =
            one < map.receive.size() ? map.receive[one] : map.transmit[one - map.receive.size()];
        text.add(" of identifier ").add(bus.faults.only->id);
    }
    begin(names[what], text, lasts, components_on(row.device), [chance] { return chance->one_in = 0, true; });
}

void SwarmRun::strike_chip(std::size_t c, Duration lasts) {
    const ComponentRow& row = of_.machine.table.components[c];
    gpio::Twin& chip = run_.devices().lines(row.device);
    const auto& map = *static_cast<const std::span<const gpio::LineRow>*>(row.type->device_map);
    Sentence text{"lines \"", row.device, "\": "};
    const std::uint64_t what = random_.below(6);
    std::vector<std::size_t> inputs;
    for (std::size_t i = 0; i < map.size(); ++i)
        if (map[i].line.role == gpio::Role::input) inputs.push_back(i);
    if (what == 0 || inputs.empty()) {
        chip.set_removed(true);
        return begin("chip removed", text.add("the chip is gone"), lasts, components_on(row.device),
                     [&chip] { return chip.set_removed(false), true; });
    }
    const std::size_t line = inputs[random_.below(inputs.size())];
    gpio::LineFaults& faults = chip.faults(line);
    const auto many = static_cast<std::uint32_t>(random_.between(1, 4));
    text.add("\"").add(map[line].line.name).add("\" ");
    const auto heal = [&faults] { return faults = {}, true; };
    switch (what) {
    case 1:
        faults.lose_next = many;
        return begin("line loses edges", text.add("loses ").add(many).add(" edges"), lasts, {}, heal);
    case 2:
        faults.lose_one_in = many;
        return begin("line loses edges", text.add("loses one edge in ").add(many), lasts, {}, heal);
    case 3:
        faults.bounces = many;
        return begin("line bounces", text.add("bounces ").add(many).add(" times"), lasts, {}, heal);
    case 4:
        faults.delay = Duration{random_.between(1'000, 10'000'000)};
        return begin("line is late", text.add("is ").add(faults.delay / 1us).add(" us late"), lasts, {},
                     heal);
    default: {
        const bool level = random_.one_in(2);
        chip.stick(line, level, run_.now());
        return begin("line sticks", text.add(level ? "sticks active" : "sticks inactive"), lasts, {},
                     [this, &chip, line] { return chip.release(line, run_.now()), true; });
    }
    }
}

void SwarmRun::strike_server(std::size_t c, Duration lasts) {
    const ComponentRow& row = of_.machine.table.components[c];
    modbus::Twin& server = run_.devices().server(row.device);
    constexpr std::array<std::string_view, 6> names{
        "is silent", "is slow", "answers exceptions", "answers wrong ones", "answers garbage", "is down"};
    const std::size_t what = random_.below(names.size());
    const auto requests = static_cast<std::uint32_t>(random_.between(1, 20));
    server.set_slow_by(Duration{random_.between(1'000'000, 1'000'000'000)});
    server.inject(static_cast<modbus::Fault>(what + 1), requests);
    begin("server faults", Sentence{"server \"", row.device, "\" ", names[what], " ", requests, " times"},
          lasts, components_on(row.device), [&server] { return server.inject(modbus::Fault::none), true; });
}

void SwarmRun::strike_component(Duration lasts) {
    const std::size_t c = random_.below(of_.machine.table.components.size());
    const Sentence text{"component \"", of_.machine.table.components[c].name, "\" "};
    const bool restarts = random_.one_in(2);
    const auto ask = [this, c](LifeChange change) { return run_.instance().life().ask_component(c, change); };
    begin(restarts ? "component restarted" : "component stopped",
          Sentence{text}.add(restarts ? "restarts" : "stops"), restarts ? 1ms : lasts, {c},
          [this, c, ask, ticket = ask(restarts ? LifeChange::restart : LifeChange::stop)]() mutable {
              MachineLife& life = run_.instance().life();
              const LifeAnswer answer = life.answer_of_component(c, ticket);
              const bool asked_again = answer.outcome != LifeOutcome::pending;
              if (asked_again && life.state_of(c) == ComponentState::running) return true;
              if (answer.outcome == LifeOutcome::refused)
                  refusal_ = life.describe(of_.machine.index.activity[c], answer);
              ticket = ask(LifeChange::start);
              return false;
          });
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
    case 1:
        lasts = std::max(lasts,
                         Duration{std::int64_t{1} << random_.between(20, 32)}); // as long as watchdogs wait
        run_.world().hang(a, run_.now() + lasts);
        return begin("activity hangs", text.add("hangs"), lasts, components_of(a),
                     [this, a] { return run_.world().hang(a, run_.now()), true; });
    case 2:
        begin("activity restarted", text.add("restarts"), 1ms, components_of(a), runs);
        return static_cast<void>(run_.world().change_activity(a, LifeChange::restart));
    default:
        begin("activity stopped", text.add("stops"), lasts, components_of(a), runs);
        return static_cast<void>(run_.world().change_activity(a, LifeChange::stop));
    }
}

} // namespace tappet
