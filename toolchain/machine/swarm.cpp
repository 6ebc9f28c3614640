// One seed of a swarm: when a fault strikes, what is judged meanwhile, and what the machine must do
// afterwards.
#include "toolchain/machine/swarm.hpp"

#include "kernel/machine/check/time.hpp"
#include "kernel/services/browsing/browser_service.hpp"

#include <algorithm>
#include <filesystem>

#include <unistd.h>

namespace tappet {

namespace {

constexpr Duration first_work_within = 60s;
constexpr Duration longest_pause = 4s;                     // between two faults
constexpr Duration again = 50ms;                           // a part that does not start yet is retried
constexpr Duration heard_every = 50ms;                     // poll interval of browsers
constexpr std::size_t told_actions = 12;                   // listed before a finding
constexpr Duration learnt_after = 5s, learnt_between = 1s; // until it works, and between stops
constexpr Duration stopped_within = 25ms;                  // an orderly stop, to the last line
constexpr Duration at_rest = 500ms;                        // after a stop

std::string own_directory() {
    return (std::filesystem::temp_directory_path() / ("tappet-swarm-" + std::to_string(::getpid()))).string();
}

// Users who are allowed less than an engineer.
constexpr std::uint32_t machine_operator = 61001, observer = 61002;

/// The rules of a machine that has none of its own: it works as long as it runs.
class NoRules final : public SwarmRules {
public:
    std::string_view broken(Time) override { return {}; }
    bool works() override { return true; }
};

const AcceptedMachine& on_board(AcceptedMachine& machine, const Board& board) {
    machine.board = &board;
    return machine;
}

std::string socket_in(const std::string& directory, std::string_view machine) {
    return directory + "/" + std::string{machine} + std::string{browsing::socket_suffix};
}

std::array<SwarmBrowser, 6> visitors(const std::string& socket) {
    const auto one = [&socket](std::uint32_t user) { return SwarmBrowser{socket, user}; };
    return {one(machine_operator), one(observer), one(observer), one(observer), one(observer), one(observer)};
}

Board with_visitors(Board board) {
    board.browsing.mode = 0666;
    static_cast<void>(board.browsing.roles.push(user(machine_operator, Role::machine_operator)));
    return board;
}

} // namespace

std::vector<Duration> analysed_responses(const AcceptedMachine& machine) {
    const auto worst =
        checks::worst_responses_ns(machine.table, *machine.board, *machine.binding, machine.index);
    std::vector<Duration> responses;
    for (std::size_t a = 0; a < machine.table.activities.size(); ++a) responses.emplace_back(worst[a]);
    return responses;
}

SwarmRun::SwarmRun(const SwarmOf& of, std::uint64_t seed, Tell tell)
    : of_{of},
      anything_goes_{!of.rules},
      board_{with_visitors(*of.machine.board)},
      tell_{std::move(tell)},
      random_{seed},
      directory_{own_directory()},
      plant_{of.plant(seed)},
      run_{on_board(of_.machine, board_), *plant_, seed},
      struck_{of.machine.table.components.size()},
      wires_{of_.machine, run_.devices(), struck_, of.left},
      ports_{of_.machine},
      only_people_{seed % 3 == 0},
      files_{std::make_unique<PropertyFiles>(directory_)},
      browser_{socket_in(directory_, of.machine.table.name)},
      visitors_{visitors(socket_in(directory_, of.machine.table.name))} {
    std::filesystem::remove_all(directory_); // left by an earlier process with this number
    std::filesystem::create_directories(directory_);
    run_.keep_properties_in(directory_);
    find_what_people_may();
    if (service_ != nowhere) run_.browse_in(directory_);
    const auto rows = of.machine.table.components;
    for (std::size_t c = 0; c < rows.size(); ++c)
        if (SimulatedDevices::is_judged(rows[c])) drivers_.push_back(c);
    run_.judge_by([this](Time now) { judge(now); });
}

SwarmRun::~SwarmRun() {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
}

SwarmVerdict SwarmRun::go() {
    if (start(false)) {
        if (!run_until_works(first_work_within) && verdict_.broken.empty())
            verdict_.broken = Sentence{"it did not begin to work, though nothing was wrong"};
        storm(run_.now() + Duration{random_.between(5'000'000'000, 60'000'000'000)});
        const Time peace = run_.now();
        say("everything is repaired");
        if (mend(rules_->works_within())) judge_forces();
        if (!run_until_works(rules_->works_within()) && verdict_.broken.empty()) {
            verdict_.waited_for = rules_->waits_for();
            if (!faults_.empty()) verdict_.waited_for += ": " + std::string{refusal_.view()};
            say(Sentence{"it waits for ", verdict_.waited_for}.view());
            if (verdict_.waited_for.empty())
                verdict_.broken = Sentence{"it does not work again and does not say why not"};
            stop();
            forget_faults();
            run_.devices().repair_all();
            if (verdict_.broken.empty() && start(true) && mend(first_work_within) &&
                !run_until_works(first_work_within) && verdict_.broken.empty())
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

AllLeftBehind SwarmRun::learn() {
    AllLeftBehind left;
    if (!start(false)) return left;
    MachineLife& life = run_.instance().life();
    run_until(run_.now() + learnt_after);
    for (const auto& writers : wires_.all_writers()) {
        for (const std::size_t c : writers) static_cast<void>(life.ask_component(c, LifeChange::stop));
        run_until(run_.now() + wires_.settles(writers) + again);
        wires_.note_left(writers, left);
        for (const std::size_t c : writers) static_cast<void>(life.ask_component(c, LifeChange::start));
        run_until(run_.now() + learnt_between);
    }
    stop();
    return left;
}

bool SwarmRun::start(bool is_again) {
    auto started = is_again ? run_.start_again() : run_.start();
    if (!started) {
        verdict_.broken = Sentence{"it did not start: ", started.error()};
        return false;
    }
    if (!is_again) wires_.listen();
    wires_.begin(run_.instance());
    ports_.begin(run_.instance());
    rules_ = of_.rules ? of_.rules(run_.instance(), *plant_, struck_) : std::make_unique<NoRules>();
    is_gone_ = false;
    lost_ = 0;
    set_values_.clear();
    lines_ = {};
    if (service_ != nowhere)
        run_.instance().find<BrowserService>(of_.machine.table.components[service_].name)->log.set(false);
    judge_kept();
    hear();
    return true;
}

void SwarmRun::judge(Time now) {
    if (!verdict_.broken.empty() || rules_ == nullptr || is_gone_) return;
    Sentence broken{rules_->broken(now)};
    if (broken.empty()) broken = wires_.broken(now);
    if (broken.empty()) broken = ports_.broken(now);
    if (broken.empty()) return;
    verdict_.broken = broken;
    verdict_.at = now;
}

void SwarmRun::deny(const Sentence& why) {
    if (!verdict_.broken.empty()) return;
    verdict_.broken = why;
    verdict_.at = run_.now();
}

/// A hung or stopped activity does not accept emissions, and that is counted; no other activity may lose one.
void SwarmRun::judge_emissions() {
    if (anything_goes_) return; // people may send more than the rows have room for
    const std::uint64_t lost = run_.instance().observation().lost_emissions();
    const bool all_ran = std::ranges::none_of(faults_, &Fault::of_activity);
    if (lost != lost_ && all_ran && verdict_.broken.empty())
        verdict_.broken = Sentence{"an emission was lost though every activity ran"};
    lost_ = lost;
}

void SwarmRun::run_until(Time end) {
    while (run_.now() < end && verdict_.broken.empty()) {
        const bool runs = run_.run_for(std::min(heard_every, end - run_.now()));
        judge_emissions();
        hear();
        if (runs) continue;
        say(Sentence{"it stopped: ", run_.instance().describe_stop()}.view());
        ++verdict_.faults["stopped by itself"];
        stop();
        if (!start(true)) return;
    }
}

bool SwarmRun::run_until_works(Duration limit) {
    for (const Time end = run_.now() + limit; run_.now() < end && verdict_.broken.empty();) {
        if (rules_->works()) return true;
        run_until(std::min(end, run_.now() + again));
    }
    return verdict_.broken.empty() && rules_->works();
}

/// Ends all faults; returns false when they do not end within `limit`.
bool SwarmRun::mend(Duration limit) {
    const Time end = run_.now() + limit;
    refusal_ = {};
    for (end_faults(true); !faults_.empty(); end_faults(true)) {
        if (!verdict_.broken.empty() || run_.now() >= end) return false;
        run_until(run_.now() + again);
    }
    return true;
}

void SwarmRun::storm(Time end) {
    if (is_calm_) return run_until(end);
    Time next = run_.now();
    while (run_.now() < end && verdict_.broken.empty()) {
        if (next <= run_.now()) {
            strike();
            // Short pauses are as frequent as long ones.
            const Duration most{std::int64_t{1} << random_.between(20, 32)};
            next = run_.now() + Duration{random_.between(0, std::min(most, longest_pause).count())};
        }
        Time until = std::min(next, end);
        for (const Fault& each : faults_) until = std::min(until, each.ends);
        run_until(std::max(std::min(until, run_.now() + heard_every), run_.now() + 1us));
        end_faults(false);
    }
}

void SwarmRun::end_faults(bool all) {
    for (std::size_t f = 0; f < faults_.size();) {
        Fault& fault = faults_[f];
        if (fault.is_over && fault.is_over()) {
            forget(f);
        } else if (!all && fault.ends > run_.now()) {
            ++f;
        } else if (!fault.end()) {
            fault.ends = run_.now() + again;
            ++f;
        } else {
            forget(f);
        }
    }
}

void SwarmRun::forget(std::size_t f) {
    for (const std::size_t c : faults_[f].components) struck_.end(c, run_.now());
    faults_.erase(faults_.begin() + static_cast<std::ptrdiff_t>(f));
}

/// Forgets parts that did not start again, and forces: a new machine has none.
void SwarmRun::forget_faults() {
    for (std::size_t f = faults_.size(); f-- > 0;)
        if (!faults_[f].outlives_machine) forget(f);
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

/// Stops in the stated order; checks what remains on the wires.
void SwarmRun::stop() {
    note_responses();
    const Time asked = run_.now();
    run_.stop();
    if (const Duration took = run_.now() - asked; took > of_.machine.board->stop_within)
        deny(Sentence{"its stop took ", took / 1ms, " ms, and its board allows ",
                      of_.machine.board->stop_within / 1ms});
    leave();
    if (const Sentence& fault = run_.unsaved(); !fault.empty())
        deny(Sentence{"the properties cannot be saved at halt: ", fault});
    judge_saved(true);
    kept_ = kept_values();
    rest(stopped_within);
    if (!run_.instance().life().left_unsafe().empty())
        let_guardian_act();
    else if (const Sentence unsafe = wires_.broken_at_rest(false); !unsafe.empty())
        deny(unsafe);
    rest(at_rest - stopped_within);
    ++verdict_.restarts;
}

/// Advances the plant without the machine.
void SwarmRun::rest(Duration time) {
    for (const Time end = run_.now() + time; run_.now() < end;) {
        run_.clock().advance_to(std::min(end, run_.now() + 1ms));
        run_.devices().advance(run_.now());
        judge(run_.now());
    }
}

void SwarmRun::let_guardian_act() {
    is_gone_ = true; // from now on its guardian keeps its promises
    rest(Duration{random_.between(0, 10'000'000)});
    run_.devices().write_safe_lines();
    rest(Duration{random_.between(0, 10'000'000)});
    run_.devices().send_safe_frames(run_.now());
    run_.devices().write_safe_registers();
    rest(25ms);
    if (const Sentence unsafe = wires_.broken_at_rest(true); !unsafe.empty()) deny(unsafe);
}

/// Restarts the machine, in order or after its process died at work and its guardian acted.
void SwarmRun::restart(bool orderly) {
    ++verdict_.faults[orderly ? "machine restarted" : "machine ended abruptly"];
    say(orderly ? "the machine is stopped and started"
                : "the machine's process ends abruptly, and starts again");
    end_faults(true);
    if (orderly) {
        stop();
    } else {
        note_responses();
        leave();
        // As the kernel closes the descriptors of a process.
        if (service_ != nowhere)
            run_.instance().find<BrowserService>(of_.machine.table.components[service_].name)->finalise();
        kept_.clear();
        let_guardian_act();
        rest(Duration{random_.between(100'000'000, 3'000'000'000)});
        ++verdict_.restarts;
    }
    forget_faults();
    if (verdict_.broken.empty()) static_cast<void>(start(true));
}

void SwarmRun::leave() {
    browser_.leave();
    for (SwarmBrowser& each : visitors_) each.leave();
}

void SwarmRun::say(std::string_view text) {
    if (tell_) tell_(run_.now(), text);
    if (!verdict_.broken.empty()) return;
    auto& last = verdict_.before;
    if (last.size() == told_actions) last.erase(last.begin());
    last.push_back(std::to_string(to_ns(run_.now()) / 1000) + " us: " + std::string{text});
}

void SwarmRun::begin(std::string_view kind, Sentence text, Duration lasts,
                     std::vector<std::size_t> components, std::function<bool()> end) {
    ++verdict_.faults[std::string{kind}];
    say(text.add(" (").add(lasts / 1us).add(" us)").view());
    for (const std::size_t c : components) struck_.begin(c);
    faults_.push_back(
        {run_.now() + lasts, kind.starts_with("activity"), std::move(components), std::move(end)});
}

} // namespace tappet
