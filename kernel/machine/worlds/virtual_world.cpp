// The order of virtual time: at each instant, the most urgent ready activity runs next.
#include "kernel/machine/worlds/virtual_world.hpp"

#include "kernel/base/contract.hpp"

#include <algorithm>
#include <utility>

namespace tappet {

VirtualWorld::VirtualWorld(MachineInstance& instance) noexcept : instance_{instance} {
    const auto rank = instance.machine().index.rank;
    for (std::size_t r = 0; r < rank.size(); ++r)
        for (std::size_t a = 0; a < rank.size(); ++a)
            if (rank[a] == r) static_cast<void>(by_urgency_.push(a));
}

ActivityControl VirtualWorld::control() noexcept {
    constexpr auto at_once = [](void*, std::size_t) { return ActivityControl::Progress::done; };
    return {this,
            [](void* self, std::size_t a) {
                auto& world = *static_cast<VirtualWorld*>(self);
                Engine& engine = world.instance_.engines()[a];
                engine.start(world.instance_.clock().now());
                world.sleep_until(a, engine.looping() == nullptr ? engine.next_wake()
                                                                 : world.instance_.clock().now());
            },
            at_once,
            [](void* self, std::size_t a) {
                auto& world = *static_cast<VirtualWorld*>(self);
                if (world.loops_[a]) world.loops_[a]->break_off();
                world.end(a);
                world.jobs_[a].is_there = false;
                world.instance_.engines()[a].stop(world.instance_.clock().now());
            },
            at_once,
            [](void* self) {
                auto& world = *static_cast<VirtualWorld*>(self);
                if (world.makers_take_ > Duration::zero())
                    world.makers_until_ = world.instance_.clock().now() + world.makers_take_;
                else
                    world.instance_.life().run_makers_functions();
            }};
}

bool VirtualWorld::complete_change(std::size_t a) {
    while (instance_.life().changes(a)) {
        instance_.life().serve_activity_requests(control());
        if (!instance_.life().changes(a)) break;
        if (instance_.stop_asked()) return false;
        end_ = makers_until_;
        run_instant(std::max(next_time(), instance_.clock().now()));
    }
    return true;
}

Sentence VirtualWorld::start() {
    MachineLife& life = instance_.life();
    Sentence refusal;
    for (std::size_t a = 0; a < instance_.engines().size() && refusal.empty(); ++a) {
        life.begin_change(a, LifeChange::start, MachineLife::Begin::with_the_machine, control());
        refusal = complete_change(a) ? life.refusal() : instance_.describe_stop();
    }
    if (!refusal.empty()) stop();
    return refusal;
}

Sentence VirtualWorld::change_activity(std::size_t a, LifeChange change) {
    MachineLife& life = instance_.life();
    bool completed = complete_change(a); // one that was requested from outside
    if (completed) {
        life.begin_change(a, change, MachineLife::Begin::alone, control());
        completed = complete_change(a);
    }
    return completed ? life.refusal() : Sentence{"the machine stops: ", instance_.describe_stop()};
}

Time VirtualWorld::quiet_until(const void* process) const { return quiet(process, end_); }

Time VirtualWorld::quiet(const void* but, Time end) const {
    Time next = std::min(end, makers_until_);
    for (const VirtualProcess& process : processes_)
        if (process.self != but) next = std::min(next, process.next(process.self));
    const auto engines = instance_.engines();
    for (std::size_t a = 0; a < engines.size(); ++a) {
        if (!engines[a].is_active()) continue;
        if (jobs_[a].is_there) { // in the middle of its work when it began to hang
            if (hangs_until_[a] > worked_until_) next = std::min(next, hangs_until_[a]);
            continue;
        }
        const bool woken = engines[a].waiter().is_woken();
        if (woken && hangs_until_[a] <= instance_.clock().now()) return instance_.clock().now();
        next = std::min(next, std::max(woken ? Time::min() : wake_at_[a], hangs_until_[a]));
    }
    for (int p = 0; times_ && p < instance_.machine().board->processors; ++p)
        if (const std::size_t a = at_work(p); a != nowhere)
            next = std::min(next, worked_until_ + jobs_[a].left);
    return next;
}

void VirtualWorld::run_engine(std::size_t a, bool woken) {
    Engine& engine = instance_.engines()[a];
    if (engine.looping() == nullptr ||
        engine.ends_at() != never) { // a loop that was broken off is not entered again
        if (runner_.run != nullptr)
            runner_.run(runner_.self, engine, woken);
        else
            engine.run(woken);
        sleep_until(a, engine.next_wake());
        return;
    }
    if (!loops_[a]) loops_[a].emplace(engine, instance_.clock(), instance_.stack_of(a));
    loops_[a]->run(woken);
    sleep_until(a, loops_[a]->next_wake());
}

void VirtualWorld::sleep_until(std::size_t a, Time time) {
    wake_at_[a] = time;
    instance_.engines()[a].sleeps_until(time);
}

bool VirtualWorld::is_ready(std::size_t a, Time now) {
    Engine& engine = instance_.engines()[a];
    Job& job = jobs_[a];
    if (!engine.is_active()) job.is_there = false;
    if (!engine.is_active() || hangs_until_[a] > now) return false;
    if (!job.is_there) {
        job.woken = engine.waiter().is_woken() && engine.waiter().take();
        if (!job.woken && wake_at_[a] > now) return false;
        job.is_there = true;
        // A timer that is set to a past time is due from the moment of setting.
        job.release = job.woken                ? now
                      : engine.plan().periodic ? wake_at_[a]
                                               : std::max(wake_at_[a], job.ended);
        job.release = std::max(job.release, hangs_until_[a]);
        job.left = {};
        const std::int64_t budget = engine.plan().budget.count();
        if (times_ && budget > 0)
            job.left = Duration{times_->one_in(4) ? budget : times_->between(1, budget)};
    }
    return true;
}

std::size_t VirtualWorld::at_work(int processor) const {
    for (const std::size_t a : by_urgency_)
        if (jobs_[a].is_there && hangs_until_[a] <= worked_until_ &&
            instance_.machine().plan.activities[a].processor == processor)
            return a;
    return nowhere;
}

void VirtualWorld::work_until(Time now) {
    for (int p = 0; times_ && p < instance_.machine().board->processors; ++p)
        if (const std::size_t a = at_work(p); a != nowhere)
            jobs_[a].left -= std::min(jobs_[a].left, now - worked_until_);
    worked_until_ = now;
}

void VirtualWorld::run_engines(Time now) {
    work_until(now);
    for (int round = 0; round < max_rounds_per_instant; ++round) {
        bool ran = false;
        std::uint64_t busy = 0; // processors
        for (const std::size_t a : by_urgency_) {
            if (!is_ready(a, now)) continue;
            Job& job = jobs_[a];
            if (times_) {
                const std::uint64_t processor = std::uint64_t{1}
                                                << instance_.machine().plan.activities[a].processor;
                const bool waits = (busy & processor) != 0;
                busy |= processor;
                if (waits || job.left > Duration{}) continue;
                job.longest = std::max(job.longest, now - job.release);
                job.ended = now;
            }
            job.is_there = false;
            run_engine(a, job.woken);
            ++steps_;
            ran = true;
            break; // the most urgent of the activities that are ready now runs next
        }
        if (!ran || (instance_.stop_asked() && !is_ending_)) return;
    }
    TAPPET_CONTRACT(false, Contract::step_limit_exceeded, max_rounds_per_instant, max_rounds_per_instant + 1);
}

bool VirtualWorld::run_until(Time end) {
    os::Clock& clock = instance_.clock();
    while (!instance_.stop_asked()) {
        instance_.life().serve_activity_requests(control());
        end_ = end;
        const Time next = std::max(next_time(), clock.now());
        if (next > end) {
            clock.advance_to(end);
            return true;
        }
        run_instant(next);
    }
    return false;
}

void VirtualWorld::run_instant(Time now) {
    instance_.clock().advance_to(now);
    if (makers_until_ <= now) {
        makers_until_ = never;
        instance_.life().run_makers_functions();
    }
    for (const VirtualProcess& process : processes_)
        if (process.next(process.self) <= now) process.run(process.self, now);
    run_engines(now);
}

void VirtualWorld::end(std::size_t a) {
    Engine& engine = instance_.engines()[a];
    os::Clock& clock = instance_.clock();
    engine.begin_end(clock.now());
    sleep_until(a, engine.next_wake());
    is_ending_ = true;
    while (!engine.has_ended(clock.now())) {
        end_ = engine.ends_at();
        run_instant(std::min(std::max(next_time(), clock.now()), end_));
    }
    is_ending_ = false;
}

void VirtualWorld::stop() {
    MachineLife& life = instance_.life();
    life.give_up_changes();
    for (std::size_t a = instance_.engines().size(); a-- > 0;)
        if (instance_.engines()[a].is_active()) control().stop(this, a);
    const Duration takes = std::exchange(makers_take_, {}); // nobody waits for them any more
    makers_until_ = never;
    life.run_makers_functions(); // of a change that was given up
    for (std::size_t a = instance_.engines().size(); a-- > 0;)
        static_cast<void>(life.begin_finalising(a, control()));
    makers_take_ = takes;
}

} // namespace tappet
