// Arms, starts, supervises and stops the threads of a machine.
#include "kernel/machine/worlds/real_world.hpp"

#include "kernel/os/clock.hpp"
#include "kernel/os/heap.hpp"
#include "kernel/os/memory.hpp"
#include "kernel/os/signals.hpp"
#include "kernel/os/sleep.hpp"
#include "kernel/os/stamps.hpp"
#include "kernel/os/terminal.hpp"

#include <cstdlib>

namespace tappet {

namespace {

// A contract handler and a signal handler have no argument of ours: they find the world here.
std::atomic<RealWorld*> current_world{nullptr};
std::atomic<os::Waiter*> signal_waiter{nullptr};
std::atomic<bool> signal_came{false};
thread_local bool supervises = false;

} // namespace

RealWorld::RealWorld(MachineInstance& instance) noexcept : instance_{instance} {
    supervises = true;
    current_world.store(this, std::memory_order_release);
    signal_waiter.store(&instance.supervisor(), std::memory_order_release);
    signal_came.store(false);
    install_contract_handler(&RealWorld::on_breach);
    os::on_termination(&RealWorld::on_signal);
}

RealWorld::~RealWorld() {
    static_cast<void>(stop());
    install_contract_handler(nullptr);
    os::on_termination(nullptr);
    signal_waiter.store(nullptr);
    current_world.store(nullptr);
    supervises = false;
}

void RealWorld::on_signal(int) noexcept {
    signal_came.store(true, std::memory_order_release);
    if (os::Waiter* waiter = signal_waiter.load(std::memory_order_acquire)) waiter->wake();
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
    bool is_supervisor = false;
    TAPPET_ESCAPE("thread-local memory of the main program", is_supervisor = supervises);
    if (!is_supervisor) Activity::sleep_for_ever(); // the supervisor stops the machine
    // Nobody else would stop the machine: it is done here, and the process ends when it stands.
    // It says why without waiting for who reads it.
    TAPPET_ESCAPE("the supervisor's thread is not real-time", static_cast<void>(world->stop());
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
        return Sentence{"a contract was broken, of which no more is known"};
    return describe(kept_breaches_[index].breach);
}

std::optional<Armed> RealWorld::arm(os::ArmingReport& report, int file) {
    const auto& machine = instance_.machine();
    os::never_wait();
    os::touch(machine.memory); // before there are threads: their stacks are part of it
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
    if (const auto locked = os::lock_memory(); !locked)
        report.fault("memory-lock", locked.error(), Sentence{"see the reason"});
    if (auto held = os::hold_cpu_dma_latency(); held) latency_ = std::move(*held);
    os::heap::seal();
    os::ArmingOptions options;
    options.processors = {processors.begin(), processors.end()};
    options.highest_priority = highest;
    check_system(report, options, os::observe_process(highest));
    static_cast<void>(os::prove_processor_counter()); // without it stamps are taken from the clock
    const bool fit = report.conclude();
    print(report, file);
    if (fit) return Armed{};
    os::heap::release();
    return {};
}

ActivityControl RealWorld::control() noexcept {
    return {this,
            [](void* self, std::size_t a) {
                return static_cast<RealWorld*>(self)->activities_[a].start(patience_ms);
            },
            [](void* self, std::size_t a) { return static_cast<RealWorld*>(self)->stop_engine(a); },
            [](void* self) {
                const auto& world = *static_cast<RealWorld*>(self);
                if (world.before_change_ != nullptr) world.before_change_(world.before_context_);
            }};
}

bool RealWorld::start(Armed) {
    refusal_ = instance_.life().start_activities(control());
    if (!refusal_.empty()) static_cast<void>(stop());
    return refusal_.empty();
}

Sentence RealWorld::change_activity(std::size_t activity, LifeChange change) {
    return instance_.life().change_activity(activity, change, control());
}

bool RealWorld::stop_engine(std::size_t a) noexcept {
    if (activities_[a].stop(patience_ms)) return true;
    // Parked by a broken contract, or hung: its components still leave their safe values.
    if (activities_[a].claim_engine_stop()) activities_[a].engine().stop(instance_.clock().now());
    activities_[a].engine().mark_failed();
    activities_[a].abandon(); // the process must end although this thread never does
    return false;
}

bool RealWorld::supervise(Duration time) {
    const Time end = instance_.clock().now() + time;
    while (!instance_.stop_asked()) {
        instance_.life().serve_activity_requests(control());
        if (signal_came.load(std::memory_order_acquire)) {
            instance_.ask_stop(StopReason::requested, 0, nullptr);
            return false;
        }
        if (instance_.clock().now() >= end) return true;
        static_cast<void>(instance_.supervisor().wait(end));
    }
    return false;
}

int RealWorld::stop() {
    const auto stop_now = [this](std::size_t a) {
        return instance_.life().change_activity(a, LifeChange::stop, control()).empty() ? 0 : 1;
    };
    int hung = 0;
    const Time grace = os::Clock::monotonic() + grace_ms * 1ms;
    Bounded<std::size_t, max_activities> asked;
    for (std::size_t a = instance_.engines().size(); a-- > 0;) {
        const Engine& engine = instance_.engines()[a];
        if (engine.plan().real_time || !engine.is_active() || !asked.push(a)) {
            hung += stop_now(a);
            continue;
        }
        activities_[a].ask_to_stop();
        const Duration left = std::max(grace - os::Clock::monotonic(), Duration::zero());
        static_cast<void>(activities_[a].is_stopped_within(static_cast<int>(left / 1ms)));
    }
    // What they do on this thread at their end may block, too: the others stand by now.
    for (const std::size_t a : asked)
        if (activities_[a].is_stopped_within(patience_ms))
            instance_.engines()[a].finalise();
        else
            hung += stop_now(a);
    for (std::size_t a = instance_.engines().size(); a-- > 0;)
        if (!activities_[a].end(patience_ms)) activities_[a].abandon();
    os::heap::release();
    return hung_ = hung;
}

std::uint64_t RealWorld::page_faults_in_real_time_threads() const noexcept {
    std::uint64_t faults = 0;
    for (std::size_t a = 0; a < instance_.engines().size(); ++a)
        if (instance_.engines()[a].plan().real_time)
            faults += activities_[a].page_faults().minor + activities_[a].page_faults().major;
    return faults;
}

} // namespace tappet
