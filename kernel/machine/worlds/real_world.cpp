// Arms, starts, supervises and stops the threads of a machine.
#include "kernel/machine/worlds/real_world.hpp"

#include "kernel/os/clock.hpp"
#include "kernel/os/heap.hpp"
#include "kernel/os/memory.hpp"
#include "kernel/os/signals.hpp"
#include "kernel/os/sleep.hpp"
#include "kernel/os/stamps.hpp"
#include "kernel/os/terminal.hpp"

#include <algorithm>
#include <cstdlib>

namespace tappet {

namespace {

// A contract handler and a signal handler have no argument of ours: they find the world through this pointer.
std::atomic<RealWorld*> current_world{nullptr};
thread_local bool supervises = false;

// A lock or an allocation in a component's step shows as a late cycle at some hour only: a machine that moves
// steel does not run on luck.
void check_effects(const AcceptedMachine& machine, os::ArmingReport& report) {
    const Sentence found{"nothing checked that the real-time functions of \"", machine.table.name,
                         "\" do not block when this firmware was built"};
    const Sentence cure{
        "install clang-22 where it is built, configure with TAPPET_EFFECTS=ON, and build again"};
    const std::string_view world = machine.board->world;
    if (machine.table.effects_checked)
        report.passed("effects", Sentence{"clang followed what real-time functions do"});
    else if (world == "host" || world == "bench")
        report.warning("effects", found, cure);
    else
        report.refuse("effects", found, cure);
}

} // namespace

RealWorld::RealWorld(MachineInstance& instance) noexcept : instance_{instance} {
    supervises = true;
    current_world.store(this, std::memory_order_release);
    install_contract_handler(&RealWorld::on_breach);
    os::on_termination(&RealWorld::on_signal);
}

RealWorld::~RealWorld() {
    static_cast<void>(stop());
    install_contract_handler(nullptr);
    os::on_termination(nullptr);
    current_world.store(nullptr);
    supervises = false;
}

// Requests the stop at once, so that the guardian knows its time even if the supervisor hangs.
void RealWorld::on_signal(int) noexcept {
    if (RealWorld* world = current_world.load(std::memory_order_acquire))
        world->instance_.ask_stop(StopReason::requested, 0, nullptr);
}

void RealWorld::on_breach(const ContractViolation& breach) noexcept TAPPET_REALTIME {
    RealWorld* world = current_world.load(std::memory_order_acquire);
    if (world == nullptr) return;
    Activity* activity = Activity::current();
    world->keep(breach);
    world->instance_.ask_stop(StopReason::broken_contract, static_cast<std::uint64_t>(breach.id),
                              activity == nullptr ? nullptr : &activity->engine());
    const ContractText* text = find_text(breach.id);
    if (text != nullptr && text->after == AfterViolation::thread_goes_on) return;
    if (activity != nullptr) activity->park();
    MakersThread::note_breach();
    bool is_supervisor = false;
    TAPPET_ESCAPE("thread-local memory of the main program", is_supervisor = supervises);
    if (!is_supervisor) Activity::sleep_for_ever(); // the supervisor stops the machine
    // No other thread would stop the machine: it is stopped here, and then the process ends. The reason is
    // written without waiting for its reader.
    TAPPET_ESCAPE("the supervisor's thread is not real-time", static_cast<void>(world->make_safe());
                  static_cast<void>(os::write_all(2, describe(breach).add("\n").view())); std::abort());
}

void RealWorld::keep(const ContractViolation& breach) noexcept TAPPET_REALTIME {
    const std::size_t place = breaches_.fetch_add(1, std::memory_order_acq_rel);
    if (place >= max_breaches) return;
    kept_breaches_[place].breach = breach;
    kept_breaches_[place].complete.store(true, std::memory_order_release);
}

Sentence RealWorld::describe_breach(std::size_t index) const noexcept {
    if (index >= max_breaches || !kept_breaches_[index].complete.load(std::memory_order_acquire))
        return Sentence{"a contract was broken; the details are lost"};
    return describe(kept_breaches_[index].breach);
}

std::optional<Armed> RealWorld::arm(os::ArmingReport& report, int file) {
    const auto& machine = instance_.machine();
    os::never_wait();
    os::touch(machine.memory); // before the threads exist: their stacks are part of it
    const auto engines = instance_.engines();
    int highest = 1;
    Bounded<int, max_activities> processors;
    os::minimise_timer_slack(); // threads inherit it
    for (std::size_t a = 0; a < engines.size(); ++a) {
        const ActivityPlan& plan = machine.plan.activities[a];
        if (const auto created = activities_[a].create(engines[a], instance_.clock(), plan.priority,
                                                       plan.processor, instance_.stack_of(a));
            !created)
            report.fault("threads", created.error(), Sentence{"see the reason"});
        if (plan.priority > highest) highest = plan.priority;
        static_cast<void>(processors.push(plan.processor));
    }
    is_armed_ = true;
    for (const auto& created :
         {makers_.create(
              "makers", makers_stack_,
              [](void* self) { static_cast<RealWorld*>(self)->instance_.life().run_makers_functions(); },
              this),
          breaker_.create(
              "loop-breaker", breakers_stack_,
              [](void* self) { static_cast<RealWorld*>(self)->break_loops(); }, this)})
        if (!created) report.fault("threads", created.error(), Sentence{"see the reason"});
    check_effects(machine, report);
    if (const auto locked = os::lock_memory(); !locked)
        report.fault("memory-lock", locked.error(), Sentence{"see the reason"});
    if (auto held = os::hold_cpu_dma_latency(); held) latency_ = std::move(*held);
    os::heap::seal();
    os::ArmingOptions options;
    options.processors = {processors.begin(), processors.end()};
    options.highest_priority = highest;
    check_system(report, options, os::observe_process(highest));
    static_cast<void>(os::prove_processor_counter()); // without it the clock provides the stamps
    const bool fit = report.conclude();
    print(report, file);
    if (fit) return Armed{};
    os::heap::release();
    return {};
}

ActivityControl RealWorld::control() noexcept {
    return {this,
            [](void* self, std::size_t a) {
                auto& world = *static_cast<RealWorld*>(self);
                world.began_[a] = os::Clock::monotonic();
                world.activities_[a].start();
            },
            [](void* self, std::size_t a) {
                auto& world = *static_cast<RealWorld*>(self);
                return world.progress_of(a, world.activities_[a].is_started_within(0), patience_ms);
            },
            [](void* self, std::size_t a) {
                auto& world = *static_cast<RealWorld*>(self);
                world.began_[a] = os::Clock::monotonic();
                world.ask_to_stop(a, patience_ms);
            },
            [](void* self, std::size_t a) {
                auto& world = *static_cast<RealWorld*>(self);
                const bool is_told = (world.loops_to_break_.load(std::memory_order_acquire) >> a & 1) == 0;
                return world.progress_of(a, is_told && world.activities_[a].is_stopped_within(0),
                                         world.instance_.engines()[a].plan().real_time ? patience_ms
                                                                                       : patience_beside_ms);
            },
            [](void* self) {
                auto& world = *static_cast<RealWorld*>(self);
                world.makers_began_ = os::Clock::monotonic();
                world.makers_.wake();
            }};
}

// A hanging thread may write anything later: the machine stops, and its guardian ends it.
ActivityControl::Progress RealWorld::progress_of(std::size_t a, bool is_there, int patience) {
    using Progress = ActivityControl::Progress;
    if (activities_[a].is_lost()) return Progress::lost;
    if (is_there) return Progress::done;
    if (os::Clock::monotonic() - began_[a] < patience * 1ms) return Progress::pending;
    instance_.ask_stop(StopReason::activity_hangs, 0, &instance_.engines()[a]);
    return Progress::lost;
}

void RealWorld::ask_to_stop(std::size_t a, int patience) noexcept {
    const Duration end_within = std::min<Duration>(Activity::end_within, patience * 600us);
    activities_[a].ask_to_stop(instance_.clock().now() + end_within);
    if (!activities_[a].has_loop_to_break()) return;
    loops_to_break_.fetch_or(std::uint64_t{1} << a, std::memory_order_acq_rel);
    breaker_.wake();
}

// A bit stays until its loop was told: a restarted loop must not receive the request for the previous one.
void RealWorld::break_loops() noexcept {
    const std::uint64_t loops = loops_to_break_.load(std::memory_order_acquire);
    for (std::size_t a = 0; a < instance_.engines().size(); ++a) {
        if ((loops >> a & 1) == 0) continue;
        activities_[a].break_loop();
        loops_to_break_.fetch_and(~(std::uint64_t{1} << a), std::memory_order_acq_rel);
    }
}

void RealWorld::wait_for_change(Time end) {
    if (show_life_ != nullptr) show_life_(life_context_);
    // The thread whose start or stop is awaited wakes nobody: poll.
    const Duration look = instance_.life().makers_at_work() ? 5ms : 1ms;
    static_cast<void>(instance_.supervisor().wait(std::min(end, instance_.clock().now() + look)));
}

bool RealWorld::complete_change(std::size_t a, Duration makers_time) {
    while (instance_.life().changes(a)) {
        instance_.life().serve_activity_requests(control());
        if (!instance_.life().changes(a)) break;
        if (instance_.stop_asked() || makers_took(makers_time)) return false;
        wait_for_change(never);
    }
    return true;
}

bool RealWorld::start(Armed) {
    is_safe_ = false;
    MachineLife& life = instance_.life();
    for (std::size_t a = 0; a < instance_.engines().size() && !instance_.stop_asked(); ++a) {
        life.begin_change(a, LifeChange::start, MachineLife::Begin::with_the_machine, control());
        const bool completed = complete_change(a, makers_within);
        if (!completed && !instance_.stop_asked()) refusal_ = makers_too_long();
        if (completed) refusal_ = life.refusal();
        if (!refusal_.empty()) instance_.ask_stop(StopReason::not_started, 0, &instance_.engines()[a]);
    }
    return !instance_.stop_asked();
}

Sentence RealWorld::change_activity(std::size_t a, LifeChange change) {
    MachineLife& life = instance_.life();
    bool completed = complete_change(a, Duration::max()); // one that was requested from outside
    if (completed) {
        life.begin_change(a, change, MachineLife::Begin::alone, control());
        completed = complete_change(a, Duration::max());
    }
    return completed ? life.refusal() : Sentence{"the machine stops: ", instance_.describe_stop()};
}

bool RealWorld::supervise(Duration time) {
    const Time end = instance_.clock().now() + time;
    while (!instance_.stop_asked()) {
        instance_.life().serve_activity_requests(control());
        if (instance_.stop_asked()) break;
        if (instance_.clock().now() >= end) return true;
        if (instance_.life().changes())
            wait_for_change(end);
        else
            static_cast<void>(instance_.supervisor().wait(end));
    }
    return false;
}

void RealWorld::count_hung(std::size_t a) noexcept {
    if (hung_++ == 0) first_hung_ = instance_.engines()[a].name();
}

bool RealWorld::reaches_others(std::size_t a) const {
    const auto& index = instance_.machine().index;
    const auto leads_out = [&](const Link& link) {
        return link.from.component != nowhere && link.to.component != nowhere &&
               index.activity[link.from.component] == a && index.activity[link.to.component] != a;
    };
    return std::ranges::any_of(index.connections, leads_out) ||
           std::ranges::any_of(index.reactions, leads_out);
}

void RealWorld::give_up(std::size_t a) noexcept {
    count_hung(a);
    instance_.engines()[a].mark_failed();
    instance_.life().lose(a);
    activities_[a].give_up();
}

int RealWorld::make_safe() {
    if (is_safe_ || !is_armed_) return hung_;
    is_safe_ = true;
    hung_ = 0;
    instance_.life().give_up_changes();
    const auto now = [this] { return instance_.clock().now(); };
    const Time due =
        instance_.stop_asked() ? instance_.stop_due() : now() + instance_.machine().board->stop_within;
    const auto patience = [&] {
        const auto half_of_the_rest = static_cast<int>((due - now()) / 2ms);
        return std::clamp(half_of_the_rest, least_patience_ms, patience_ms);
    };
    // Before the drivers stop, so that the values it leaves reach them.
    const Time grace = now() + std::max<Duration>(Board::stop_grace, (due - now()) / 4);
    Bounded<std::size_t, max_activities> late;
    for (std::size_t a = instance_.engines().size(); a-- > 0;) {
        if (activities_[a].is_stopped_within(0)) continue;
        const int time = patience();
        ask_to_stop(a, time);
        if (instance_.engines()[a].plan().real_time) {
            if (!activities_[a].is_stopped_within(time)) give_up(a);
            continue;
        }
        const Duration left = std::max(grace - now(), Duration::zero());
        if (!activities_[a].is_stopped_within(static_cast<int>(left / 1ms))) static_cast<void>(late.push(a));
    }
    // All of them were asked: they get the remaining time, except for the minimum that giving them up needs.
    for (const std::size_t a : late) {
        const auto rest = static_cast<int>((due - now()) / 1ms) - least_patience_ms;
        if (!activities_[a].is_stopped_within(std::max(rest, least_patience_ms)))
            give_up(a);
        else if (reaches_others(a)) // whose drivers had stopped by then
            count_hung(a);
    }
    for (std::size_t a = 0; a < instance_.engines().size(); ++a)
        if (activities_[a].is_lost()) instance_.life().lose(a);
    return hung_;
}

int RealWorld::lost() const noexcept {
    int lost = 0;
    for (const Activity& each : activities_) lost += each.is_lost();
    return lost;
}

bool RealWorld::makers_took(Duration time) const {
    return instance_.life().makers_at_work() && os::Clock::monotonic() - makers_began_ > time;
}

bool RealWorld::await_makers() {
    for (;;) {
        instance_.life().progress(control());
        if (!instance_.life().changes() && !instance_.life().makers_at_work()) return true;
        if (makers_.is_lost() || makers_took(makers_within)) {
            unfinished_ = makers_too_long();
            return false;
        }
        wait_for_change(never);
    }
}

Sentence RealWorld::makers_too_long() const {
    const std::string_view name = instance_.engines()[instance_.life().makers_of()].name();
    if (makers_.is_lost())
        return Sentence{"activity \"", name,
                        "\": its initialise() or finalise() broke a contract, and nothing is finalised any "
                        "more; see there"};
    return Sentence{"activity \"", name, "\": its initialise() or finalise() did not return within ",
                    makers_within / 1s, " s; let it wait for nothing, or limit how long"};
}

int RealWorld::stop() {
    static_cast<void>(make_safe());
    if (!is_armed_) return hung_;
    is_armed_ = false;
    bool awaited = await_makers();
    for (std::size_t a = instance_.engines().size(); awaited && a-- > 0;)
        if (instance_.life().begin_finalising(a, control())) awaited = await_makers();
    for (std::size_t a = instance_.engines().size(); a-- > 0;)
        if (activities_[a].is_lost() || !activities_[a].end(patience_ms)) activities_[a].abandon();
    makers_.end(awaited ? patience_ms : 0);
    breaker_.end(patience_ms);
    os::heap::release();
    return hung_;
}

std::uint64_t RealWorld::page_faults_in_real_time_threads() const noexcept {
    std::uint64_t faults = 0;
    for (std::size_t a = 0; a < instance_.engines().size(); ++a)
        if (instance_.engines()[a].plan().real_time)
            faults += activities_[a].page_faults().minor + activities_[a].page_faults().major;
    return faults;
}

} // namespace tappet
